// A vendor's projector plugin in this process: loaded from the file a rig names, every call checked and timed.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/quantity.h"
#include "core/base/result.h"
#include "devices/clock.h"
#include "devices/plugin/call_watch.h"
#include "devices/plugin/illuminatedfocus_projector.h"

namespace ilf::devices {

/// A plugin whose table was found whole. A value; what it stands for stays loaded until the process ends.
class ProjectorPlugin {
public:
    /// Loads `file`, by its absolute path and from nowhere else. Errors: no such file (`notFound`); it or a folder
    /// above it may be written by everybody (`unsafe`); it is no library, no plugin, one of another version, or lacks a
    /// call
    /// (`unsupported`, `badFile`).
    static Result<ProjectorPlugin> load(const std::filesystem::path& file);
    /// The same once it is loaded: asks `entry` and checks what it gives. `file` is for words only.
    static Result<ProjectorPlugin> from(ilf_projector_plugin_entry entry, std::string file);

    struct Place {
        std::string id, name;
        bool operator==(const Place&) const = default;
    };
    /// The projectors that are there; at most 16.
    Result<std::vector<Place>> list(const Clock& clock = Clock::steady()) const;

    /// "loopback 1 (loopback_projector.so)"
    std::string name() const;
    /// The hardware its author tried it on, in the author's words; "no hardware" if they say nothing.
    const std::string& triedOn() const { return triedOn_; }
    const std::string& file() const { return file_; }
    const ilf_projector_plugin_v1& calls() const { return calls_; }

private:
    ilf_projector_plugin_v1 calls_{};
    std::string file_, name_, triedOn_;
};

/// What a projector says of itself, found to be possible.
struct PluginDescription {
    struct Depth {
        int bits = 8;
        Hertz slowest, fastest;  ///< slots
    };
    std::string name, serial;
    Size raster;
    std::uint32_t triggers = 0;  ///< ILF_TRIGGER_...
    int mostSlots = 0;
    std::vector<Depth> depths;
    bool makesNoLight = false;
};

enum class PluginTrigger : std::uint32_t {
    ownClock = ILF_TRIGGER_OWN_CLOCK,
    eachSlot = ILF_TRIGGER_EACH_SLOT,
    eachSweep = ILF_TRIGGER_EACH_SWEEP,
};

struct PluginConfiguration {
    PluginTrigger trigger = PluginTrigger::ownClock;
    int slots = 16;
    int bits = 8;
    Hertz slotRate = 960.0_Hz;
    Second triggerTimeout = 0.1_s;  ///< steady white by itself without triggers from outside for so long
    bool operator==(const PluginConfiguration&) const = default;
};

struct PluginStatus {
    enum class State { unknown, white, playing, dark };
    State state = State::unknown;
    std::uint64_t program = 0;  ///< whose light it is, as `swap` named it
    std::uint64_t sent = 0, shown = 0, dropped = 0, underruns = 0, triggersLost = 0;  ///< since it was opened
    Hertz slotRate;                                                                   ///< measured; 0: not
    std::vector<std::string> troubles;                                                ///< each one sentence
};

/// An open projector. After any error but that of a refused configuration only `steadyWhite` is called; a projector
/// that does not listen to it is let go, which tries once more. Calls come from one thread.
///
/// A call that throws is an error; so is one that takes longer than the plugin's header allows, even if it did what it
/// should (`steadyWhite` then succeeds, and `remark` tells of it). A call that never returns or crashes ends the
/// player, whose supervisor starts another.
class PluginProjector {
public:
    /// `place` and `options` as the plugin's `open` takes them. Errors: what the plugin says, or a description that
    /// cannot be.
    static Result<std::unique_ptr<PluginProjector>> open(const ProjectorPlugin& plugin, const std::string& place,
                                                         const std::string& options, Clock clock = Clock::steady(),
                                                         HangingCall hanging = {});
    /// Steady white, then lets it go.
    ~PluginProjector();
    PluginProjector(const PluginProjector&) = delete;
    PluginProjector& operator=(const PluginProjector&) = delete;

    const PluginDescription& description() const { return description_; }
    /// Whether the description allows `how`; if not, says what it does not (`outOfRange`).
    Result<void> possible(const PluginConfiguration& how) const;
    /// Precondition: steady white. What is not `possible` is refused without asking the plugin.
    Result<void> configure(const PluginConfiguration& how);
    /// Gives `slot` a picture in the back buffer; one channel, the projector's raster, values as ilf_frame has them.
    Result<void> upload(int slot, const Image<std::uint8_t>& picture);
    /// The back buffer plays from the next sweep on, called `program` (not 0); returns once that sweep has begun.
    Result<void> swap(std::uint64_t program);
    Result<void> start();
    Result<void> stop();
    /// From any state; see the plugin's header.
    Result<void> steadyWhite();
    Result<PluginStatus> status();

    /// "Loopback projector at loopback"
    const std::string& name() const { return name_; }
    /// The call that took too long most recently, as a sentence; empty: none did.
    const std::string& remark() const { return remark_; }

private:
    struct Call {
        const char* what;  ///< "upload a slot's picture"
        Second longest;
    };
    PluginProjector(const ProjectorPlugin& plugin, Clock clock, HangingCall hanging)
        : plugin_(plugin), clock_(std::move(clock)), watch_(std::move(hanging)) {}
    Result<void> told(const Call& call, const std::function<ilf_code(ilf_message*)>& order);
    Result<void> described();

    ProjectorPlugin plugin_;
    Clock clock_;
    CallWatch watch_;
    ilf_projector* projector_ = nullptr;
    std::string name_, remark_;
    PluginDescription description_;
    Second sweep_;  ///< of the configuration
    ilf_status last_{};
};

/// Loads the plugin `file` (once; later it is there already) and opens its projector: what a rig's fields are for.
Result<std::unique_ptr<PluginProjector>> openedPlugin(const std::filesystem::path& file, const std::string& place,
                                                      const std::string& options, Clock clock = Clock::steady(),
                                                      HangingCall hanging = {});

}  // namespace ilf::devices
