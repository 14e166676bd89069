// The viewer: rungs in order, refinement that gives way to newer work, and tiles that are not sent twice.
#include "app/studio/viewer.h"

#include <doctest/doctest.h>

#include <condition_variable>
#include <mutex>
#include <vector>

#include "app/studio/worker.h"
#include "core/base/srgb.h"
#include "core/document/edit.h"

using namespace ilf;
using namespace ilf::app;

namespace {

using namespace std::chrono_literals;

/// A shelf of 320 x 128 pixels: "page" in focus on the left half, "cup" blurred in the right upper corner.
Document shelf() {
    constexpr Size kSize{320, 128};
    std::vector<std::uint16_t> pixels(static_cast<std::size_t>(kSize.width) * kSize.height * 3);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = static_cast<std::uint16_t>((i * 2654435761U) >> 16U);
    Scene scene;
    scene.picture = Box<Picture>(Picture(kSize, 3, std::move(pixels)));
    Document document = newDocument(std::move(scene));
    document.wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    const auto region = [&](const char* id, Look look, Metre distance, Rectangle where) {
        Region added;
        added.id = added.name = id;
        added.look = look;
        added.distance = ConstantDistance{distance, {}};
        document = *edited(std::move(document), AddRegion{added, 0});
        document = *edited(std::move(document), FillShape{id, where});
    };
    region("page", Look::focus, 0.8_m, {{0, 0}, {160, 128}});
    region("cup", Look::blur, 0.5_m, {{250, 4}, {310, 50}});
    return document;
}

std::shared_ptr<const Compiled> compiledOf(const Document& document) {
    const auto planned = plan(planInput(document));
    REQUIRE(planned);
    auto compiled = compile(document, *planned);
    REQUIRE(compiled);
    return std::make_shared<const Compiled>(*std::move(compiled));
}

Document withDab(const Document& document) {
    return *edited(document, Paint{"cup", {Dab{{300, 54}, Brush{8.0, 1.0, 1.0}}}, PaintMode::add, false});
}

/// A viewer whose every answer is kept.
struct Watched {
    std::mutex mutex;
    std::condition_variable arrived;
    std::vector<Seen> all;
    std::function<void(const Seen&)> then;  ///< on the viewer's thread, before it goes on
    Viewer viewer;

    Watched()
        : viewer([this] {
              const std::scoped_lock lock(mutex);
              if (auto seen = viewer.tryTake()) {
                  all.push_back(*std::move(seen));
                  if (then) then(all.back());
              }
              arrived.notify_all();
          }) {}

    /// The answers up to the one that is settled for `serial`; the last of what came when none did in time.
    std::vector<Seen> until(std::uint64_t serial) {
        std::unique_lock lock(mutex);
        const bool came = arrived.wait_for(
            lock, 60s, [&] { return !all.empty() && all.back().serial == serial && all.back().settled; });
        CHECK(came);
        return all;
    }
    std::vector<Seen> dragged(std::uint64_t serial) {
        std::unique_lock lock(mutex);
        CHECK(arrived.wait_for(lock, 60s, [&] { return !all.empty() && all.back().serial == serial; }));
        return all;
    }
};

ViewJob leftEye(std::uint64_t serial, std::shared_ptr<const Compiled> compiled, bool dragging = false) {
    ViewJob job;
    job.serial = serial;
    job.compiled = std::move(compiled);
    job.dragging = dragging;
    job.eyes = {true, false};
    return job;
}

int boxesThatDiffer(const ScreenView& a, const ScreenView& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.tiles.size(); ++i)
        count += a.tiles[i].same(b.tiles[i]) ? 0 : 1;
    return count;
}

ViewRequest requestAt(Rung rung) {
    ViewRequest request;
    request.rung = rung;
    return request;
}

/// What a fresh engine shows.
ScreenView fresh(const Compiled& compiled, Rung rung) {
    return screenView(*ViewEngine(1).see(compiled.document, compiled.plan, compiled.program, requestAt(rung)));
}

