// The keeper: saves, autosaves, recovers and remembers projects, with the disk on a thread of its own.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/open.h"
#include "core/document/document.h"
#include "projects/recovery.h"
#include "ui/request.h"
#include "ui/state.h"
#include "ui/view.h"

namespace ilf::app {

/// Main thread only. Documents are values: they go to the thread as they are, and painting goes on meanwhile.
class Keeper {
public:
    explicit Keeper(std::function<void()> onNews);
    ~Keeper();

    /// Another project is shown (a recovered one counts as unsaved); `revision` is History::revision of its first
    /// state. `leftUnsaved` is the project it replaces if that was not saved: its autosave stays, and is offered for
    /// recovery at the next start.
    void opened(const OpenedFile& file, std::size_t revision, const Document* leftUnsaved);
    const std::string& projectPath() const { return path_; }
    const projects::ProjectExtras& extras() const { return extras_; }
    void setExtras(projects::ProjectExtras extras) { extras_ = std::move(extras); }

    /// By content: what was painted and taken back again is saved.
    bool unsaved(const Document& document) const { return project_ > 0 && !(saved_ && document == *saved_); }
    /// Seconds since the last save; negative: not saved since it was opened.
    double savedAgo_s() const;
    /// To NAME.ilfd (a folder) or NAME.ilf (an archive); a name with neither gets .ilfd.
    void save(const std::string& named, Document document);
    /// Three seconds after the last change, and every 30 s while changes go on; undo and redo count as changes.
    void autosaveIfDue(const Document& document, std::size_t revision, double now_s);
    void autosaveNow(const Document& document);

    /// Sentences about what was saved (true) or not (false) since the last call.
    std::vector<std::pair<std::string, bool>> takeSentences();

    std::vector<ui::RecentFile> recent() const { return recent_; }
    /// The project that was open before this one.
    std::optional<std::string> lastOther() const;

    /// What a crash left behind, if anything.
    std::optional<ui::RecoveryQuestion> recoveryQuestion();
    /// The operator's answer: the recovered or saved project, or nothing to open.
    Result<std::optional<OpenedFile>> answered(ui::Recover::Choice choice);

    std::string layoutText() const;
    /// The studio ends: the layout is kept, and an autosave that is no longer needed goes.
    void closed(const std::string& layoutText, const Document& document);
    /// Waits until everything asked for is on the disk, and takes the news of it.
    void finish();
    /// The studio crashed again and again lately: nothing should happen by itself.
    bool crashedLately() const { return crashedLately_; }

private:
    void run(std::stop_token stop);
    void later(std::function<void()> task);
    void readRecent();

    std::string path_;
    projects::ProjectExtras extras_;
    std::optional<Document> saved_;  ///< as it was when last opened or saved; nothing: never
    std::size_t autosavedRevision_ = 0, seenRevision_ = 0;
    std::uint64_t project_ = 0;  ///< counts projects shown: late news of another one is only said
    bool crashedLately_ = false;
    double savedAt_s_ = -1.0, autosavedAt_s_ = 0.0, seenAt_s_ = 0.0;
    std::vector<ui::RecentFile> recent_;
    std::optional<projects::AutosaveSession> session_;
    std::optional<projects::PendingRecovery> pending_;

    struct News {
        std::string sentence{};
        bool well = true;
        std::optional<projects::ProjectExtras> extras{};
        std::optional<Document> saved{};
        std::string path{};
        std::uint64_t project = 0;
        bool retryAutosave = false;
    };
    std::function<void()> onNews_;
    std::mutex mutex_;
    std::condition_variable_any arrived_;
    std::deque<std::function<void()>> tasks_;
    std::vector<News> news_;
    bool working_ = false;  ///< guarded by mutex_
    std::condition_variable idle_;
    std::jthread thread_;  // last: finishes what was asked before it goes
};

}  // namespace ilf::app
