#include <doctest/doctest.h>

#include "projects/project_file.h"
#include "projects/safe_file.h"
#include "tests/projects/folder.h"
#include "tests/projects/some_document.h"

using namespace ilf;
using namespace ilf::projects;
namespace fs = std::filesystem;

namespace {

/// Saves `after` over `before`, letting the n-th step fail, for n = 1, 2, 3 ... until the save passes untouched.
int failEveryStep(const std::string& name, Failing how) {
    const Document before = fullDocument();
    Document after = before;
    after.name = "After";
    Region face = *after.regions[0];
    face.mask = speckled(after.scene.size(), 99);
    after.regions = {Box<Region>(face)};
    for (int step = 1;; ++step) {
        Folder folder;
        const fs::path path = folder / name;
        const auto extras = saveProject(path, before, {});
        REQUIRE(extras);
        bool reached = false, saved = false;
        {
            const FailAt failing(step, how);
            saved = saveProject(path, after, *extras).has_value();
            reached = failing.reached();
        }
        CAPTURE(name);
        CAPTURE(step);
        const auto opened = openProject(path);
        REQUIRE_MESSAGE(opened, opened.error().what);
        CHECK((opened->document == before || opened->document == after));
        if (saved) CHECK(opened->document == after);
        for (const fs::path& backup : backupsOf(path))
            CHECK(openProject(backup)->document == before);
        // The next save works, whatever the failed one left behind.
        REQUIRE(saveProject(path, after, *extras));
        CHECK(openProject(path)->document == after);
        if (!reached) {
            CHECK(saved);
            return step - 1;
        }
    }
}

}  // namespace

TEST_CASE("saving: whichever step fails, the project is the old one or the new one, whole") {
    for (const char* name : {"p.ilfd", "p.ilf"}) {
        const int full = failEveryStep(name, Failing::fullDisk);
        const int power = failEveryStep(name, Failing::powerFails);
        CHECK(full > 5);  // the scenario has that many steps at least, or nothing was tried
        CHECK(power > 5);
    }
}

TEST_CASE("saving: a failed first save leaves nothing behind, and says what to do") {
    for (int step = 1;; ++step) {
        Folder folder;
        bool reached = false;
        Result<ProjectExtras> saved = ProjectExtras();
        {
            const FailAt failing(step, Failing::fullDisk);
            saved = saveProject(folder / "p.ilfd", fullDocument(), {});
            reached = failing.reached();
        }
        if (!reached) break;
        CAPTURE(step);
        if (saved) continue;
        if (fs::exists(folder / "p.ilfd")) {
            CHECK(openProject(folder / "p.ilfd")->document == fullDocument());  // in place, but not confirmed
        } else {
            CHECK(saved.error().what.find("Make room on that disk") != std::string::npos);
            CHECK(fs::is_empty(folder.path()));
        }
    }
}

TEST_CASE("saving: leftovers of a save that was cut short are cleared by the next one") {
    Folder folder;
    REQUIRE(saveProject(folder / "p.ilfd", fullDocument(), {}));
    folder.put(".p.ilfd.new-999999999-1/masks/a.png", "half");  // no process has this number
    folder.put(".q.ilfd.new-999999999-1/masks/a.png", "another project's");
    REQUIRE(saveProject(folder / "p.ilfd", fullDocument(), {}));
    CHECK_FALSE(fs::exists(folder / ".p.ilfd.new-999999999-1"));
    CHECK(fs::exists(folder / ".q.ilfd.new-999999999-1"));
}

TEST_CASE("safe files: written whole or not at all") {
    for (const Failing how : {Failing::fullDisk, Failing::powerFails}) {
        for (int step = 1;; ++step) {
            Folder folder;
            REQUIRE(writeAtomically(folder / "a", "old"));
            bool reached = false, written = false;
            {
                const FailAt failing(step, how);
                written = writeAtomically(folder / "a", "new content").has_value();
                reached = failing.reached();
            }
            const std::string now = contentOf(folder / "a");
            CHECK((now == "old" || now == "new content"));
            if (written) CHECK(now == "new content");
            if (!reached) break;
        }
    }
    Folder folder;
    const fs::path file = folder.put("target", "x");
    fs::create_symlink(file, folder / "link");
    REQUIRE(writeAtomically(folder / "link", "y"));
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(contentOf(file) == "y");
    CHECK_FALSE(writeAtomically(folder.path(), "z"));
    CHECK_FALSE(readWhole(file, 0));
}
