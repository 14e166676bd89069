// The video cable of an emulated rig: a picture for the projector at each vertical sync of a steady clock.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "devices/emulated_rig/rig_cables.h"
#include "devices/emulated_rig/rig_display.h"

namespace ilf::devices {

/// 60.00 Hz, as the projector's own mode has. Calls come from one thread, the one that started it.
class RigVideo {
public:
    static constexpr double kRefresh_Hz = 60.0;

    static Result<std::unique_ptr<RigVideo>> started(RigCables& cables);
    ~RigVideo();
    RigVideo(const RigVideo&) = delete;
    RigVideo& operator=(const RigVideo&) = delete;

    /// ":7": stays the same when the display is pulled and put back.
    const std::string& displayName() const { return name_; }
    /// "unplug" ends the display, "plug" (and "none") starts it again under the same name.
    Result<void> befall(const RigMishap& mishap);
    /// Why the display went by itself, once.
    std::optional<std::string> trouble();

private:
    RigVideo(RigCables& cables, std::unique_ptr<RigDisplay> display);
    void run(const std::stop_token& stop);
    emulators::FramePtr picture();
    void pull();

    RigCables& cables_;
    std::string name_;
    int number_;
    std::mutex mutex_;  ///< guards what follows
    std::unique_ptr<RigDisplay> display_;
    bool plugged_ = true;
    std::optional<std::string> trouble_;
    std::jthread syncs_;  ///< last: it ends before what it uses
};

}  // namespace ilf::devices
