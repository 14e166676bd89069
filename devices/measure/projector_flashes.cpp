#include "devices/measure/projector_flashes.h"

#include <utility>

#include "core/compile/program.h"

namespace ilf::devices {
namespace {

// The first flashes come a frame after they were sent; what is heard from then on is the pattern.
constexpr std::chrono::milliseconds kBegun{200};

/// In the place of lenses that stand still: a stage sends light only when its lenses are in step, and none move here.
class LensesElsewhere : public StageLens {
public:
    explicit LensesElsewhere(Dioptre rest) : rest_(rest) {}
    Result<Second> play(const Waveform&, Second) override { return Second(); }
    Result<PhaseState> follow() override {
        PhaseState state;
        state.locked = true;
        return state;
    }
    Result<LensCondition> heartbeat() override {
        LensCondition condition;
        condition.sweeping = true;
        return condition;
    }
    Result<void> safe() override { return {}; }
    Dioptre rest() const override { return rest_; }
    std::string name() const override { return "lenses at rest, held by the measurement"; }

private:
    Dioptre rest_;
};

LightCrafterRig withoutLenses(LightCrafterRig rig) {
    rig.openLens = [](Dioptre rest) -> Result<std::unique_ptr<StageLens>> {
        return std::make_unique<LensesElsewhere>(rest);
    };
    return rig;
}

Program flashes(const FlashSetup& setup) {
    Program program;
    // Slotted light belongs to lenses that sweep; of these nothing is played.
    program.waveform = idealSine(Dioptre(), Dioptre(), 1.0_D, setup.sweepRate, Second());
    program.slotRate = setup.slotRate;
    program.projector = setup.raster;
    program.images = {LightImage(setup.raster, 255)};
    program.imageOfSlot.assign(static_cast<std::size_t>(setup.slotRate / setup.sweepRate + 0.5), Program::kDark);
    program.imageOfSlot.front() = 0;
    return program;
}

}  // namespace

ProjectorFlashes::ProjectorFlashes(LightCrafterRig rig, FlashSetup setup)
    : stage_(withoutLenses(rig)), setup_(setup), clock_(rig.clock) {}

Result<void> ProjectorFlashes::flash(bool on) {
    if (!on) {
        stage_.safeLight();
        return {};
    }
    return stage_.load(flashes(setup_)).and_then([&] { return stage_.swap(); }).and_then([&] {
        clock_.wait(kBegun);
        return stage_.heartbeat();
    });
}

}  // namespace ilf::devices
