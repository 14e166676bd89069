// Work that outlives a crash: autosaves of each running studio, and what dead ones left behind.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "projects/project_file.h"

namespace ilf::projects {

/// One running studio's folder, state/autosave/TIME-PID/. It names its process; when that is no more, what lies there
/// is offered for recovery. A value: functions below may be called from any thread, one at a time for one session.
struct AutosaveSession {
    std::filesystem::path folder;
};

Result<AutosaveSession> beginSession();

/// Saves what is edited, untitled or not (`original` empty: untitled), whole or not at all, with the last five
/// autosaves as backups. Never touches the project itself.
/// Gives the extras to autosave with the next time, so that what did not change is not encoded again.
Result<ProjectExtras> autosave(const AutosaveSession& session, const Document& document, const ProjectExtras& extras,
                               const std::filesystem::path& original);

/// The operator saved: what was autosaved or recovered is no longer needed. The only thing that deletes recovered work.
void workIsSaved(const AutosaveSession& session);

/// The studio ends in good order with nothing to keep: the session's folder goes.
void endSession(const AutosaveSession& session);

/// Work a dead studio left behind.
struct PendingRecovery {
    std::filesystem::path folder;
    std::string name;                ///< the document's
    std::filesystem::path original;  ///< empty: it was never saved
    bool originalExists = false;
    std::chrono::system_clock::time_point savedAt;
};
/// Newest first; those the operator skipped are not asked about again, and go after 30 days.
std::vector<PendingRecovery> pendingRecoveries();

struct Recovered {
    OpenedProject project;
    std::filesystem::path original;  ///< where "save" writes; empty: untitled
    AutosaveSession session;         ///< the dead studio's folder, now this one's: use it instead of a fresh one
};
/// Takes a session over. Its files stay until the recovered work is saved. When the newest autosave cannot be read, the
/// one before is taken. Refused when another window was faster.
Result<Recovered> recover(const PendingRecovery& pending);

/// The operator wants what was saved instead: remembered for this session.
void skipRecovery(const PendingRecovery& pending);

/// How often the studio crashed lately.
struct StartReport {
    int crashes = 0;              ///< starts of the last five minutes that did not end in good order
    bool offerSafeStart = false;  ///< two or more: nothing should be opened by itself
    std::string sentence;         ///< for the operator, or empty
};
/// To be called once at the start, and at an end in good order.
StartReport noteStart(std::chrono::system_clock::time_point now = std::chrono::system_clock::now());
void noteGoodEnd();

}  // namespace ilf::projects
