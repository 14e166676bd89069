#include <doctest/doctest.h>
#include <sys/wait.h>

#include <csignal>
#include <functional>

#include "projects/recent.h"
#include "projects/recovery.h"
#include "projects/xdg.h"
#include "tests/projects/folder.h"
#include "tests/projects/some_document.h"

using namespace ilf;
using namespace ilf::projects;
namespace fs = std::filesystem;

namespace {

/// A state folder of the test's own.
struct State {
    Folder folder;
    State() { setenv("ILF_STATE_DIR", folder.path().c_str(), 1); }
    ~State() { unsetenv("ILF_STATE_DIR"); }
};

/// Does `work` in a process that is then killed as a crash does.
void inDyingProcess(const std::function<void()>& work) {
    const pid_t child = fork();
    if (child == 0) {
        work();
        raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
}

Document named(const std::string& name) {
    Document document = fullDocument();
    document.name = name;
    return document;
}

}  // namespace

TEST_CASE("recovery: work of a studio that was killed comes back, untitled or not") {
    const State state;
    const fs::path project = state.folder / "desk.ilfd";
    const auto extras = saveProject(project, named("saved"), {});
    REQUIRE(extras);
    state.folder.put("desk.ilfd/notes.txt", "mine");
    inDyingProcess([&] {
        const auto session = beginSession();
        if (session && autosave(*session, named("first"), *extras, project)) {
            static_cast<void>(autosave(*session, named("painted"), *extras, project));
        }
    });
    inDyingProcess([&] {
        const auto session = beginSession();
        if (session) static_cast<void>(autosave(*session, named("untitled work"), {}, {}));
    });
    inDyingProcess([] { static_cast<void>(beginSession()); });  // nothing was painted: nothing to ask

    const auto pending = pendingRecoveries();
    REQUIRE(pending.size() == 2);
    CHECK(pending[0].name == "untitled work");
    CHECK(pending[0].original.empty());
    CHECK(pending[1].name == "painted");
    CHECK(pending[1].original == project);
    CHECK(pending[1].originalExists);
    CHECK(openProject(project)->document == named("saved"));  // an autosave never touches the project

    auto recovered = recover(pending[1]);
    REQUIRE_MESSAGE(recovered, recovered.error().what);
    CHECK(recovered->project.document == named("painted"));
    CHECK(recovered->original == project);
    CHECK(recover(pending[1]).error().fault != Fault::outOfRange);  // a second window is told, not given half
    CHECK(pendingRecoveries().size() == 1);                         // this process lives, so its work is not pending

    // Saved where it came from: what lies beside the project's own files is still there.
    REQUIRE(saveProject(project, recovered->project.document, recovered->project.extras));
    CHECK(contentOf(project / "notes.txt") == "mine");
    workIsSaved(recovered->session);
    CHECK_FALSE(fs::exists(recovered->session.folder / "project.ilfd"));
    endSession(recovered->session);
    CHECK_FALSE(fs::exists(recovered->session.folder));
}

TEST_CASE("recovery: recovered work stays until it is saved, through another crash too") {
    const State state;
    inDyingProcess([] {
        const auto session = beginSession();
        if (session) static_cast<void>(autosave(*session, named("work"), {}, {}));
    });
    inDyingProcess([] {
        const auto pending = pendingRecoveries();
        if (!pending.empty()) static_cast<void>(recover(pending[0]));
    });
    const auto pending = pendingRecoveries();
    REQUIRE(pending.size() == 1);
    CHECK(recover(pending[0])->project.document == named("work"));
}

TEST_CASE("recovery: skipped once, not asked again; a damaged autosave gives the one before") {
    const State state;
    inDyingProcess([] {
        const auto session = beginSession();
        if (session && autosave(*session, named("older"), {}, {})) {
            static_cast<void>(autosave(*session, named("newer"), {}, {}));
        }
    });
    auto pending = pendingRecoveries();
    REQUIRE(pending.size() == 1);
    std::ofstream(pending[0].folder / "project.ilfd/project.json") << "torn";
    CHECK(recover(pending[0])->project.document == named("older"));

    inDyingProcess([] {
        const auto session = beginSession();
        if (session) static_cast<void>(autosave(*session, named("unwanted"), {}, {}));
    });
    pending = pendingRecoveries();
    REQUIRE(pending.size() == 1);
    skipRecovery(pending[0]);
    CHECK(pendingRecoveries().empty());
    CHECK(fs::exists(pending[0].folder / "project.ilfd"));  // and yet it is not gone
}

TEST_CASE("recovery: two crashes within five minutes offer a safe start") {
    const State state;
    const auto now = std::chrono::system_clock::now();
    CHECK_FALSE(noteStart(now).offerSafeStart);
    noteGoodEnd();
    inDyingProcess([&] { noteStart(now - std::chrono::minutes(9)); });
    inDyingProcess([&] { noteStart(now - std::chrono::minutes(4)); });
    CHECK(noteStart(now).crashes == 1);
    noteGoodEnd();
    inDyingProcess([&] { noteStart(now - std::chrono::minutes(1)); });
    const StartReport report = noteStart(now);
    CHECK(report.crashes == 2);
    CHECK(report.offerSafeStart);
    CHECK(report.sentence.find("2 times in the last five minutes") != std::string::npos);
    state.folder.put("starts.json", "torn");
    CHECK(noteStart(now).crashes == 0);
}

TEST_CASE("recent: newest first, once, missing ones marked and kept") {
    const State state;
    CHECK(recentProjects().empty());
    const fs::path a = state.folder.put("a.ilf", "x"), b = state.folder.put("\xE9\xAB\x98.ilf", "x");
    REQUIRE(rememberProject(a, "A"));
    REQUIRE(rememberProject(b, "B"));
    REQUIRE(rememberProject(a, "A again"));
    fs::remove(b);
    auto recent = recentProjects();
    REQUIRE(recent.size() == 2);
    CHECK(recent[0] == RecentProject{fs::weakly_canonical(a), "A again", false});
    CHECK(recent[1] == RecentProject{fs::weakly_canonical(b), "B", true});
    for (int i = 0; i < 30; ++i)
        REQUIRE(rememberProject(state.folder / std::to_string(i), "n"));
    CHECK(recentProjects().size() == kMostRecent);
    REQUIRE(forgetProject(state.folder / "29"));
    CHECK(recentProjects()[0].path.filename() == "28");
    state.folder.put("recent.json", "{torn");
    CHECK(recentProjects().empty());
    REQUIRE(rememberProject(a, "A"));
    CHECK(recentProjects().size() == 1);
}

TEST_CASE("xdg: the folders follow the environment, with fallbacks") {
    const auto with = [](const char* variable, const char* value, const fs::path& expected) {
        const char* before = std::getenv(variable);
        const std::string kept = before != nullptr ? before : "";
        setenv(variable, value, 1);
        CHECK(configDir() == expected);
        if (before != nullptr) {
            setenv(variable, kept.c_str(), 1);
        } else {
            unsetenv(variable);
        }
    };
    const char* home = std::getenv("HOME");
    const std::string kept = home != nullptr ? home : "/";
    setenv("HOME", "/home/curator", 1);
    unsetenv("XDG_CONFIG_HOME");
    unsetenv("ILF_CONFIG_DIR");
    CHECK(configDir() == "/home/curator/.config/illuminatedfocus");
    with("XDG_CONFIG_HOME", "/settings", "/settings/illuminatedfocus");
    with("XDG_CONFIG_HOME", "relative", "/home/curator/.config/illuminatedfocus");
    with("ILF_CONFIG_DIR", "/mine", "/mine");
    setenv("HOME", kept.c_str(), 1);
}
