#include "app/output_core/stage_mark.h"

#include <cmath>
#include <fstream>
#include <iomanip>

namespace ilf::app {
namespace {

std::filesystem::path file(const std::filesystem::path& directory) { return directory / "stage-in-use"; }

}  // namespace

void markStage(const std::filesystem::path& runtimeDirectory, Dioptre rest) {
    // Whole or not at all: it is read after a kill.
    auto beside = file(runtimeDirectory);
    beside += ".new";
    std::ofstream(beside) << std::setprecision(17) << rest.si() << '\n';
    std::error_code ignored;
    std::filesystem::rename(beside, file(runtimeDirectory), ignored);
}

Dioptre markedRest(const std::filesystem::path& runtimeDirectory) {
    constexpr double kMost_D = 20.0;  // no prescription is beyond
    double power_D = 0.0;
    std::ifstream(file(runtimeDirectory)) >> power_D;
    return Dioptre::fromSi(std::abs(power_D) <= kMost_D ? power_D : 0.0);
}

void unmarkStage(const std::filesystem::path& runtimeDirectory) {
    std::error_code ignored;
    std::filesystem::remove(file(runtimeDirectory), ignored);
}

bool stageIsMarked(const std::filesystem::path& runtimeDirectory) {
    std::error_code ignored;
    return std::filesystem::exists(file(runtimeDirectory), ignored);
}

std::filesystem::path guardLock(const std::filesystem::path& runtimeDirectory) {
    return runtimeDirectory / "guard.lock";
}

}  // namespace ilf::app
