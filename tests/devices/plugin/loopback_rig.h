// The loopback plugin as a test sees it, and a stage of it and scripted lenses, with a clock that jumps.
#pragma once

#include <dlfcn.h>
#include <doctest/doctest.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "devices/plugin/loopback/loopback_projector.h"
#include "devices/plugin/plugin_stage.h"
#include "tests/devices/rig/scripted_lens.h"

namespace ilf::test {

inline std::filesystem::path loopbackFile() {
    return std::filesystem::path(ILF_CORE_PATH).parent_path().parent_path() / "plugins" / "loopback_projector.so";
}

/// The module's own hooks; the same module that `ProjectorPlugin::load` loads.
inline const ilf_loopback_hooks& loopbackHooks() {
    static const auto* hooks = [] {
        void* library = dlopen(loopbackFile().c_str(), RTLD_NOW | RTLD_LOCAL);
        REQUIRE_MESSAGE(library != nullptr, dlerror());
        return static_cast<const ilf_loopback_hooks*>(dlsym(library, ILF_LOOPBACK_HOOKS));
    }();
    REQUIRE(hooks != nullptr);
    return *hooks;
}

/// A loopback projector nobody has opened yet, without faults, at 0 ns.
class Loopback {
public:
    explicit Loopback(bool realClock = false) { hooks_.reset(realClock ? 0 : 1); }
    ~Loopback() { hooks_.set_judge(nullptr, nullptr); }
    Loopback(const Loopback&) = delete;
    Loopback& operator=(const Loopback&) = delete;

    static devices::ProjectorPlugin plugin() {
        auto plugin = devices::ProjectorPlugin::load(loopbackFile());
        REQUIRE_MESSAGE(plugin, plugin.error().what);
        return *plugin;
    }
    Result<std::unique_ptr<devices::PluginProjector>> open(const std::string& options = "") const {
        return devices::PluginProjector::open(plugin(), "", options, clock());
    }
    devices::Clock clock() const {
        return {[this] { return std::chrono::nanoseconds(hooks_.now_ns()); },
                [this](std::chrono::nanoseconds time) { hooks_.advance_ns(static_cast<std::uint64_t>(time.count())); }};
    }
    void pass(std::chrono::nanoseconds time) const { clock().wait(time); }
    void faults(const std::string& options) const { REQUIRE(hooks_.set_faults(options.c_str()) == 1); }
    ilf_projector* projector() const { return hooks_.opened(); }
    bool opened() const { return projector() != nullptr; }
    bool slotted() const { return hooks_.slotted() != 0; }
    std::uint32_t slots() const { return hooks_.slots(); }
    double slotRate_Hz() const { return hooks_.slot_rate_hz(); }
    Image<std::uint8_t> lightOf(std::uint32_t slot, Size raster) const {
        std::vector<std::uint8_t> pixels(static_cast<std::size_t>(raster.width) *
                                         static_cast<std::size_t>(raster.height));
        REQUIRE(hooks_.light_of_slot(slot, pixels.data(), pixels.size()) == 1);
        return {raster, 1, std::move(pixels)};
    }
    void judged(ilf_loopback_judge judge, void* user) const { hooks_.set_judge(judge, user); }

private:
    const ilf_loopback_hooks& hooks_ = loopbackHooks();
};

inline constexpr Size kSmall{8, 4};

/// Loopback projector and lenses in one room: every call written down, failing when asked to, and judged by what the
/// room sees.
struct LoopbackRig : LensRoom {
    Loopback loopback;
    bool projectorGone = false;
    bool whiteFailed = false;  ///< the last order for it
    double rate_Hz = 0.0;      ///< of the slots at the last call
    devices::PluginStage stage;

    LoopbackRig() : stage(made()) { loopback.judged(&LoopbackRig::judgedByRoom, this); }
    ~LoopbackRig() override {
        failsAt = nullptr;
        stage.safeLight();  // while all of the above is still there
    }
    LoopbackRig(const LoopbackRig&) = delete;
    LoopbackRig& operator=(const LoopbackRig&) = delete;

    Result<void> played(const Program& program) {
        return stage.load(program).and_then([&] { return stage.swap(); });
    }
    LensRoom& lensRoom() { return *this; }
    bool lit() const { return !whiteFailed && !slotted(); }
    void pass(std::chrono::nanoseconds time) const { loopback.pass(time); }
    bool slotted() const override { return loopback.slotted(); }
    bool triggersCome() const override { return loopback.slots() != 0; }
    bool safe() const { return !slotted() && !wave; }
    /// The calls since the last time, without those that only ask; uploads in a row are one.
    std::vector<std::string> orders() {
        std::vector<std::string> told;
        for (const auto& call : log) {
            if (call == "projector: status" || call == "lens: heartbeat" || call == "lens: follow") continue;
            if (call == "projector: upload" && !told.empty() && told.back() == call) continue;
            told.push_back(call);
        }
        log.clear();
        return told;
    }
    void slottedNever(const std::string& at) override {
        if (slotted()) violations.push_back("slotted light at " + at);
    }
    void judged(const std::string& at) override {
        if (slotted() && !wave && !whiteFailed) violations.push_back("slotted light at " + at + ", lens at rest");
        const double rate = loopback.slotRate_Hz();
        if (slotted() && rate_Hz > 0.0 && rate != rate_Hz && rate > 0.0)
            violations.push_back("another slot rate under slotted light at " + at);
        rate_Hz = rate;
    }

private:
    static int judgedByRoom(const char* call, void* user) {
        auto& rig = *static_cast<LoopbackRig*>(user);
        const std::string name = std::string("projector: ") + call;
        rig.judged("before " + name);
        const bool failing = rig.called(name) || rig.projectorGone;
        if (name == "projector: steady_white") rig.whiteFailed = failing && !rig.failsAfterEffect;
        if (name == "projector: close") rig.whiteFailed = false;
        if (!failing) return 0;
        return rig.failsAfterEffect && !rig.projectorGone ? 2 : 1;
    }
    devices::PluginRig made();
};

inline devices::PluginRig LoopbackRig::made() {
    devices::PluginRig rig;
    rig.openProjector = [this]() -> Result<std::unique_ptr<devices::PluginProjector>> {
        if (projectorGone) return fail(Fault::notFound, "There is no projector.");
        return devices::openedPlugin(loopbackFile(), "loopback", "size=8x4", loopback.clock());
    };
    rig.openLens = [this](Dioptre rest) { return ScriptedLens::opened(*this, rest); };
    rig.clock = loopback.clock();
    return rig;
}

}  // namespace ilf::test