int codesThatDiffer(const ScreenView& a, const ScreenView& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.tiles.size(); ++i)
        count += a.tiles[i] == b.tiles[i] ? 0 : 1;
    return count;
}

bool notCancelled() { return false; }

/// An eye that has seen the shelf refined.
struct RefinedEye {
    Document document = shelf();
    std::shared_ptr<const Compiled> still = compiledOf(document), dabbed = compiledOf(withDab(document));
    EyeView eye;
    std::shared_ptr<const ScreenView> refined;

    RefinedEye() {
        REQUIRE(eye.look(*still, requestAt(Rung::rest), notCancelled).value());
        REQUIRE(eye.look(*still, requestAt(Rung::idle), notCancelled).value());
        refined = eye.shown();
    }
    const ViewCounters& drag() {
        REQUIRE(eye.look(*dabbed, requestAt(Rung::dragging), notCancelled).value());
        return eye.counters();
    }
};

/// A dab lies in one tile, and neither blur nor magnification carries it over two.
constexpr int kTilesOfDab = 8;

}  // namespace

TEST_CASE("eye: the first frame of a gesture that was prepared works out what was edited, and shows one rung alone") {
    RefinedEye one;
    one.eye.prepareGesture(*one.still, requestAt(Rung::idle), notCancelled);
    CHECK(one.eye.shown() == one.refined);  // nothing is shown of what is made ready
    CHECK(one.eye.reached() == Rung::idle);
    const ViewCounters& counters = one.drag();
    CHECK(counters.computed > 0);
    CHECK(counters.computed <= kTilesOfDab);
    const ScreenView coarse = fresh(*one.dabbed, Rung::dragging);
    REQUIRE(codesThatDiffer(coarse, fresh(*one.dabbed, Rung::idle)) > 0);
    CHECK(codesThatDiffer(*one.eye.shown(), coarse) == 0);
    CHECK(boxesThatDiffer(*one.eye.shown(), *one.refined) == codesThatDiffer(coarse, *one.refined));
    // And back: the hand rests, and not a tile of the gesture stays.
    REQUIRE(one.eye.look(*one.dabbed, requestAt(Rung::idle), notCancelled).value());
    CHECK(codesThatDiffer(*one.eye.shown(), fresh(*one.dabbed, Rung::idle)) == 0);
}

TEST_CASE("eye: gestures go on where the last one ended, whatever was refined between them") {
    RefinedEye one;
    CHECK(one.drag().unchanged == 0);  // nothing was prepared
    REQUIRE(one.eye.look(*one.dabbed, requestAt(Rung::rest), notCancelled).value());
    REQUIRE(one.eye.look(*one.dabbed, requestAt(Rung::idle), notCancelled).value());
    const auto next = compiledOf(
        *edited(withDab(one.document), Paint{"cup", {Dab{{255, 54}, Brush{8.0, 1.0, 1.0}}}, PaintMode::add, false}));
    REQUIRE(one.eye.look(*next, requestAt(Rung::dragging), notCancelled).value());
    CHECK(one.eye.counters().computed > 0);
    CHECK(one.eye.counters().computed <= kTilesOfDab);
    CHECK(codesThatDiffer(*one.eye.shown(), fresh(*next, Rung::dragging)) == 0);
}

TEST_CASE("eye: a gesture that was prepared in part is seen whole") {
    for (const int asked : {0, 1}) {  // before anything, and when surfaces and light are there but no tile
        CAPTURE(asked);
        RefinedEye one;
        int asks = 0;
        one.eye.prepareGesture(*one.still, requestAt(Rung::idle), [&] { return asks++ >= asked; });
        CHECK(asks == asked + 1);
        CHECK(one.eye.shown() == one.refined);
        CHECK(one.drag().unchanged == 0);
        CHECK(codesThatDiffer(*one.eye.shown(), fresh(*one.dabbed, Rung::dragging)) == 0);
    }
}

