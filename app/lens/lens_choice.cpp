#include "app/lens/lens_choice.h"

namespace ilf::app {

Result<Rig> withOptions(Rig rig, const LensChoice& options) {
    if (!options.waves.empty()) {
        const auto mode = waveModeFromWord(options.waves);
        if (!mode) {
            return fail(Fault::outOfRange, "\"" + options.waves +
                                               "\" is no way to choose waves: write ideal-sine, paper, slot-aware, "
                                               "continuous or shaped.");
        }
        rig.waves = *mode;
    }
    if (!options.file.empty()) rig.lens = options.file;
    return rig;
}

Result<devices::SimulatedLens> simulatedLens(const LensChoice& options) {
    if (options.simulated.empty()) return devices::kUsualLens;
    if (const auto lens = devices::simulatedLensFromWord(options.simulated)) return *lens;
    return fail(Fault::outOfRange,
                "\"" + options.simulated +
                    "\" is no simulated lens: write slow, datasheet, lively, clean, dirty or ideal.");
}

Result<Plan> plannedFor(Document& document, const LensChoice& options) {
    const auto lens = simulatedLens(options);
    if (!lens) return tl::unexpected(lens.error());
    auto rig = withOptions(document.rig, options);
    if (!rig) return tl::unexpected(rig.error());
    document.rig = *std::move(rig);
    LensPlanner planner(*lens);
    const auto input = planner.input(document);
    if (!input) return tl::unexpected(input.error());
    return planner.plan(*input, nullptr, true);
}

}  // namespace ilf::app
