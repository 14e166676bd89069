#include "app/studio/keeper.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "projects/recent.h"
#include "projects/safe_file.h"
#include "projects/xdg.h"

namespace ilf::app {
namespace fs = std::filesystem;
namespace {

// Painting goes on meanwhile on other tiles, so a save is cheap; but it should not run after every dab.
constexpr double kRestBeforeAutosave_s = 3.0, kAutosaveEvery_s = 30.0;
constexpr std::size_t kNever = static_cast<std::size_t>(-1);

fs::path layoutFile() { return projects::configDir() / "layout.txt"; }

double monotonic_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string timeOfDay(std::chrono::system_clock::time_point at) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(at);
    std::tm local{};
    localtime_r(&seconds, &local);
    char text[32];
    (void)std::strftime(text, sizeof text, "%F %H:%M", &local);
    return text;
}

}  // namespace

Keeper::Keeper(std::function<void()> onNews)
    : onNews_(std::move(onNews)), thread_([this](std::stop_token stop) { run(stop); }) {
    const auto start = projects::noteStart();
    crashedLately_ = start.offerSafeStart;
    if (!start.sentence.empty()) news_.push_back({.sentence = start.sentence, .well = false});
    if (auto session = projects::beginSession()) {
        session_ = *std::move(session);
    } else {
        news_.push_back({.sentence = session.error().what, .well = false});
    }
    readRecent();
}

Keeper::~Keeper() {
    thread_.request_stop();
    arrived_.notify_all();
}

void Keeper::run(std::stop_token stop) {
    while (true) {
        std::function<void()> task;
        {
            std::unique_lock lock(mutex_);
            working_ = false;
            idle_.notify_all();
            arrived_.wait(lock, stop, [this] { return !tasks_.empty(); });
            if (tasks_.empty()) return;  // asked to stop, and everything asked for is done
            task = std::move(tasks_.front());
            tasks_.pop_front();
            working_ = true;
        }
        try {
            task();
        } catch (const std::exception& e) {  // a library threw, or memory ran out
            const std::scoped_lock lock(mutex_);
            news_.push_back({.sentence = std::string("A file could not be written: ") + e.what() + ". Save again.",
                             .well = false,
                             .retryAutosave = true});
        }
        onNews_();
    }
}

void Keeper::finish() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this] { return tasks_.empty() && !working_; });
}

