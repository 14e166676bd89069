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
    Viewer viewer;

    Watched()
        : viewer([this] {
              const std::scoped_lock lock(mutex);
              if (auto seen = viewer.tryTake()) all.push_back(*std::move(seen));
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

}  // namespace

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
    CHECK(sent <= 8);  // the dab lies in one tile, and neither blur nor magnification carries it over two
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
