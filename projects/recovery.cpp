#include "projects/recovery.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "projects/json.h"
#include "projects/process_identity.h"
#include "projects/project_extras.h"
#include "projects/safe_file.h"
#include "projects/xdg.h"

namespace ilf::projects {
namespace {

using Clock = std::chrono::system_clock;

const char* const kSessionFormat = "illuminatedfocus-session";
const char* const kStartsFormat = "illuminatedfocus-starts";
constexpr std::size_t kMostOfRecovery = std::size_t{1} << 20;
constexpr double kSkippedKeptFor_s = 30.0 * 24 * 3600;
constexpr double kCrashWindow_s = 5.0 * 60;
constexpr int kCrashesForSafeStart = 2;

fs::path autosaveFolder() { return stateDir() / "autosave"; }
fs::path sessionFile(const fs::path& folder) { return folder / "session.json"; }
fs::path projectIn(const fs::path& folder) { return folder / "project.ilfd"; }

double unixSeconds(Clock::time_point time) { return std::chrono::duration<double>(time.time_since_epoch()).count(); }

/// An object of one of our formats, or nothing.
std::optional<Json> readState(const fs::path& file, const char* format) {
    const auto json = readWhole(file, kMostOfRecovery).and_then([&](const std::string& text) {
        return Json::parse(text, file.filename().string());
    });
    if (!json || json->word("format") != format) return std::nullopt;
    return *json;
}

double numberOr0(const Json& json, const char* key) { return JsonReader(json, "").number(key, 0.0); }
bool flagOf(const Json& json, const char* key) { return JsonReader(json, "").flag(key, false); }

/// A name for this process's session that no other has.
fs::path freshFolder() {
    static std::atomic<int> counter{0};
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now().time_since_epoch()).count();
    return autosaveFolder() / (std::to_string(ms) + "-" + std::to_string(::getpid()) + "-" + std::to_string(++counter));
}

Json signedSession(Json json) {
    json.set("format", std::string(kSessionFormat));
    json.set("version", 1);
    signWithProcess(json);
    return json;
}

/// The newest autosave that can be read.
Result<OpenedProject> openAutosave(const fs::path& folder) {
    auto opened = openProject(projectIn(folder));
    if (opened) return opened;
    for (const fs::path& backup : backupsOf(projectIn(folder))) {
        if (auto older = openProject(backup)) return older;
    }
    return opened;
}

}  // namespace

Result<AutosaveSession> beginSession() {
    const AutosaveSession session{freshFolder()};
    return makeFolders(session.folder)
        .and_then([&] { return writeAtomically(sessionFile(session.folder), signedSession({}).text()); })
        .map([&] { return session; });
}

Result<ProjectExtras> autosave(const AutosaveSession& session, const Document& document, const ProjectExtras& extras,
                               const fs::path& original) {
    Json json = signedSession({});
    std::error_code ignored;
    json.set("original", original.empty() ? std::string() : fs::absolute(original, ignored).string());
    json.set("name", document.name);
    json.set("saved_unix_s", unixSeconds(Clock::now()));
    return makeFolders(session.folder)
        .and_then([&] { return writeAtomically(sessionFile(session.folder), json.text()); })
        .and_then(
            [&] { return saveProject(projectIn(session.folder), document, extras, Backups::keep, OtherFiles::leave); });
}

void workIsSaved(const AutosaveSession& session) {
    removeQuietly(projectIn(session.folder));
    removeQuietly(projectIn(session.folder).string() + ".backups");
}

void endSession(const AutosaveSession& session) { removeQuietly(session.folder); }