void Keeper::later(std::function<void()> task) {
    {
        const std::scoped_lock lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    arrived_.notify_one();
}

void Keeper::opened(const OpenedFile& file, std::size_t revision, const Document* leftUnsaved) {
    if (leftUnsaved != nullptr && session_) {
        autosaveNow(*leftUnsaved);
        if (auto fresh = projects::beginSession()) session_ = *std::move(fresh);
    }
    ++project_;
    path_ = file.projectPath;
    extras_ = file.extras;
    autosavedRevision_ = revision;
    saved_ = file.recovered ? std::nullopt : std::optional(file.document);
    savedAt_s_ = -1.0;
    if (path_.empty()) return;
    (void)projects::rememberProject(path_, file.document.name);
    readRecent();
}

void Keeper::save(const std::string& named, Document document) {
    // A name without an ending becomes a folder project, the form that shows well in version control.
    const std::string ending = fs::path(named).extension().string();
    const std::string path = ending == ".ilfd" || ending == ".ilf" ? named : named + ".ilfd";
    later([this, path, document = std::move(document), extras = extras_, session = session_, project = project_] {
        auto saved = projects::saveProject(path, document, extras);
        News news;
        news.project = project;
        if (saved) {
            news.sentence = "Saved " + path;
            news.extras = *std::move(saved);
            news.saved = document;
            news.path = path;
            if (session) projects::workIsSaved(*session);
            (void)projects::rememberProject(path, document.name);
        } else {
            news.sentence = saved.error().what;
            news.well = false;
        }
        const std::scoped_lock lock(mutex_);
        news_.push_back(std::move(news));
    });
}

void Keeper::autosaveIfDue(const Document& document, std::size_t revision, double now_s) {
    if (revision == autosavedRevision_) return;
    if (revision != seenRevision_) seenAt_s_ = now_s;
    seenRevision_ = revision;
    if (now_s - seenAt_s_ < kRestBeforeAutosave_s && now_s - autosavedAt_s_ < kAutosaveEvery_s) return;
    autosavedRevision_ = revision;
    autosavedAt_s_ = now_s;
    if (unsaved(document)) autosaveNow(document);
}

void Keeper::autosaveNow(const Document& document) {
    if (!session_) return;
    later([this, document, session = *session_, extras = extras_, path = path_] {
        const auto kept = projects::autosave(session, document, extras, path);
        if (kept) return;
        const std::scoped_lock lock(mutex_);
        news_.push_back({.sentence = "Autosave failed: " + kept.error().what, .well = false, .retryAutosave = true});
    });
}

std::vector<std::pair<std::string, bool>> Keeper::takeSentences() {
    std::vector<News> news;
    {
        const std::scoped_lock lock(mutex_);
        news.swap(news_);
    }
    std::vector<std::pair<std::string, bool>> sentences;
    for (News& one : news) {
        if (one.saved && one.project == project_) {
            extras_ = *std::move(one.extras);
            saved_ = *std::move(one.saved);
            savedAt_s_ = monotonic_s();
            path_ = one.path;
        }
        if (one.saved) readRecent();
        if (one.retryAutosave) autosavedRevision_ = kNever;
        (one.well ? spdlog::info("{}", one.sentence) : spdlog::error("{}", one.sentence));
        sentences.emplace_back(std::move(one.sentence), one.well);
    }
    return sentences;
}

double Keeper::savedAgo_s() const { return savedAt_s_ < 0.0 ? -1.0 : monotonic_s() - savedAt_s_; }

void Keeper::readRecent() {
    recent_.clear();
    for (const auto& project : projects::recentProjects()) {
        recent_.push_back({project.path.string(), project.missing ? project.name + " (not there)" : project.name});
    }
}

std::optional<std::string> Keeper::lastOther() const {
    for (const ui::RecentFile& file : recent_) {
        if (file.path != path_) return file.path;
    }
    return std::nullopt;
}

std::optional<ui::RecoveryQuestion> Keeper::recoveryQuestion() {
    auto pending = projects::pendingRecoveries();
    if (pending.empty()) return std::nullopt;
    pending_ = std::move(pending.front());
    return ui::RecoveryQuestion{"\"" + pending_->name + "\", painted until " + timeOfDay(pending_->savedAt),
                                pending_->originalExists};
}

Result<std::optional<OpenedFile>> Keeper::answered(ui::Recover::Choice choice) {
    if (!pending_) return std::optional<OpenedFile>();
    const projects::PendingRecovery pending = *std::exchange(pending_, std::nullopt);
    if (choice == ui::Recover::Choice::recover) {
        auto recovered = projects::recover(pending);
        if (!recovered) return tl::unexpected(recovered.error());
        if (session_) projects::endSession(*session_);
        session_ = recovered->session;
        OpenedFile file;
        file.document = std::move(recovered->project.document);
        file.extras = std::move(recovered->project.extras);
        file.projectPath = recovered->original.string();
        file.recovered = true;
        file.note = "Recovered. Save to keep it.";
        return std::optional(std::move(file));
    }
    if (choice == ui::Recover::Choice::skip || !pending.originalExists) {
        projects::skipRecovery(pending);
        return std::optional<OpenedFile>();
    }
    auto opened = openAny(pending.original.string());
    if (!opened) return tl::unexpected(opened.error());
    projects::skipRecovery(pending);
    return std::optional(*std::move(opened));
}

std::string Keeper::layoutText() const {
    std::ifstream file(layoutFile());
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

void Keeper::closed(const std::string& layoutText, const Document& document) {
    std::error_code ignored;
    fs::create_directories(layoutFile().parent_path(), ignored);
    if (const auto kept = projects::writeAtomically(layoutFile(), layoutText); !kept) {
        spdlog::warn("{}", kept.error().what);
    }
    // Unsaved work stays where recovery finds it.
    if (session_ && !unsaved(document)) projects::endSession(*session_);
    projects::noteGoodEnd();
}

}  // namespace ilf::app