TEST_CASE("viewer: once the view is refined the next gesture is made ready, unseen") {
    const Document before = shelf();
    const auto still = compiledOf(before), dabbed = compiledOf(withDab(before));
    ViewCounters counters;
    bool ready = false;
    // Nothing tells when it is ready, so the hand waits longer each time.
    for (auto wait = 50ms; !ready && wait < 10s; wait *= 2) {
        Watched watched;
        watched.viewer.post(leftEye(1, still));
        const std::size_t published = watched.until(1).size();
        std::this_thread::sleep_for(wait);
        watched.viewer.post(leftEye(2, dabbed, true));
        const std::vector<Seen> seen = watched.dragged(2);
        CHECK(seen.size() == published + 1);
        CHECK(seen.back().rung == Rung::dragging);
        counters = seen.back().counters[0];
        ready = counters.unchanged > 0;
    }
    CHECK(counters.computed > 0);
    CHECK(counters.computed <= kTilesOfDab);
}

TEST_CASE("viewer: new work comes before making a gesture ready") {
    const Document before = shelf();
    const auto still = compiledOf(before), dabbed = compiledOf(withDab(before));
    Watched watched;
    watched.then = [&](const Seen& seen) {
        if (seen.serial == 1 && seen.settled) watched.viewer.post(leftEye(2, dabbed, true));
    };
    watched.viewer.post(leftEye(1, still));
    const Seen first = watched.dragged(2).back();
    CHECK(first.rung == Rung::dragging);
    CHECK(first.counters[0].unchanged == 0);  // of what would have been made ready not one tile was
}

TEST_CASE("viewer: a still scene is seen at rest, then refined, and nothing else is worked out") {
    Watched watched;
    watched.viewer.post(leftEye(1, compiledOf(shelf())));
    const std::vector<Seen> seen = watched.until(1);
    REQUIRE(seen.size() >= 2);
    CHECK(seen.front().rung == Rung::rest);
    CHECK(seen.back().rung == Rung::idle);
    for (std::size_t i = 1; i < seen.size(); ++i)
        CHECK(seen[i - 1].rung <= seen[i].rung);
    REQUIRE(seen.back().perceived[0]);
    CHECK_FALSE(seen.back().perceived[1]);
    CHECK(seen.back().plain.empty());
    CHECK(seen.back().seams);
    CHECK(seen.back().report);
}

TEST_CASE("viewer: while dragging the view stays coarse, and the hand's rest refines it") {
    Watched watched;
    const auto compiled = compiledOf(shelf());
    watched.viewer.post(leftEye(1, compiled, true));
    const std::vector<Seen> dragged = watched.dragged(1);
    CHECK(dragged.back().rung == Rung::dragging);
    CHECK_FALSE(dragged.back().settled);
    CHECK_FALSE(dragged.back().seams);
    watched.viewer.post(leftEye(2, compiled));
    const std::vector<Seen> seen = watched.until(2);
    std::vector<Rung> rungs;
    for (const Seen& one : seen)
        if (rungs.empty() || rungs.back() != one.rung) rungs.push_back(one.rung);
    CHECK(rungs == std::vector{Rung::dragging, Rung::rest, Rung::idle});
    // A gesture that begins and changes nothing does not make the view coarse again.
    watched.viewer.post(leftEye(3, compiled, true));
    CHECK(watched.dragged(3).back().rung == Rung::idle);
}

TEST_CASE("viewer: an edit ends the refinement of what it replaces") {
    Watched watched;
    const Document before = shelf();
    const auto first = compiledOf(before), second = compiledOf(withDab(before));
    watched.viewer.post(leftEye(1, first));
    watched.viewer.post(leftEye(2, second));  // may come before, amid or after the first look at rest
    const std::vector<Seen> seen = watched.until(2);
    for (const Seen& one : seen)
        CHECK_FALSE((one.serial == 1 && one.settled));
    CHECK(seen.back().rung == Rung::idle);
}

