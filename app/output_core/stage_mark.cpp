#include "app/output_core/stage_mark.h"

#include <fstream>

namespace ilf::app {
namespace {

std::filesystem::path file(const std::filesystem::path& directory) { return directory / "stage-in-use"; }

}  // namespace

void markStage(const std::filesystem::path& runtimeDirectory) { std::ofstream(file(runtimeDirectory)).put('\n'); }

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
