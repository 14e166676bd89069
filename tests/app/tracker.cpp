// The tracker's thread: pictures and poses in, moves out; and the program that is compiled of regions that move.
#include "app/studio/tracker.h"

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>

#include "app/studio/following_compiler.h"
#include "core/document/shape.h"
#include "core/track/predict.h"
#include "devices/camera/camera.h"
#include "tests/core/document/scenes.h"
#include "tests/core/track/drawn_marker.h"

using namespace ilf;
using namespace ilf::app;

namespace {

constexpr Size kSize{320, 200};

Quad squareAt(double x, double y) { return {{{x, y}, {x + 60, y}, {x + 60, y + 60}, {x, y + 60}}}; }

Image<std::uint8_t> rgbWith(const Quad& marker) {
    DrawnScene scene;
    scene.size = kSize;
    const auto grey = drawnMarker(scene, cv::aruco::DICT_APRILTAG_36h11, 7, marker);
    std::vector<std::uint8_t> rgb;
    for (const std::uint8_t v : grey.pixels())
        rgb.insert(rgb.end(), 3, v);
    return {kSize, 3, std::move(rgb)};
}

/// "Face" follows `target` over a picture in which a marker lies at (100, 60).
Document following(const Follow& follow) {
    Document document = twoRegions();
    document.scene.picture = Box(devices::asPicture({rgbWith(squareAt(100, 60)), 0.0_s, 1, 0.0}));
    Region face = *findRegion(document, "a");
    face.mask = rasterised(Rectangle{{90, 50}, {170, 130}}, kSize);
    face.follow = follow;
    document.regions[0] = Box(face);
    return document;
}

Follow byMarker() { return {MarkerTarget{"APRILTAG_36h11", 7}}; }

/// Real time passes: pictures come until the tracker says what is waited for.
std::optional<TrackNews> awaited(Tracker& tracker, const std::function<void()>& feed,
                                 const std::function<bool(const TrackNews&)>& wanted) {
    std::optional<TrackNews> newest;
    for (int i = 0; i < 600; ++i) {
        feed();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (auto news = tracker.tryTake()) newest = std::move(news);
        if (newest && wanted(*newest)) return newest;
    }
    return std::nullopt;
}

/// "/pose/1 x y" as OSC 1.0 writes it.
void sendPose(int port, float x, float y) {
    std::array<std::uint8_t, 20> bytes{'/', 'p', 'o', 's', 'e', '/', '1', 0, ',', 'f', 'f', 0};
    for (const auto& [value, at] : {std::pair{x, 12}, {y, 16}}) {
        std::uint32_t word = 0;
        std::memcpy(&word, &value, 4);
        word = htonl(word);
        std::memcpy(bytes.data() + at, &word, 4);
    }
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    static_cast<void>(
        ::sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to));
    ::close(socket);
}

Point<CameraFrame> movedMiddle(const TrackNews& news) {
    return motionAt(news.moves.at(0), 0.0_s).motion(middleOf(news.moves.at(0).from));
}

}  // namespace

TEST_CASE("the tracker follows a marker in the pictures it is handed, and forgets it when the camera is closed") {
    std::atomic<int> woken = 0;
    Tracker tracker([&] { ++woken; });
    const Document document = following(byMarker());
    tracker.follow(document, true);
    std::uint64_t number = 0;
    const auto feed = [&] { tracker.see({rgbWith(squareAt(130, 70)), devices::steadyNow(), ++number, 0.0}); };
    const auto found = awaited(tracker, feed, [](const TrackNews& news) {
        return !news.regions.empty() && news.regions[0].state == FollowState::following;
    });
    REQUIRE(found);
    CHECK(woken > 0);
    CHECK(movedMiddle(*found).x == doctest::Approx(160).epsilon(0.005));
    CHECK(movedMiddle(*found).y == doctest::Approx(100).epsilon(0.005));
    // No picture any more: patience runs by itself, the thread wakes for it.
    const auto lost = awaited(
        tracker, [] {},
        [](const TrackNews& news) { return news.regions[0].state == FollowState::lost && news.moves[0].fade == 1.0; });
    REQUIRE(lost);
    CHECK(lost->serial > found->serial);
    tracker.follow(document, false);
    CHECK(awaited(tracker, feed, [](const TrackNews& news) { return news.moves.empty(); }));
}

