// Where the test data lies: real pictures, depth maps and clips that are not part of the repository.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace ilf {

/// The path of `relative` inside the test data (IF_TEST_DATA, by default ../shared/data beside the repository). Without
/// it: says so aloud and gives nothing; the case then returns.
///
///     const auto picture = testData("02_depth/desk.png");
///     if (!picture) return;
inline std::optional<std::filesystem::path> testData(const std::string& relative) {
    const char* set = std::getenv("IF_TEST_DATA");
    const std::filesystem::path root =
        set != nullptr ? std::filesystem::path(set) : std::filesystem::path(ILF_SOURCE_DIR) / ".." / "shared" / "data";
    const std::filesystem::path file = root / relative;
    std::error_code error;
    if (std::filesystem::exists(file, error)) return file;
    std::printf("SKIPPED: test data absent: %s (set IF_TEST_DATA to the folder that holds it)\n", file.c_str());
    std::fflush(stdout);
    return std::nullopt;
}

}  // namespace ilf
