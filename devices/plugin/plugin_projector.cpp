#include <cassert>
#include <cmath>
#include <limits>

#include "devices/plugin/loaded_plugin.h"
#include "devices/plugin/plugin_words.h"

namespace ilf::devices {
namespace {

constexpr std::uint32_t kMostPixelsASide = 16384, kMostSlots = 100'000;
constexpr double kMostSlotRate = 1e6;  // Hz
constexpr std::uint32_t kTriggers = ILF_TRIGGER_OWN_CLOCK | ILF_TRIGGER_EACH_SLOT | ILF_TRIGGER_EACH_SWEEP;

template <class T>
T sized() {
    T structure{};
    structure.struct_size = sizeof structure;
    return structure;
}

/// What cannot be in a description, as the end of a sentence; empty: all of it can.
std::string impossible(const ilf_description& d) {
    if (d.width_px < 1 || d.height_px < 1 || d.width_px > kMostPixelsASide || d.height_px > kMostPixelsASide)
        return std::to_string(d.width_px) + "x" + std::to_string(d.height_px) + " pixels";
    if ((d.triggers & kTriggers) == 0) return "no way to trigger its slots";
    if (d.slots_most < 1 || d.slots_most > kMostSlots) return "a buffer for " + std::to_string(d.slots_most) + " slots";
    if (d.depth_count < 1 || d.depth_count > ILF_DEPTHS_MOST) return std::to_string(d.depth_count) + " bit depths";
    for (std::uint32_t i = 0; i < d.depth_count; ++i) {
        const ilf_depth& depth = d.depths[i];
        if (depth.bits < 1 || depth.bits > 8) return "pictures of " + std::to_string(depth.bits) + " bits";
        // Written so that a rate that is not a number is caught too.
        if (!(depth.slowest_hz >= 0.0 && depth.slowest_hz <= depth.fastest_hz && depth.fastest_hz > 0.0 &&
              depth.fastest_hz <= kMostSlotRate))
            return "slot rates that cannot be";
    }
    return {};
}

std::vector<std::string> troublesOf(const ilf_status& status) {
    std::vector<std::string> troubles;
    const auto note = [&](std::uint32_t bit, const char* sentence) {
        if ((status.errors & bit) != 0) troubles.emplace_back(sentence);
    };
    note(ILF_ERROR_LIGHT_SOURCE, "The projector's light source has failed; switch it off and on, or have it serviced.");
    note(ILF_ERROR_TOO_HOT, "The projector is too hot; check its fans and what stands in their way.");
    note(ILF_ERROR_DMA_TIMEOUT, "The projector's pictures do not get through (DMA timeout); check its card and cable.");
    note(ILF_ERROR_NO_TRIGGER, "The projector gets no triggers; check the trigger cable, then TAKE.");
    note(ILF_ERROR_RATE_OVERFLOW, "Slots come faster than the projector can show them; lower the rig's slot rate.");
    constexpr std::uint32_t kKnown = ILF_ERROR_LIGHT_SOURCE | ILF_ERROR_TOO_HOT | ILF_ERROR_DMA_TIMEOUT |
                                     ILF_ERROR_NO_TRIGGER | ILF_ERROR_RATE_OVERFLOW;
    if ((status.errors & ~kKnown) != 0 || (status.vendor_error != 0 && troubles.empty()))
        troubles.push_back("The projector has an error of its own (" + std::to_string(status.errors & ~kKnown) + ", " +
                           std::to_string(status.vendor_error) + "); its maker's documents say what it is.");
    return troubles;
}

}  // namespace

Result<void> PluginProjector::told(const Call& call, const std::function<ilf_code(ilf_message*)>& order) {
    ilf_message message{};
    const auto begun = clock_.now();
    ilf_code code = ILF_FAILED;
    watch_.began(plugin_.name() + " was asked to " + call.what + " and did not come back", call.longest);
    try {
        code = order(&message);
        watch_.ended();
    } catch (...) {
        watch_.ended();
        return fail(Fault::device, plugin_.name() + " threw an exception when asked to " + call.what +
                                       ", which no plugin may; tell its author.");
    }
    const auto took = Second::fromSi(std::chrono::duration<double>(clock_.now() - begun).count());
    if (took > call.longest) remark_ = plugin_.name() + " " + tookTooLong(call.what, took, call.longest) + ".";
    if (code != ILF_OK) return tl::unexpected(pluginError(plugin_.name(), call.what, code, message));
    if (took > call.longest) return fail(Fault::device, remark_);
    return {};
}

Result<std::unique_ptr<PluginProjector>> PluginProjector::open(const ProjectorPlugin& plugin, const std::string& place,
                                                               const std::string& options, Clock clock,
                                                               HangingCall hanging) {
    std::unique_ptr<PluginProjector> made(new PluginProjector(plugin, std::move(clock), std::move(hanging)));
    ilf_projector* opened = nullptr;
    bool went = false;
    auto there = made->told({"open the projector", 40.0_s}, [&](ilf_message* message) {
        const ilf_code code = plugin.calls().open(place.c_str(), options.c_str(), &opened, message);
        went = code == ILF_OK;
        return code;
    });
    if (went) made->projector_ = opened;  // also if it took too long: then it is closed again
    if (!there) return tl::unexpected(there.error());
    if (opened == nullptr)
        return fail(Fault::device, plugin.name() + " opened a projector and gave none; tell its author.");
    if (auto known = made->described(); !known) return tl::unexpected(known.error());
    made->name_ = made->description_.name + (place.empty() ? "" : " at " + place);
    return made;
}

PluginProjector::~PluginProjector() {
    if (projector_ == nullptr) return;
    const auto tried = [](const auto& order) {
        try {
            return order().has_value();
        } catch (const std::exception&) {
            return false;  // out of memory: closing is left, then nothing
        }
    };
    (void)tried([&] { return steadyWhite(); });
    (void)tried([&] {
        return told({"close the projector", 2.0_s},
                    [&](ilf_message* message) { return plugin_.calls().close(projector_, message); });
    });
}

Result<void> PluginProjector::described() {
    auto d = sized<ilf_description>();
    auto answered = told({"describe the projector", 1.0_s},
                         [&](ilf_message* message) { return plugin_.calls().describe(projector_, &d, message); });
    if (!answered) return answered;
    if (const std::string wrong = impossible(d); !wrong.empty())
        return fail(Fault::device, plugin_.name() + " describes a projector that cannot be (" + wrong +
                                       "); tell its author, or get a newer one.");
    description_.name = pluginText(d.name, sizeof d.name);
    if (description_.name.empty()) description_.name = "projector of " + plugin_.name();
    if (d.makes_no_light != 0) description_.name += " (makes no light)";
    description_.serial = pluginText(d.serial, sizeof d.serial);
    description_.raster = {static_cast<int>(d.width_px), static_cast<int>(d.height_px)};
    description_.triggers = d.triggers & kTriggers;
    description_.mostSlots = static_cast<int>(d.slots_most);
    description_.makesNoLight = d.makes_no_light != 0;
    for (std::uint32_t i = 0; i < d.depth_count; ++i)
        description_.depths.push_back({static_cast<int>(d.depths[i].bits), Hertz::fromSi(d.depths[i].slowest_hz),
                                       Hertz::fromSi(d.depths[i].fastest_hz)});
    return {};
}

Result<void> PluginProjector::possible(const PluginConfiguration& how) const {
    const auto refused = [&](const std::string& why) {
        return fail(Fault::outOfRange, name_ + " " + why + "; change the rig to what it can do.");
    };
    if ((description_.triggers & static_cast<std::uint32_t>(how.trigger)) == 0)
        return refused(how.trigger == PluginTrigger::ownClock
                           ? "gives no pulse at the start of a sweep, which the lens would follow"
                           : "cannot be triggered from outside in that way");
    if (how.slots < 1 || how.slots > description_.mostSlots)
        return refused("holds " + std::to_string(description_.mostSlots) + " slots of a sweep, not " +
                       std::to_string(how.slots));
    const PluginDescription::Depth* depth = nullptr;
    for (const auto& one : description_.depths)
        if (one.bits == how.bits) depth = &one;
    if (depth == nullptr) return refused("has no pictures of " + std::to_string(how.bits) + " bits");
    const double rate_Hz = how.slotRate.si();
    if (!(rate_Hz >= depth->slowest.si() && rate_Hz <= depth->fastest.si()))
        return refused("shows pictures of " + std::to_string(how.bits) + " bits at " +
                       std::to_string(std::lround(depth->slowest.si())) + " to " +
                       std::to_string(std::lround(depth->fastest.si())) + " Hz, not at " +
                       (std::isfinite(rate_Hz) ? std::to_string(std::lround(rate_Hz)) + " Hz" : "no rate at all"));
    return {};
}

Result<void> PluginProjector::configure(const PluginConfiguration& how) {
    if (auto fine = possible(how); !fine) return fine;
    auto wanted = sized<ilf_configuration>();
    wanted.trigger = static_cast<std::uint32_t>(how.trigger);
    wanted.slots = static_cast<std::uint32_t>(how.slots);
    wanted.bits = static_cast<std::uint32_t>(how.bits);
    wanted.slot_rate_hz = how.slotRate.si();
    wanted.trigger_timeout_ns = static_cast<std::uint64_t>(std::llround(how.triggerTimeout.in(1.0_ms) * 1e6));
    auto done = told({"time its slots so", 2.0_s},
                     [&](ilf_message* message) { return plugin_.calls().configure(projector_, &wanted, message); });
    if (done) sweep_ = how.slots / how.slotRate;
    return done;
}

Result<void> PluginProjector::upload(int slot, const Image<std::uint8_t>& picture) {
    assert(slot >= 0 && picture.channels() == 1);
    if (picture.size() != description_.raster)
        return fail(Fault::outOfRange,
                    "A slot's picture is " + std::to_string(picture.width()) + "x" + std::to_string(picture.height()) +
                        " pixels, " + name_ + " has " + std::to_string(description_.raster.width) + "x" +
                        std::to_string(description_.raster.height) + "; set the rig's projector to that.");
    auto frame = sized<ilf_frame>();
    frame.slot = static_cast<std::uint32_t>(slot);
    frame.width_px = static_cast<std::uint32_t>(picture.width());
    frame.height_px = static_cast<std::uint32_t>(picture.height());
    frame.row_pitch_bytes = static_cast<std::uint32_t>(picture.stride());
    frame.pixels = picture.row(0);
    return told({"take a slot's picture", 0.25_s},
                [&](ilf_message* message) { return plugin_.calls().upload(projector_, &frame, message); });
}

Result<void> PluginProjector::swap(std::uint64_t program) {
    assert(program != 0);
    return told({"change to the new program", 0.25_s + 3.0 * sweep_},
                [&](ilf_message* message) { return plugin_.calls().swap(projector_, program, message); });
}

Result<void> PluginProjector::start() {
    return told({"start its slots", 2.0_s},
                [&](ilf_message* message) { return plugin_.calls().start(projector_, message); });
}

Result<void> PluginProjector::stop() {
    return told({"stop its slots", 2.0_s},
                [&](ilf_message* message) { return plugin_.calls().stop(projector_, message); });
}

Result<void> PluginProjector::steadyWhite() {
    // Late white is white: only `remark` tells of it, which `told` has written.
    bool white = false;
    auto done = told({"show steady white", 0.5_s}, [&](ilf_message* message) {
        const ilf_code code = plugin_.calls().steady_white(projector_, message);
        white = code == ILF_OK;
        return code;
    });
    if (white) return {};
    return done;
}

Result<PluginStatus> PluginProjector::status() {
    auto s = sized<ilf_status>();
    const auto answered = told({"say how the projector is", 0.25_s},
                               [&](ilf_message* message) { return plugin_.calls().status(projector_, &s, message); });
    if (!answered) return tl::unexpected(answered.error());
    const bool counts = s.frames_out <= s.frames_in && s.frames_waiting <= s.frames_in - s.frames_out;
    if (!counts || s.state > ILF_STATE_DARK || !(s.slot_rate_hz >= 0.0 && s.slot_rate_hz <= kMostSlotRate))
        return fail(Fault::device, plugin_.name() + " says of the projector what cannot be (" +
                                       std::to_string(s.frames_out) + " frames shown of " +
                                       std::to_string(s.frames_in) + ", state " + std::to_string(s.state) +
                                       "); tell its author.");
    if (s.frames_in < last_.frames_in || s.frames_out < last_.frames_out || s.underruns < last_.underruns ||
        s.triggers_lost < last_.triggers_lost)
        return fail(Fault::device, name_ + " counts its frames anew; was it switched off and on? TAKE plays again.");
    last_ = s;
    PluginStatus status;
    status.state = static_cast<PluginStatus::State>(s.state);
    status.program = s.program;
    status.sent = s.frames_in;
    status.shown = s.frames_out;
    status.dropped = s.frames_in - s.frames_out - s.frames_waiting;
    status.underruns = s.underruns;
    status.triggersLost = s.triggers_lost;
    status.slotRate = Hertz::fromSi(s.slot_rate_hz);
    status.troubles = troublesOf(s);
    return status;
}

Result<std::unique_ptr<PluginProjector>> openedPlugin(const std::filesystem::path& file, const std::string& place,
                                                      const std::string& options, Clock clock, HangingCall hanging) {
    const auto plugin = ProjectorPlugin::load(file);
    if (!plugin) return tl::unexpected(plugin.error());
    return PluginProjector::open(*plugin, place, options, std::move(clock), std::move(hanging));
}

}  // namespace ilf::devices
