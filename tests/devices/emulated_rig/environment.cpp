// What programs read to see an emulated rig, and what it refuses in words.
#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "devices/emulated_rig/emulated_rig.h"
#include "devices/emulated_rig/rig_mishaps.h"
#include "devices/link/rig_environment.h"
#include "devices/link/runtime_directory.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

struct Directory {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("ilf-rig-environment-" + std::to_string(getpid()));
    Directory() { REQUIRE(prepareRuntimeDirectory(path)); }
    ~Directory() { std::filesystem::remove_all(path); }
    Directory(const Directory&) = delete;
    Directory& operator=(const Directory&) = delete;
};

}  // namespace

TEST_CASE("rig environment: what was written is read, and nothing before or after") {
    const Directory directory;
    CHECK_FALSE(rigEnvironment(directory.path));
    law("written and read", [&] {
        RigEnvironment environment;
        for (const char* name : {"UMOCKDEV_DIR", "DISPLAY", "LD_PRELOAD"})
            environment[name] = *rc::gen::container<std::string>(rc::gen::inRange(' ', '~'));
        RC_ASSERT(saveRigEnvironment(directory.path, environment));
        const auto read = rigEnvironment(directory.path);
        RC_ASSERT(read);
        RC_ASSERT(*read == environment);
    });
    removeRigEnvironment(directory.path);
    removeRigEnvironment(directory.path);
    const auto gone = rigEnvironment(directory.path);
    REQUIRE_FALSE(gone);
    CHECK(gone.error().fault == Fault::notFound);

    std::ofstream(rigEnvironmentFile(directory.path)) << "no variable\n";
    CHECK(rigEnvironment(directory.path).error().fault == Fault::badFile);
    CHECK(saveRigEnvironment(directory.path / "missing", {}).error().fault == Fault::cannotWrite);
}

TEST_CASE("emulated rig: without its preloaded library, or beside other devices, it refuses in a sentence") {
    const Directory directory;
    const auto serve = [&] {
        return serveEmulatedRig(directory.path, LensPreset::datasheet, STDIN_FILENO, [](const std::string&) {});
    };
    // This file's test is run without the library (tests/CMakeLists.txt).
    if (const char* preload = std::getenv("LD_PRELOAD"); preload == nullptr || *preload == '\0') {
        const auto refused = serve();
        REQUIRE_FALSE(refused);
        CHECK(refused.error().what.find("libumockdev-preload.so.0 (package umockdev)") != std::string::npos);
    }
    CHECK_FALSE(rigEnvironment(directory.path));
    const auto held = FileLock::tryTake(devicesLock(directory.path));
    REQUIRE(held);
    REQUIRE(*held);
    const auto refused = serve();
    REQUIRE_FALSE(refused);
    CHECK(refused.error().what == "Devices run in this runtime directory already.");
}

TEST_CASE("mishaps: every word of the list is one, with its count and amount") {
    std::string words = mishapWords() + ", ";
    int count = 0;
    for (std::size_t comma = words.find(", "); comma != std::string::npos; comma = words.find(", "), ++count) {
        const std::string word = words.substr(0, comma);
        words.erase(0, comma + 2);
        REQUIRE(mishapFromWord(word));
        const auto fault = faultOf({"projector", word, 7, 0, 2.5});
        CHECK(fault.kind == *mishapFromWord(word));
        CHECK(fault.after == 7);
        CHECK(fault.times > 1'000'000'000);
        CHECK(fault.amount == 2.5);
        CHECK(faultOf({"projector", word, 0, 3, 0.0}).times == 3);
    }
    CHECK(count == 10);
    CHECK_FALSE(mishapFromWord("boredom"));
}