TEST_CASE("viewer: tiles that an edit cannot reach keep their boxes, and counters say how many were worked out") {
    Watched watched;
    const Document before = shelf();
    watched.viewer.post(leftEye(1, compiledOf(before), true));
    const auto first = watched.dragged(1).back().perceived[0];
    watched.viewer.post(leftEye(2, compiledOf(withDab(before)), true));
    const Seen second = watched.dragged(2).back();
    REQUIRE(first);
    REQUIRE(second.perceived[0]);
    const ViewCounters& counters = second.counters[0];
    CHECK(counters.tiles == 5 * 4);
    CHECK(counters.computed > 0);
    CHECK(counters.computed + counters.unchanged + counters.plain + counters.dark >= counters.tiles);
    const int sent = boxesThatDiffer(*first, *second.perceived[0]);
    CHECK(sent > 0);
    CHECK(sent <= kTilesOfDab);
}

TEST_CASE("viewer: what was looked at may go, and the view goes on") {
    Watched watched;
    ViewJob job = leftEye(1, compiledOf(shelf()), true);
    job.seeing.attending = "a region that was deleted";
    job.seeing.chromatic = true;  // of a rig that states no primaries
    watched.viewer.post(job);
    const Seen seen = watched.dragged(1).back();
    CHECK_FALSE(seen.refusal);
    CHECK(seen.perceived[0]);
}

TEST_CASE("viewer: a viewer ends while it refines") {
    const auto compiled = compiledOf(shelf());
    for (int i = 0; i < 3; ++i) {
        Viewer viewer;
        viewer.post(leftEye(1, compiled));
    }
    CHECK(compiled.use_count() == 1);
}

TEST_CASE("viewer: screen tiles hold the codes of a whole picture") {
    const auto compiled = compiledOf(shelf());
    ViewRequest request;
    const auto view = ViewEngine(1).see(compiled->document, compiled->plan, compiled->program, request);
    REQUIRE(view);
    const ScreenView screen = screenView(*view);
    const Image<std::uint8_t> whole = toSrgb8(view->radiance());
    int wrong = 0;
    for (int y = 0; y < whole.height(); ++y) {
        for (int x = 0; x < whole.width(); ++x) {
            const auto& tile =
                *screen.tiles[static_cast<std::size_t>(y / ViewTile::kHeight * screen.columns + x / ViewTile::kWidth)];
            const auto at =
                static_cast<std::size_t>(4 * (y % ViewTile::kHeight * ViewTile::kWidth + x % ViewTile::kWidth));
            for (int c = 0; c < 3; ++c)
                wrong += tile[at + static_cast<std::size_t>(c)] != whole.at(x, y, c) ? 1 : 0;
            wrong += tile[at + 3] != 255 ? 1 : 0;
        }
    }
    CHECK(wrong == 0);
    // The same view again, worked out anew: not one tile need be sent.
    const auto again = ViewEngine(1).see(compiled->document, compiled->plan, compiled->program, request);
    CHECK(boxesThatDiffer(screen, screenView(*again, *view, screen)) == 0);
}

TEST_CASE("worker: the program comes before what is seen of it") {
    std::mutex mutex;
    std::condition_variable arrived;
    bool programFirst = false, seen = false;
    Worker* self = nullptr;
    Worker worker(devices::kUsualLens, [&] {
        const std::scoped_lock lock(mutex);
        if (self == nullptr) return;
        const auto done = self->tryTake();
        if (done && done->compiled && !seen) programFirst = done->hash == contentHash(done->compiled->program);
        seen = seen || self->tryTakeSeen().has_value();
        arrived.notify_all();
    });
    {
        const std::scoped_lock lock(mutex);
        self = &worker;
    }
    Job job;
    job.serial = 1;
    job.document = shelf();
    job.dragging = true;
    job.eyes = {true, true};
    worker.post(std::move(job));
    std::unique_lock lock(mutex);
    REQUIRE(arrived.wait_for(lock, 60s, [&] { return seen; }));
    CHECK(programFirst);
}
