// The projector's display: an X server without a screen, and its pixels.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/base/geometry.h"
#include "core/base/result.h"
#include "devices/emulators/bit_planes.h"

namespace ilf::devices {

/// An Xvfb of its own, which ends with this object or its process. What programs show on it is taken whole: the server
/// draws one request at a time. Where nothing covers it, it is white, as the desktop of a projector should be.
class RigDisplay {
public:
    /// On the display `number`, or on one of its own below 0. The server sees neither the emulated bus nor a preloaded
    /// library. Refuses in one sentence where there is no Xvfb or it does not start.
    static Result<std::unique_ptr<RigDisplay>> started(Size size, int number = -1);
    /// Ends the server: whoever shows something loses the display.
    ~RigDisplay();
    RigDisplay(const RigDisplay&) = delete;
    RigDisplay& operator=(const RigDisplay&) = delete;

    int number() const;
    std::string name() const { return ":" + std::to_string(number()); }
    /// The picture it has now: the same pointer as long as nothing was drawn. An error once the server is gone.
    Result<emulators::FramePtr> picture();

private:
    struct Impl;
    explicit RigDisplay(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace ilf::devices
