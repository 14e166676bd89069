#include "app/studio/studio.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "app/exit_code.h"
#include "app/output_core/log.h"
#include "app/rigs.h"
#include "app/studio/core_view.h"
#include "devices/link/runtime_directory.h"
#include "projects/pictures.h"

namespace ilf::app {
namespace {

constexpr Size kDefaultWindow{1440, 900};
/// How long the loop sleeps when nothing happens: long enough to leave the machine alone, short enough for clocks on
/// screen ("saved 12 s ago", frame ages).
constexpr double kIdleWait_s = 0.1;
/// Frames drawn after the last event, so that ImGui's hover and fade states settle.
constexpr int kSettlingFrames = 3;
/// A screenshot does not wait longer than this for the core.
constexpr double kScreenshotPatience_s = 15.0;
/// Sending a whole view to the GPU may take longer than a frame has; the rest follows in the next ones.
constexpr std::chrono::microseconds kUploadBudget{1500};
/// A view computed while dragging is refined once nothing has changed for this long.
constexpr double kRestAfter_s = 0.08;

Size windowSize(const std::string& text) {
    Size size = kDefaultWindow;
    const auto cross = text.find('x');
    if (cross == std::string::npos) return size;
    std::from_chars(text.data(), text.data() + cross, size.width);
    std::from_chars(text.data() + cross + 1, text.data() + text.size(), size.height);
    return {std::clamp(size.width, 640, 16384), std::clamp(size.height, 400, 16384)};
}

/// As far as a core tells: one real rig is not told from another.
bool playsOn(const devices::Status& core, const RigChoice& choice) {
    if (choice.rig.empty()) return true;
    if (isEmulatedRig(choice.rig)) return core.emulated;
    const auto rig = rigFrom(choice.rig);
    return rig && rig->devices ? !core.simulated : core.simulated && !core.emulated;
}

ui::ViewMode startMode(const std::string& view) {
    if (view == "perceived") return ui::ViewMode::perceived;
    if (view == "light") return ui::ViewMode::light;
    if (view == "compare") return ui::ViewMode::compare;
    return ui::ViewMode::scene;
}

/// What an operator wants to find in the log afterwards.
void logChange(const devices::Status& before, const devices::Status& now) {
    if (now.connected != before.connected) {
        if (!now.connected) {
            spdlog::warn("output core: connection lost; what plays goes on");
        } else if (now.light == devices::LightMode::slotted) {
            spdlog::info("output core: connected; revision {} plays already", now.revisionPlayed);
        } else {
            spdlog::info("output core: connected; safe light");
        }
    }
    if (now.faults != before.faults && !now.fault.empty()) spdlog::error("output core: {}", now.fault);
    if (now.swaps != before.swaps) spdlog::info("output core: plays revision {}", now.revisionPlayed);
}

}  // namespace

Result<std::unique_ptr<Studio>> Studio::start(const StudioOptions& options) {
    OpenedFile opened = blankProject();
    std::string trouble;
    std::error_code ignored;
    if (!options.file.empty() && !std::filesystem::exists(options.file, ignored)) {
        return fail(Fault::notFound, "There is no file and no command \"" + options.file +
                                         "\": name a project, picture or video, or see --help.");
    }
    if (!options.file.empty()) {
        if (auto file = openAny(options.file)) {
            opened = *std::move(file);
        } else {
            trouble = file.error().what;  // said in the window: the studio opens all the same
        }
    }
    const auto arguments = coreArguments(options.rig);
    if (!arguments) return tl::unexpected(arguments.error());
    if (const auto rig = withOptions(Rig(), options.rig); !rig) return tl::unexpected(rig.error());
    auto window = Window::open("IlluminatedFocus Studio", windowSize(options.size), options.scale);
    if (!window) return tl::unexpected(window.error());
    auto studio = std::unique_ptr<Studio>(new Studio(options, *arguments, *std::move(window), std::move(opened)));
    if (!trouble.empty()) studio->say(trouble, ui::Tone::error);
    if (options.oscPort) {
        const auto listens = studio->tracker_.listen(*options.oscPort);
        if (!listens) studio->say(listens.error().what, ui::Tone::error);
    }
    return studio;
}

Studio::Studio(StudioOptions options, std::vector<std::string> coreArguments, std::unique_ptr<Window> window,
               OpenedFile opened)
    : options_(std::move(options)), window_(std::move(window)), editor_(opened.document), keeper_(&Window::wake),
      camera_(&Window::wake), selector_(&Window::wake), measurer_(devices::runtimeDirectory(), &Window::wake),
      registrar_(devices::runtimeDirectory(), &Window::wake), times_(!options_.frameTimes.empty()),
      changedAt_(Clock::now()), worker_(*simulatedLens(options_.rig), &Window::wake), tracker_(&Window::wake),
      bumpWatch_(&Window::wake),
      link_(options_.coreProgram, std::move(coreArguments), devices::runtimeDirectory(), &Window::wake) {
    if (!options_.resetLayout) ui_ = ui::withLayout(ui_, keeper_.layoutText());
    ui_.mode = startMode(options_.view);
    ui_.recovery = options_.screenshot.empty() ? keeper_.recoveryQuestion() : std::nullopt;
    const bool plays = !opened.projectPath.empty() && !ui_.recovery && !keeper_.crashedLately();
    show(std::move(opened));
    playAtStart_ = plays;
}

Studio::~Studio() {
    keepFrameTimes();
    keeper_.closed(ui::layoutText(ui_), editor_.document());
}

int Studio::run() {
    while (true) {
        const bool busy = quietFrames_ < kSettlingFrames || editor_.previewing() || camera_.streaming();
        times_.begin(!busy);
        window_->waitEvents(busy ? 0.0 : kIdleWait_s);
        frame();
        if ((window_->shouldClose() || closing_) && mayClose()) return kDone;
        if (!options_.screenshot.empty() && worthAPicture()) {
            window_->captureNext();
            times_.begin(false);
            frame();
            const auto written = projects::writePng(options_.screenshot, window_->captured());
            if (!written) std::cerr << "illuminatedfocus: " << written.error().what << '\n';
            return written ? kDone : kFailed;
        }
    }
}

bool Studio::worthAPicture() const {
    const bool shown = (seen_.settled || done_.refusal) && done_.serial == editor_.serial() &&
                       (done_.refusal || seen_.serial == done_.serial) && quietFrames_ >= kSettlingFrames;
    const bool plays = !playAtStart_ && !takeSerial_ && core_.connected && core_.revisionPlayed == revision_;
    return shown && now_s() > 1.0 && (plays || now_s() > kScreenshotPatience_s);
}

bool Studio::mayClose() {
    closing_ = false;
    keeper_.finish();  // a save under way tells whether anything is left unsaved
    (void)keeper_.takeSentences();
    // Nothing is lost by closing: unsaved work is autosaved and offered again at the next start.
    if (keeper_.unsaved(editor_.document())) keeper_.autosaveNow(editor_.document());
    return true;
}

void Studio::frame() {
    collect();
    ui::Input input = window_->takeInput();
    input.dropped = window_->takeDroppedFiles();
    const bool eventful = input.trail.size() > 1 || !input.pressed.empty() || !input.released.empty();
    times_.lap(FrameStage::input);

    showTitle();
    placeShown();
    pictures_.show(shown_ ? *shown_ : editor_.document(), ui_.selected);
    times_.lap(FrameStage::marks);
    const bool partly = pictures_.show(seen_, kUploadBudget);
    if (ui::wants(ui_).lights) pictures_.showLights(done_);
    if (registrar_.view()) pictures_.showRegistering(registrar_.view()->picture);
    times_.lap(FrameStage::views);
    window_->beginFrame();
    const ui::Requests requests = ui::studio(view(), ui_, input);
    times_.lap(FrameStage::build);
    handle(requests);
    sendIfDue();
    postJob();
    keeper_.autosaveIfDue(editor_.document(), editor_.history().revision(), now_s());
    times_.lap(FrameStage::edit);
    window_->draw();
    times_.lap(FrameStage::draw);
    window_->swap();
    times_.lap(FrameStage::swap);
    times_.end(ui::wants(ui_).gesture);
    quietFrames_ = eventful || partly || !requests.empty() ? 0 : std::min(quietFrames_ + 1, 1000);
}

void Studio::keepFrameTimes() const {
    if (options_.frameTimes.empty()) return;
    std::ofstream out(options_.frameTimes);
    out << times_.json({{"views while dragging", viewsTaken_[0]},
                        {"views at rest", viewsTaken_[1]},
                        {"views refined", viewsTaken_[2]},
                        {"view tiles sent", pictures_.tilesSent()}});
    if (!out) spdlog::error("The frame times could not be written to {}.", options_.frameTimes);
}

void Studio::collect() {
    if (auto done = worker_.tryTake()) takeDone(*std::move(done));
    if (auto seen = worker_.tryTakeSeen()) takeSeen(*std::move(seen));
    if (auto news = link_.tryTake()) takeNews(*std::move(news));
    if (measurer_.collect()) quietFrames_ = 0;
    lendDevices();
    tendRegistering();
    takeBump();
    if (camera_.collect()) takeFrame();
    followRegions();
    for (const std::string& sentence : camera_.takeSentences())
        say(sentence, ui::Tone::warning);
    for (const auto& [sentence, well] : keeper_.takeSentences())
        say(sentence, well ? ui::Tone::note : ui::Tone::error);
    if (auto found = selector_.tryTake()) {
        const Region* region = findRegion(editor_.document(), found->region);
        if (!found->mask) {
            say(found->mask.error().what, ui::Tone::warning);
        } else if (region != nullptr) {
            edit(SetMask{found->region, united(region->mask, *found->mask), "Select object"});
        }
    }
}

void Studio::takeDone(Done done) {
    done_ = std::move(done);
    quietFrames_ = 0;
}

void Studio::takeSeen(Seen seen) {
    // Views that this answer does not bring stay on screen until newer ones come.
    for (std::size_t eye = 0; eye < 2; ++eye) {
        if (!seen.perceived[eye]) continue;
        if (seen.perceived[eye] != seen_.perceived[eye]) ++viewsTaken_[static_cast<std::size_t>(seen.rung)];
    }
    seen_ = std::move(seen);
    quietFrames_ = 0;
}

void Studio::takeNews(LinkNews news) {
    if (news.lent) measurer_.devicesAreFree(*news.lent);
    if (news.status.swapped_ns != 0) {
        latency_.played(news.status.revisionPlayed, news.status.swapped_ns);
        lightLag_.played(news.status.revisionPlayed, news.status.swapped_ns);
    }
    if (news.status.light != core_.light || news.status.faults != core_.faults ||
        news.status.connected != core_.connected || news.status.revisionPlayed != core_.revisionPlayed) {
        quietFrames_ = 0;
    }
    logChange(core_, news.status);
    const bool another = core_.pid != 0 && news.status.pid != 0 && news.status.pid != core_.pid;
    if (another) {
        faultsSeen_ = 0;  // the new one counts its own
        say("The output core ended and was started again: the light is steady, the lens rests. TAKE plays again.",
            ui::Tone::error);
    }
    if (takeSerial_ && (another || news.status.hold != core_.hold || !news.status.connected)) {
        forgetTake();
        say("Nothing was put on show: the light changed before the program was ready. Press TAKE again.",
            ui::Tone::warning);
    }
    const bool found = news.status.connected && (!core_.connected || another);
    core_ = std::move(news.status);
    if (found && !playsOn(core_, options_.rig)) {
        playAtStart_ = false;
        say("The output core that runs already does not play on " + inWords(options_.rig) +
                ": choose the rig in Rig, which starts it anew, or stop it with illuminatedfocus-core --stop.",
            ui::Tone::error);
    }
    if (playAtStart_ && core_.connected) {
        playAtStart_ = false;
        // A project opens playing on a simulated core that has never played. What plays already is left alone (a
        // restarted studio shows it), and so is safe light after a fault or after the operator asked for it.
        if (core_.simulated && core_.swaps == 0 && core_.faults == 0 && core_.fault.empty()) take();
    }
    if (news.trouble != linkTrouble_ && !news.trouble.empty()) say(news.trouble, ui::Tone::error);
    linkTrouble_ = std::move(news.trouble);
}

void Studio::takeFrame() {
    if (registrar_.view()) return registrar_.livePicture(camera_.frame().rgb);
    if (camera_.live()) {
        liveFrame_ = camera_.frame().rgb;
        pictures_.showLive(liveFrame_);
        tracker_.see(camera_.frame());
    }
    lookForBump();
}

void Studio::postJob() {
    const ui::Wants wants = ui::wants(ui_);
    const bool moved = postedMoves_ != tracked_.serial;
    if (seenSerial_ != editor_.serial() || moved) {
        seenSerial_ = editor_.serial();
        changedAt_ = Clock::now();
    }
    const double restedFor = std::chrono::duration<double>(Clock::now() - changedAt_).count();
    const bool dragging = (editor_.previewing() || wants.gesture || moved) && restedFor < kRestAfter_s;
    const bool sameViews = wants.perceivedLeft == posted_.perceivedLeft && wants.plain == posted_.plain &&
                           wants.perceivedRight == posted_.perceivedRight && wants.cursor == posted_.cursor &&
                           wants.seeing == posted_.seeing;
    if (postedSerial_ == editor_.serial() && sameViews && dragging == postedDragging_ && !moved) return;
    Job job;
    job.serial = postedSerial_ = editor_.serial();
    job.document = editor_.document();
    job.moves = tracked_.moves;
    postedMoves_ = tracked_.serial;
    if (followsBehind()) job.onShow = onShow_;
    if (moved) job.seen_ns = std::llround(1e9 * tracked_.arrived.si());
    job.dragging = postedDragging_ = dragging;
    job.eyes = {wants.perceivedLeft, wants.perceivedRight};
    job.plain = wants.plain;
    job.seeing = wants.seeing;
    job.cursor = wants.cursor;
    job.strokeAt = changedAt_;
    posted_ = wants;
    worker_.post(std::move(job));
}

void Studio::take() {
    if (measurer_.busy()) {
        liveTake_ = false;
        return say("A rig is being measured: store or cancel that, then press TAKE.", ui::Tone::warning);
    }
    if (registrar_.shows()) {
        liveTake_ = false;
        return say("The projector shows patterns for the registration: cancel that, then press TAKE.",
                   ui::Tone::warning);
    }
    if (!core_.connected) {
        liveTake_ = false;
        return say("The output core is not connected, so nothing can be put on show; press TAKE when it is back.",
                   ui::Tone::warning);
    }
    if (keeper_.unsaved(editor_.document())) keeper_.autosaveNow(editor_.document());
    takeSerial_ = editor_.serial();
    takeHold_ = core_.hold;
    takeAt_ = Clock::now();
    takenRevision_ = editor_.history().revision();
}

void Studio::forgetTake() {
    takeSerial_.reset();
    playAtStart_ = false;
    liveTake_ = false;
    ownShow_ = false;
}

void Studio::sendIfDue() {
    sendBehind();
    if (!done_.compiled) {
        if (takeSerial_ && done_.refusal && done_.serial >= *takeSerial_) {
            say("Nothing was put on show: " + done_.refusal->what, ui::Tone::error);
            takeSerial_.reset();
        }
        return;
    }
    const bool taking = takeSerial_ && done_.serial >= *takeSerial_;
    const bool live = (liveTake_ || followsOnShow()) && done_.compiled != sent_ && done_.hash != sentHash_;
    if (!taking && !live) return;
    if (taking) takeSerial_.reset();
    if (live) takenRevision_ = editor_.history().revision();
    ownShow_ = true;
    onShow_ = done_.painted;
    sent_ = done_.compiled;
    sentHash_ = done_.hash;
    ++revision_;
    // From the stroke, or from TAKE when that came later.
    const auto asked = taking ? std::max(done_.strokeAt, takeAt_) : done_.strokeAt;
    if (done_.serial != sentSerial_ || taking) {
        latency_.sent(revision_,
                      std::chrono::duration_cast<std::chrono::nanoseconds>(asked.time_since_epoch()).count());
    }
    sentSerial_ = done_.serial;
    if (done_.seen_ns && !taking) lightLag_.sent(revision_, *done_.seen_ns);
    link_.send({sent_, revision_, taking ? devices::Why::take : devices::Why::live, takeHold_});
}

ui::View Studio::view() const {
    const History& history = editor_.history();
    ui::View view{.document = editor_.document()};
    view.previewing = editor_.previewing();
    view.undoLabel = history.undoLabel();
    view.redoLabel = history.redoLabel();
    view.historyPosition = history.position();
    for (std::size_t i = 0; i < history.steps(); ++i)
        view.historyLabels.push_back(history.labelAt(i));
    pictures_.fill(view);

    ui::Computed& computed = view.computed;
    computed.forCurrent = done_.serial == editor_.serial();
    if (done_.compiled) {
        computed.plan = done_.compiled->plan;
        computed.compiled = done_.compiled.get();
        computed.counters = done_.compiled->counters;
    }
    if (done_.refusal) computed.planError = done_.refusal->what;
    if (!done_.refusal && seen_.refusal) computed.planError = seen_.refusal->what;
    computed.seam = seen_.seam;
    computed.seams = seen_.seams;
    computed.report = seen_.report;
    computed.plan_ms = done_.plan_ms;
    computed.compile_ms = done_.compile_ms;
    computed.view_ms = seen_.view_ms;
    const auto eye = static_cast<std::size_t>(ui_.eye == Eye::left ? 0 : 1);
    if (seen_.perceived[eye]) {
        computed.viewRung = word(seen_.rung);
        computed.viewScale = seen_.scale;
        computed.viewCounters = seen_.counters[eye];
    }
    computed.frameOwn_ms = times_.last().ownCpu_ms();
    computed.frameSwap_ms = times_.last().wall_ms[static_cast<std::size_t>(FrameStage::swap)];

    view.core = coreView(core_, linkTrouble_, revision_, faultsSeen_, latency_);
    view.camera = camera_.status();
    view.liveTake = liveTake_;
    view.editsSinceTake = editsSinceTake();
    view.fileName = keeper_.projectPath();
    view.unsaved = keeper_.unsaved(editor_.document());
    view.savedAgo_s = keeper_.savedAgo_s();
    view.recent = keeper_.recent();
    view.cameras = camera_.ids();
    view.busySelecting = selector_.busy();
    view.measuring = measurer_.view();
    view.registering = registrar_.view();
    view.follow = followView();
    if (bump_) view.bump = ui::BumpView{bump_->moved_px};
    view.time_s = now_s();
    view.scale = window_->contentScale();
    return view;
}

int Studio::editsSinceTake() const {
    const auto& history = editor_.history();
    if (followsOnShow()) return 0;
    if (core_.light == devices::LightMode::slotted && done_.compiled && done_.serial == editor_.serial() &&
        done_.hash == core_.contentHashPlayed) {
        return 0;  // the same light, however it came about
    }
    return std::max(1, static_cast<int>(history.revision() - takenRevision_));
}

void Studio::say(const std::string& sentence, ui::Tone tone) {
    ui::say(ui_, sentence, tone, now_s());
    quietFrames_ = 0;
}

void Studio::showTitle() {
    std::string title = editor_.document().name + " - IlluminatedFocus Studio";
    if (title == title_) return;
    title_ = std::move(title);
    window_->setTitle(title_);
}

double Studio::now_s() const { return std::chrono::duration<double>(Clock::now() - startedAt_).count(); }

int runStudio(const StudioOptions& options) {
    startLog("studio");
    auto studio = Studio::start(options);
    if (!studio) {
        std::cerr << "illuminatedfocus: " << studio.error().what << '\n';
        return studio.error().fault == Fault::notFound ? kUsage : exitCode(studio.error());
    }
    return (*studio)->run();
}

}  // namespace ilf::app
