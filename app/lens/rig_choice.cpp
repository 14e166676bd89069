#include "app/lens/rig_choice.h"

#include <filesystem>

#include "app/rigs.h"
#include "core/plan/projector.h"

namespace ilf::app {

Result<Rig> withOptions(Rig rig, const RigChoice& choice) {
    if (!choice.rig.empty()) {
        auto chosen = rigFrom(choice.rig);
        if (!chosen) return chosen;
        rig = *std::move(chosen);
    }
    if (choice.bits) rig = withProjector(std::move(rig), rig.kind, *choice.bits);
    if (!choice.waves.empty()) {
        const auto mode = waveModeFromWord(choice.waves);
        if (!mode) {
            return fail(Fault::outOfRange, "\"" + choice.waves +
                                               "\" is no way to choose waves: write ideal-sine, paper, slot-aware, "
                                               "continuous or shaped.");
        }
        rig.waves = *mode;
    }
    if (!choice.file.empty()) rig.lens = choice.file;
    return rig;
}

Result<devices::SimulatedLens> simulatedLens(const RigChoice& choice) {
    if (choice.simulated.empty()) return devices::kUsualLens;
    const auto lens = devices::simulatedLensFromWord(choice.simulated);
    if (!lens) {
        return fail(Fault::outOfRange,
                    "\"" + choice.simulated +
                        "\" is no simulated lens: write slow, datasheet, lively, clean, dirty or ideal.");
    }
    if (isEmulatedRig(choice.rig) && !lens->preset) {
        return fail(Fault::outOfRange, "The ideal lens is told powers and takes no current, so it cannot hang on the "
                                       "emulated rig's cables: choose slow, datasheet, lively, clean or dirty.");
    }
    return *lens;
}

Result<std::vector<std::string>> coreArguments(const RigChoice& choice) {
    const auto lens = simulatedLens(choice);
    if (!lens) return tl::unexpected(lens.error());
    auto arguments = devices::coreArguments(*lens);
    if (choice.rig.empty() || choice.rig == kSimulatedRig) return arguments;
    std::string rig = choice.rig;
    if (choice.bits && isEmulatedRig(rig)) {
        rig = std::string(kEmulatedRig) + ":" + std::to_string(*choice.bits);
    } else if (choice.bits) {
        return fail(Fault::outOfRange,
                    "How many bits the pictures of a rig's projector have is said in its file, which "
                    "the output core reads as well: change it there, or leave --bits out.");
    }
    std::error_code ignored;  // a core is started from anywhere
    if (!isEmulatedRig(rig)) rig = std::filesystem::absolute(rig, ignored).string();
    arguments.emplace_back("--rig");
    arguments.push_back(std::move(rig));
    return arguments;
}

Result<Plan> plannedFor(Document& document, const RigChoice& choice) {
    const auto lens = simulatedLens(choice);
    if (!lens) return tl::unexpected(lens.error());
    auto rig = withOptions(document.rig, choice);
    if (!rig) return tl::unexpected(rig.error());
    document.rig = *std::move(rig);
    LensPlanner planner(*lens);
    const auto input = planner.input(document);
    if (!input) return tl::unexpected(input.error());
    return planner.plan(*input, nullptr, true);
}

std::string inWords(const RigChoice& choice) {
    if (isEmulatedRig(choice.rig)) return "the emulated rig";
    if (choice.rig.empty() || choice.rig == kSimulatedRig) return "the simulated devices";
    return "the rig of " + choice.rig;
}

}  // namespace ilf::app
