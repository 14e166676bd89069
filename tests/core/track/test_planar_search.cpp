// A search for a flat thing that is shared out over pictures finds it, whenever it comes into sight.
#include <doctest/doctest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/document/shape.h"
#include "core/track/planar.h"
#include "core/track/region_tracker.h"
#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr Size kDesk{1280, 720};
constexpr PixelRect<CameraFrame> kPage{40, 30, 340, 230};

/// A printed page: blots on paper.
const cv::Mat& printedPage() {
    static const cv::Mat drawn = [] {
        cv::Mat page(260, 380, CV_8UC1, cv::Scalar(215));
        cv::RNG blots(3);
        for (int k = 0; k < 200; ++k)
            cv::rectangle(
                page,
                cv::Rect(blots.uniform(0, 370), blots.uniform(0, 250), blots.uniform(3, 26), blots.uniform(3, 14)),
                cv::Scalar(blots.uniform(20, 200)), cv::FILLED);
        cv::GaussianBlur(page, page, {3, 3}, 0.7);
        return page;
    }();
    return drawn;
}

/// The page, moved from where it was learnt, before a desk of things; without it, the desk.
Image<std::uint8_t> deskWith(const Motion* motion, unsigned seed) {
    cv::Mat frame(kDesk.height, kDesk.width, CV_8UC1, cv::Scalar(120));
    cv::RNG desk(17);
    for (int k = 0; k < 120; ++k)
        cv::rectangle(frame,
                      cv::Rect(desk.uniform(0, 1200), desk.uniform(0, 680), desk.uniform(8, 120), desk.uniform(8, 90)),
                      cv::Scalar(desk.uniform(30, 220)), k % 3 == 0 ? 2 : cv::FILLED);
    if (motion != nullptr) {
        const cv::Matx33d half(1, 0, 0.5, 0, 1, 0.5, 0, 0, 1);
        const cv::Matx33d drawn = half.inv() * cv::Matx33d(motion->m.data()) * half;
        cv::warpPerspective(printedPage(), frame, drawn, frame.size(), cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
    }
    cv::Mat noise(frame.size(), CV_16S);
    cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, 2);
    frame.convertTo(frame, CV_16S);
    frame += noise;
    frame.convertTo(frame, CV_8U);
    return {kDesk, 1, std::vector<std::uint8_t>(frame.datastart, frame.dataend)};
}

Box<PlanarPattern> learntPage() {
    const Motion still;
    return planarPattern(deskWith(&still, 1), kPage).value();
}

Motion shifted(double x, double y) { return {{1, 0, x, 0, 1, y, 0, 0, 1}}; }

/// How many pictures, `apart` from one another, it takes to follow a page again that was covered and lies elsewhere.
int picturesUntilFollowed(Second apart) {
    const Motion still, elsewhere = shifted(610, 320);
    const auto before = deskWith(&still, 1);
    std::vector<std::uint16_t> rgb;
    for (const std::uint8_t v : before.pixels())
        rgb.insert(rgb.end(), 3, static_cast<std::uint16_t>(257 * v));
    Document document;
    document.scene.picture = Box(Picture(kDesk, 3, std::move(rgb)));
    Region region;
    region.id = "page";
    region.mask = rasterised(Rectangle{{60, 50}, {320, 210}}, kDesk);
    region.follow = Follow{};
    region.follow->target = PlanarTarget{kPage};
    document.regions = {Box(region)};
    RegionTracker tracker;
    tracker.follow(document);
    Second now = 10.0_s;
    const auto see = [&](const Image<std::uint8_t>& grey) {
        now += apart;
        tracker.see(grey, now, now);
        return tracker.now().at(0).state == FollowState::following;
    };
    for (int i = 0; i < 6; ++i)
        see(before);
    CHECK(tracker.now().at(0).state == FollowState::following);
    const auto covered = deskWith(nullptr, 2);
    for (int i = 0; i < 5; ++i)
        CHECK_FALSE(see(covered));
    const auto after = deskWith(&elsewhere, 3);
    int pictures = 1;
    while (pictures < 40 && !see(after))
        ++pictures;
    // Its light is put where the page is, once it is no longer taken to be on its way.
    for (int i = 0; i < 20; ++i)
        see(after);
    const auto at = motionAt(tracker.moves(now, 16.7_ms).at(0), 0.0_s).motion;
    CHECK(farthestCorner(moved(cornersOf(kPage), at), moved(cornersOf(kPage), elsewhere)) < 2.0);
    return pictures;
}

}  // namespace

TEST_CASE("a page that was covered and comes back elsewhere is followed again, pictures come fast or slowly") {
    // As long as it is remembered where it was, every other picture is looked at there: twice seven looks and two
    // sightings that agree.
    CHECK(picturesUntilFollowed(16.0_ms) <= 16);
    // Here each picture has time for a whole search.
    CHECK(picturesUntilFollowed(200.0_ms) <= 4);
}

TEST_CASE("a flat thing that comes into sight is seen within seven pictures, however far a search had got") {
    const auto pattern = learntPage();
    law("search", [&] {
        const double angle = *rc::gen::inRange(-180, 181) * std::acos(-1.0) / 180.0;
        const double scale = *rc::gen::inRange(80, 200) / 100.0;
        const double c = scale * std::cos(angle), s = scale * std::sin(angle);
        const double x = *rc::gen::inRange(400, 880), y = *rc::gen::inRange(300, 420);
        // Slow enough: 20 px from the first look to the last.
        const double dx = *rc::gen::inRange(-40, 41) / 10.0, dy = *rc::gen::inRange(-40, 41) / 10.0;
        const int before = *rc::gen::inRange(0, PlanarSearch::kLooks);
        PlanarSearch search;
        for (int i = 0; i < before; ++i)
            RC_ASSERT(!lookedFor(search, *pattern, deskWith(nullptr, static_cast<unsigned>(i + 1))).has_value());
        int pictures = 0;
        for (; pictures < 7; ++pictures) {
            const Motion motion{
                {c, -s, x + dx * pictures - c * 190 + s * 130, s, c, y + dy * pictures - s * 190 - c * 130, 0, 0, 1}};
            const auto seen = lookedFor(search, *pattern, deskWith(&motion, static_cast<unsigned>(pictures + 10)));
            if (!seen) continue;
            const Quad corners = cornersOf(kPage);
            RC_LOG() << "after " << pictures + 1 << " pictures, confidence " << seen->confidence << ", off by "
                     << farthestCorner(moved(corners, seen->motion), moved(corners, motion)) << " px\n";
            RC_ASSERT(farthestCorner(moved(corners, seen->motion), moved(corners, motion)) < 2.0);
            break;
        }
        RC_ASSERT(pictures < 7);
    });
}

TEST_CASE("each look takes its share of a search, and a search that finds nothing begins anew") {
    const auto pattern = learntPage();
    PlanarSearch search;
    for (int round = 0; round < 2; ++round) {
        for (int look = 0; look + 1 < PlanarSearch::kLooks; ++look) {
            CHECK(search.look == look);
            CHECK_FALSE(lookedFor(search, *pattern, deskWith(nullptr, 3)));
            // What is kept of the first picture is small.
            CHECK(search.kept.width() * search.kept.height() * 4 <= kDesk.width * kDesk.height);
        }
        CHECK(search.look == 0);
        CHECK(search.kept.empty());
    }
}

}  // namespace ilf
