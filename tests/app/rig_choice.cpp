// `--rig` and `--bits`: which rig is planned for, and what the output core is started with.
#include "app/lens/rig_choice.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "app/rigs.h"
#include "core/plan/projector.h"
#include "projects/wearer_rig.h"
#include "tests/projects/folder.h"

using namespace ilf;
using namespace ilf::app;

namespace {

using Words = std::vector<std::string>;

Rig documents() {
    Rig rig;
    rig.name = "The document's";
    rig.waves = WaveMode::shaped;
    return rig;
}

}  // namespace

TEST_CASE("rig choice: without a word the document's rig stays, and the core simulates") {
    CHECK(withOptions(documents(), {}).value() == documents());
    CHECK(coreArguments(RigChoice{}).value() == Words{"--simulated-lens", "datasheet"});
    CHECK(inWords(RigChoice{}) == "the simulated devices");
}

TEST_CASE("rig choice: the emulated rig, with as many slots as its bits allow, for plan and core alike") {
    CHECK(withOptions(documents(), {.rig = "emulated"}).value() == emulatedRig());
    CHECK(coreArguments({.rig = "emulated"}).value() == Words{"--simulated-lens", "datasheet", "--rig", "emulated"});
    for (const auto& [bits, slots] : {std::pair{1, 24}, {2, 12}, {3, 8}, {4, 6}, {8, 2}}) {
        const RigChoice choice{.rig = "emulated", .bits = bits};
        const auto rig = withOptions(documents(), choice);
        REQUIRE(rig);
        CHECK(rig->bits == bits);
        CHECK(slotsPerSweep(*rig) == slots);
        CHECK(checkedProjector(*rig));
        const auto arguments = coreArguments(choice);
        REQUIRE(arguments);
        CHECK(rigFrom(arguments->back()).value() == *rig);  // the core packs as many bits as are planned
        CHECK(isEmulatedRig(arguments->back()));
    }
    for (const char* no : {"emulated:", "emulated:0", "emulated:9", "emulated:44", "emulatedly", "simulated", ""})
        CHECK_FALSE(isEmulatedRig(no));
}

TEST_CASE("rig choice: a file by its whole path; its bits are its own; what cannot be is refused in words") {
    const Folder folder;
    const auto file = (folder / "room.json").string();
    REQUIRE(projects::writeRig(file, emulatedRig()));
    const auto relative = std::filesystem::relative(file).string();
    CHECK(withOptions(documents(), {.rig = relative}).value() == emulatedRig());
    CHECK(std::filesystem::path(coreArguments({.rig = relative}).value().back()).is_absolute());
    CHECK_FALSE(coreArguments({.rig = file, .bits = 2}));
    CHECK_FALSE(coreArguments({.rig = "emulated", .simulated = "ideal"}));
    CHECK_FALSE(withOptions(documents(), {.rig = (folder / "none.json").string()}));
}
