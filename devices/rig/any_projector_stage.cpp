#include "devices/rig/any_projector_stage.h"

#include <exception>

#include "core/base/srgb.h"

namespace ilf::devices {
namespace {

/// The mean light of `slots`, as grey sRGB codes.
VideoFrame mixed(const Program& program, const std::vector<int>& slots) {
    const Size size = program.projector;
    const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    std::vector<float> light(pixels, 0.0F);
    const float share = 1.0F / (255.0F * static_cast<float>(slots.size()));
    for (const int slot : slots) {
        const int index = program.imageOfSlot[static_cast<std::size_t>(slot)];
        if (index == Program::kDark) continue;
        const auto image = toImage(program.images[static_cast<std::size_t>(index)]);
        for (std::size_t i = 0; i < pixels; ++i)
            light[i] += share * static_cast<float>(image.pixels()[i]);
    }
    std::vector<std::uint8_t> rgb(pixels * 3);
    for (std::size_t i = 0; i < pixels; ++i)
        rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = srgb8(light[i]);
    return {size, 3, std::move(rgb)};
}

}  // namespace

Result<std::unique_ptr<AnyProjectorStage>> AnyProjectorStage::open(std::shared_ptr<VideoOutput> video,
                                                                   StagePurpose purpose, RehearsedLight shown) {
    if (purpose == StagePurpose::show)
        return fail(Fault::unsupported,
                    "An ordinary projector has no slots in time, so nothing would be blurred by its "
                    "light; use it to rehearse masks, and name a LightCrafter in the rig for shows.");
    std::unique_ptr<AnyProjectorStage> stage(new AnyProjectorStage(std::move(video), shown));
    return stage;
}

Result<void> AnyProjectorStage::load(const Program& program) {
    loaded_.reset();
    if (auto ok = checked(program); !ok) return ok;
    const auto mode = video_->mode();
    if (!mode) return tl::unexpected(mode.error());
    if (mode->size != program.projector)
        return fail(Fault::outOfRange, "The program is for " + std::to_string(program.projector.width) + "x" +
                                           std::to_string(program.projector.height) + " pixels, the display has " +
                                           std::to_string(mode->size.width) + "x" + std::to_string(mode->size.height) +
                                           "; set the rig's projector to that.");
    const int count = static_cast<int>(program.imageOfSlot.size());
    std::vector<int> slots;
    for (int i = 0; i < count; ++i)
        if (!chosen_.slot || *chosen_.slot == i) slots.push_back(i);
    if (slots.empty())
        return fail(Fault::notFound, "The sweep has no slot " + std::to_string(*chosen_.slot) +
                                         "; its slots count 0 to " + std::to_string(count - 1) + ".");
    loaded_ = mixed(program, slots);
    return {};
}

Result<void> AnyProjectorStage::swap() {
    if (!loaded_) return fail(Fault::device, "Nothing is loaded that could be put on show.");
    if (const auto shown = video_->show(*loaded_); !shown) {
        loaded_.reset();
        safeLight();
        return tl::unexpected(shown.error());
    }
    shows_ = Shows::rehearsal;
    everThere_ = true;
    trouble_.reset();
    return {};
}

Result<void> AnyProjectorStage::heartbeat() {
    const auto mode = video_->mode();
    if (!mode) {
        shows_ = Shows::unknown;
        loaded_.reset();
        trouble_ = mode.error();
        return tl::unexpected(mode.error());
    }
    if (shows_ == Shows::unknown) safeLight();
    if (trouble_) return tl::unexpected(*trouble_);
    return {};
}

void AnyProjectorStage::safeLight() noexcept {
    shows_ = Shows::unknown;
    try {
        const auto white =
            video_->mode().and_then([&](const VideoMode& mode) { return video_->show(uniformFrame(mode.size, 255)); });
        trouble_.reset();
        if (!white) trouble_ = white.error();
        if (white) shows_ = Shows::white;
        everThere_ = everThere_ || white;
    } catch (const std::exception&) {
        // Out of memory: what is shown stays, and is said to be unknown.
        shows_ = Shows::unknown;
    }
}

StageReport AnyProjectorStage::report() const {
    StageReport report;
    report.simulated = false;
    report.well = shows_ != Shows::unknown;
    report.lensName = "no lens";
    report.lensLine = "no lens is driven";
    const std::string display = "projector on " + video_->display().connector;
    switch (shows_) {
    case Shows::unknown:
        report.projectorLine = display + ": its light is not known";
        break;
    case Shows::white:
        report.projectorLine = display + ": steady white";
        break;
    case Shows::rehearsal:
        report.projectorLine = display + ": rehearsal, " +
                               (chosen_.slot ? "slot " + std::to_string(*chosen_.slot) : "all slots mixed") +
                               "; not in time, so nothing is blurred";
        break;
    }
    const DeviceHealth health = !trouble_ && shows_ != Shows::unknown ? DeviceHealth::well
                                : everThere_                          ? DeviceHealth::unplugged
                                                                      : DeviceHealth::absent;
    report.devices = {{"display", health, display, trouble_ ? trouble_->what : deviceLine()}};
    return report;
}

std::string AnyProjectorStage::deviceLine() const {
    switch (shows_) {
    case Shows::unknown:
        break;
    case Shows::white:
        return "It shows steady white light; TAKE shows the rehearsal.";
    case Shows::rehearsal:
        return "It shows " + (chosen_.slot ? "slot " + std::to_string(*chosen_.slot) : "the mix of all slots") +
               ", not in time: nothing is blurred.";
    }
    return "It was not looked for yet.";
}

}  // namespace ilf::devices