std::vector<PendingRecovery> pendingRecoveries() {
    std::vector<PendingRecovery> pending;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(autosaveFolder(), error)) {
        const fs::path& folder = entry.path();
        const auto json = readState(sessionFile(folder), kSessionFormat);
        if (!json || signerLives(*json)) continue;
        const double saved = numberOr0(*json, "saved_unix_s");
        std::error_code ignored;
        const bool work = fs::exists(projectIn(folder), ignored) || !backupsOf(projectIn(folder)).empty();
        const bool skipped = flagOf(*json, "skipped");
        if (!work || (skipped && unixSeconds(Clock::now()) - saved > kSkippedKeptFor_s)) {
            removeQuietly(folder);
            continue;
        }
        if (skipped) continue;
        PendingRecovery found;
        found.folder = folder;
        found.name = json->word("name");
        found.original = json->word("original");
        found.originalExists = !found.original.empty() && fs::exists(found.original, ignored);
        found.savedAt =
            Clock::time_point(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(saved)));
        pending.push_back(std::move(found));
    }
    std::sort(pending.begin(), pending.end(), [](const auto& a, const auto& b) { return a.savedAt > b.savedAt; });
    return pending;
}

Result<Recovered> recover(const PendingRecovery& pending) {
    auto project = openAutosave(pending.folder);
    if (!project) return tl::unexpected(project.error());
    // Renaming takes the folder from any other window that is asking the same question.
    const fs::path folder = freshFolder();
    std::error_code error;
    fs::rename(pending.folder, folder, error);
    if (error) return fail(Fault::notFound, "Another window has recovered \"" + pending.name + "\" already.");
    const Json before = readState(sessionFile(folder), kSessionFormat).value_or(Json());
    if (auto claimed = writeAtomically(sessionFile(folder), signedSession(before).text()); !claimed) {
        return tl::unexpected(claimed.error());
    }
    // What lies beside the project's files is with the original, not with its autosave.
    ProjectExtras::State state = project->extras.state();
    state.origin = pending.original;
    project->extras = ProjectExtras(std::make_shared<ProjectExtras::State>(std::move(state)));
    return Recovered{*std::move(project), pending.original, AutosaveSession{folder}};
}

void skipRecovery(const PendingRecovery& pending) {
    auto json = readState(sessionFile(pending.folder), kSessionFormat);
    if (!json) return;
    json->set("skipped", true);
    // When this cannot be written the question comes again, which is the safe side.
    static_cast<void>(writeAtomically(sessionFile(pending.folder), json->text()));
}

StartReport noteStart(Clock::time_point now) {
    const fs::path file = stateDir() / "starts.json";
    const Json before = readState(file, kStartsFormat).value_or(Json());
    std::vector<Json> starts;
    StartReport report;
    for (const Json& start : before.objects("starts")) {
        const double age = unixSeconds(now) - numberOr0(start, "at_unix_s");
        if (age < 0.0 || age > kCrashWindow_s) continue;
        starts.push_back(start);
        if (!flagOf(start, "ended_well") && !signerLives(start)) ++report.crashes;
    }
    Json mine;
    signWithProcess(mine);
    mine.set("at_unix_s", unixSeconds(now));
    mine.set("ended_well", false);
    starts.push_back(mine);
    Json json = before;
    json.set("format", std::string(kStartsFormat));
    json.set("version", 1);
    json.set("starts", starts);
    // A log of crashes that cannot be written must not keep the studio from starting.
    static_cast<void>(makeFolders(stateDir()).and_then([&] { return writeAtomically(file, json.text()); }));
    report.offerSafeStart = report.crashes >= kCrashesForSafeStart;
    if (report.offerSafeStart) {
        report.sentence =
            "The studio ended unexpectedly " + std::to_string(report.crashes) +
            " times in the last five minutes. Nothing was put on show by itself; the autosaved work is kept.";
    }
    return report;
}

void noteGoodEnd() {
    const fs::path file = stateDir() / "starts.json";
    auto json = readState(file, kStartsFormat);
    if (!json) return;
    std::vector<Json> starts = json->objects("starts");
    for (Json& start : starts) {
        if (signedByMe(start)) start.set("ended_well", true);
    }
    json->set("starts", starts);
    static_cast<void>(writeAtomically(file, json->text()));
}

}  // namespace ilf::projects