TEST_CASE("where no region follows anything the tracker says nothing, whatever it is shown") {
    std::atomic<int> woken = 0;
    Tracker tracker([&] { ++woken; });
    tracker.follow(twoRegions(), true);
    for (int i = 0; i < 10; ++i) {
        tracker.see({rgbWith(squareAt(100, 60)), devices::steadyNow(), 1, 0.0});
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    CHECK_FALSE(tracker.tryTake());
    CHECK(woken == 0);
}

TEST_CASE("poses by OSC move a region; a port that is taken is refused") {
    Tracker tracker({});
    REQUIRE(tracker.listen(0));
    CHECK(tracker.oscPort() > 0);
    Tracker other({});
    CHECK(other.listen(tracker.oscPort()).error().what.find(std::to_string(tracker.oscPort())) != std::string::npos);
    tracker.follow(following({StreamTarget{"/pose/1"}}), false);
    const auto news = awaited(
        tracker, [&] { sendPose(tracker.oscPort(), 0.5F, 0.75F); },
        [](const TrackNews& n) { return !n.regions.empty() && n.regions[0].state == FollowState::following; });
    REQUIRE(news);
    CHECK(movedMiddle(*news).x == doctest::Approx(160));
    CHECK(movedMiddle(*news).y == doctest::Approx(150));
}

TEST_CASE("markers are looked for when asked, in the scene's picture and in the live one") {
    Tracker tracker({});
    tracker.lookForMarkers(following(byMarker()).scene.picture, rgbWith(squareAt(20, 20)));
    std::optional<std::vector<ui::MarkerFound>> found;
    for (int i = 0; i < 600 && !found; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        found = tracker.tryTakeFound();
    }
    REQUIRE(found);
    REQUIRE(found->size() == 1);
    CHECK(found->front().dictionary == "APRILTAG_36h11");
    CHECK(found->front().id == 7);
    CHECK(found->front().inScene);
    CHECK(found->front().middle.x == doctest::Approx(130).epsilon(0.005));
}

TEST_CASE(
    "each image of a moving program is of the scene at the time of its own slots; what stands still costs nothing") {
    Document painted = following(byMarker());
    Region hands = *findRegion(painted, "b");
    hands.mask = rasterised(Rectangle{{200, 40}, {280, 120}}, kSize);
    painted.regions[1] = Box(hands);
    const auto planned = plan(planInput(painted));
    REQUIRE(planned);
    RegionMove move{"a", squareAt(100, 60), squareAt(110, 64), {}, 0.0};
    FollowingCompiler compiler;
    const auto compiled = [&] {
        const std::vector<RegionMove> moves{move};
        const Document placed = compiler.placed(painted, moves, meanLight(*planned));
        auto result = compiler.compiled(painted, placed, *planned, moves);
        REQUIRE(result);
        return *result;
    };
    const auto still = compiled();
    CHECK(compiled() == still);      // the same object
    move.speed.fill({3000.0, 0.0});  // 3 px a millisecond
    const auto moving = compiled();
    CHECK(compiled() == moving);
    const auto times = lightOfImages(*planned, moving->program);
    int images = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!times[i]) continue;
        ++images;
        const auto alone = compile(moved(painted, std::vector<RegionMotion>{motionAt(move, *times[i])}), *planned);
        REQUIRE(alone);
        CHECK(moving->program.images[i] == alone->program.images[i]);
        CHECK_FALSE(moving->program.images[i] == still->program.images[i]);
    }
    CHECK(images >= 2);
    move.speed = {};
    CHECK(compiled()->program == still->program);
}
