#include "app/studio/keeper.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "projects/recent.h"
#include "projects/safe_file.h"
#include "projects/xdg.h"

namespace ilf::app {
namespace fs = std::filesystem;
namespace {

constexpr double kAutosaveEvery_s = 30.0;
constexpr std::size_t kNeverSaved = static_cast<std::size_t>(-1);

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
    if (!start.sentence.empty()) news_.push_back({start.sentence, false, {}, {}, {}});
    if (auto session = projects::beginSession()) {
        session_ = *std::move(session);
    } else {
        news_.push_back({session.error().what, false, {}, {}, {}});
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
            arrived_.wait(lock, stop, [this] { return !tasks_.empty(); });
            if (tasks_.empty()) return;  // asked to stop, and everything asked for is done
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        task();
        onNews_();
    }
}

void Keeper::later(std::function<void()> task) {
    {
        const std::scoped_lock lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    arrived_.notify_one();
}

void Keeper::opened(const OpenedFile& file, std::size_t revision) {
    path_ = file.projectPath;
    extras_ = file.extras;
    autosavedRevision_ = revision;
    savedRevision_ = file.recovered ? kNeverSaved : revision;
    savedAt_s_ = -1.0;
    if (path_.empty()) return;
    (void)projects::rememberProject(path_, file.document.name);
    readRecent();
}

void Keeper::save(const std::string& named, Document document, std::size_t revision) {
    // A name without an ending becomes a folder project, the form that shows well in version control.
    const std::string ending = fs::path(named).extension().string();
    const std::string path = ending == ".ilfd" || ending == ".ilf" ? named : named + ".ilfd";
    later([this, path, document = std::move(document), revision, extras = extras_, session = session_] {
        auto saved = projects::saveProject(path, document, extras);
        News news;
        if (saved) {
            news = {"Saved " + path, true, *std::move(saved), revision, path};
            if (session) projects::workIsSaved(*session);
            (void)projects::rememberProject(path, document.name);
        } else {
            news = {saved.error().what, false, {}, {}, {}};
        }
        const std::scoped_lock lock(mutex_);
        news_.push_back(std::move(news));
    });
}

void Keeper::autosaveIfDue(const Document& document, std::size_t revision, double now_s) {
    if (revision == autosavedRevision_ || now_s - autosavedAt_s_ < kAutosaveEvery_s) return;
    autosavedRevision_ = revision;
    autosavedAt_s_ = now_s;
    autosaveNow(document);
}

void Keeper::autosaveNow(const Document& document) {
    if (!session_) return;
    later([this, document, session = *session_, extras = extras_, path = path_] {
        if (const auto saved = projects::autosave(session, document, extras, path); !saved) {
            const std::scoped_lock lock(mutex_);
            news_.push_back({"Autosave failed: " + saved.error().what, false, {}, {}, {}});
        }
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
        if (one.extras) extras_ = *std::move(one.extras);
        if (one.savedRevision) {
            savedRevision_ = autosavedRevision_ = *one.savedRevision;
            savedAt_s_ = monotonic_s();
            path_ = one.path;
            readRecent();
        }
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
    projects::skipRecovery(pending);
    if (choice == ui::Recover::Choice::skip || !pending.originalExists) return std::optional<OpenedFile>();
    auto opened = openAny(pending.original.string());
    if (!opened) return tl::unexpected(opened.error());
    return std::optional(*std::move(opened));
}

std::string Keeper::layoutText() const {
    std::ifstream file(layoutFile());
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

void Keeper::closed(const std::string& layoutText, std::size_t revision) {
    std::error_code ignored;
    fs::create_directories(layoutFile().parent_path(), ignored);
    if (const auto kept = projects::writeAtomically(layoutFile(), layoutText); !kept) {
        spdlog::warn("{}", kept.error().what);
    }
    // Unsaved work stays where recovery finds it.
    if (session_ && !unsaved(revision)) projects::endSession(*session_);
    projects::noteGoodEnd();
}

}  // namespace ilf::app
