// Markers and a planar target in real photographs, against references made by other programs.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <string>
#include <vector>

#include "core/track/marker.h"
#include "core/track/planar.h"
#include "tests/support/test_data.h"

namespace ilf {

namespace {

Image<std::uint8_t> photo(const std::string& path) {
    const cv::Mat grey = cv::imread(path, cv::IMREAD_GRAYSCALE);
    return {{grey.cols, grey.rows}, 1, std::vector<std::uint8_t>(grey.datastart, grey.dataend)};
}

struct Errors {
    std::vector<double> all;
    double rms() const {
        double sum = 0.0;
        for (const double e : all)
            sum += e * e;
        return std::sqrt(sum / static_cast<double>(all.size()));
    }
    double quantile(double share) const {
        auto sorted = all;
        std::ranges::sort(sorted);
        return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
    }
    double within(double px) const {
        return static_cast<double>(std::ranges::count_if(all, [&](double e) { return e <= px; })) /
               static_cast<double>(all.size());
    }
};

/// What the AprilTag program printed: (x y) four times a line, pixel centres at + 0.5, from the tag's top right
/// anticlockwise. Here in our order.
std::vector<Quad> printedTags(const std::string& path) {
    std::vector<Quad> tags;
    std::ifstream in(path);
    const std::regex number(R"(\(([0-9.]+) ([0-9.]+)\))");
    for (std::string line; std::getline(in, line);) {
        Quad q;
        std::size_t n = 0;
        for (std::sregex_iterator i(line.begin(), line.end(), number), end; i != end && n < 4; ++i, ++n)
            q[n] = {std::stod((*i)[1]), std::stod((*i)[2])};
        if (n == 4) tags.push_back({{q[1], q[0], q[3], q[2]}});
    }
    return tags;
}

/// The quad whose sides lie `by` farther out. Corners clockwise.
Quad grownBy(const Quad& quad, double by) {
    Quad out;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto &a = quad[(i + 3) % 4], &b = quad[i], &c = quad[(i + 1) % 4];
        const double ab = std::hypot(b.x - a.x, b.y - a.y), cb = std::hypot(b.x - c.x, b.y - c.y);
        const double ux = (b.x - a.x) / ab, uy = (b.y - a.y) / ab, vx = (b.x - c.x) / cb, vy = (b.y - c.y) / cb;
        const double sine = std::abs(ux * vy - uy * vx);
        out[i] = {b.x + by * (ux + vx) / sine, b.y + by * (uy + vy) / sine};
    }
    return out;
}

}  // namespace

TEST_CASE("AprilTags in photographs: corners as the AprilTag program finds them") {
    struct Photo {
        const char* name;
        std::size_t fewest;  // OpenCV's own detector finds so many (GROUND_TRUTH.json)
    };
    Errors errors;
    for (const Photo& p : {Photo{"33369213973_9d9bb4cc96_c", 11}, Photo{"34085369442_304b6bafd9_c", 4},
                           Photo{"34139872896_defdb2f8d9_c", 7}}) {
        const auto path = testData("04_tracking/apriltag/" + std::string(p.name) + ".jpg");
        if (!path) return;
        const auto tags = printedTags(testData("04_tracking/apriltag/" + std::string(p.name) + ".txt")->string());
        const auto seen = findMarkers(photo(path->string()), {"APRILTAG_36h11", {0}, {}, 1});
        REQUIRE(seen);
        CHECK(seen->size() >= p.fewest);
        for (const Quad& tag : tags) {
            for (const SeenMarker& marker : *seen) {
                const auto a = middleOf(tag), b = middleOf(marker.corners);
                if (std::hypot(a.x - b.x, a.y - b.y) > 3.0) continue;
                // The middle of a tag, four corners together, is what moves a region.
                CHECK(std::hypot(a.x - b.x, a.y - b.y) < 0.5);
                for (std::size_t k = 0; k < 4; ++k)
                    errors.all.push_back(std::hypot(tag[k].x - marker.corners[k].x, tag[k].y - marker.corners[k].y));
            }
        }
    }
    MESSAGE(errors.all.size(), " corners: rms ", errors.rms(), " px, median ", errors.quantile(0.5), ", worst ",
            errors.quantile(1.0), ", within 0.5 px ", 100 * errors.within(0.5), " %");
    CHECK(errors.all.size() >= 80);
    CHECK(errors.rms() < 0.5);
    CHECK(errors.quantile(0.5) < 0.4);
    // Their program samples whole pixels, and the smallest tags here are 15 px wide.
    CHECK(errors.within(0.85) == 1.0);
}

TEST_CASE("ArUco markers in photographs: corners about the whole pixels of OpenCV's contours") {
    const auto path = testData("04_tracking/GROUND_TRUTH.json");
    if (!path) return;
    const auto truth = nlohmann::json::parse(std::ifstream(*path));
    Errors errors, middles;
    for (const std::string file : {"aruco/choriginal.jpg", "aruco/singlemarkersoriginal.jpg"}) {
        const auto& about = truth.at(file);
        const auto ids = about.at("ids").get<std::vector<int>>();
        const auto seen = findMarkers(photo(testData("04_tracking/" + file)->string()), {"6X6_250", ids, {}, 1});
        REQUIRE(seen);
        CHECK(seen->size() == ids.size());
        for (const SeenMarker& marker : *seen) {
            CHECK(marker.confidence > 0.8);
            // They are the outermost dark pixels, found without refinement: their centres lie half a pixel inside the
            // black square's edge, and each is rounded to a whole pixel (0.41 px rms, 0.71 at most, by that alone).
            Quad dark;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto& c = about.at("corners").at(std::to_string(marker.id)).at(k);
                dark[k] = {c.at(0).get<double>() + 0.5, c.at(1).get<double>() + 0.5};
            }
            const Quad edge = grownBy(dark, 0.5);
            for (std::size_t k = 0; k < 4; ++k)
                errors.all.push_back(std::hypot(edge[k].x - marker.corners[k].x, edge[k].y - marker.corners[k].y));
            const auto a = middleOf(edge), b = middleOf(marker.corners);
            middles.all.push_back(std::hypot(a.x - b.x, a.y - b.y));
        }
    }
    MESSAGE(errors.all.size(), " corners: rms ", errors.rms(), " px, worst ", errors.quantile(1.0), ", within 0.5 px ",
            100 * errors.within(0.5), " %; middles: rms ", middles.rms(), " px, worst ", middles.quantile(1.0));
    CHECK(errors.rms() < 0.55);
    CHECK(errors.quantile(1.0) < 0.9);
    CHECK(middles.quantile(1.0) < 0.5);
}

TEST_CASE("a printed box is found in a cluttered photograph where SIFT finds it") {
    const auto path = testData("04_tracking/planar/box.png");
    if (!path) return;
    const auto box = photo(path->string()), scene = photo(testData("04_tracking/planar/box_in_scene.png")->string());
    const auto truth = nlohmann::json::parse(std::ifstream(*testData("04_tracking/GROUND_TRUTH.json")));
    const auto& quad = truth.at("planar/H_box_to_scene").at("quad");
    const auto pattern = planarPattern(box, {0, 0, box.width(), box.height()});
    REQUIRE(pattern);
    const auto seen = findPlanar(**pattern, scene);
    REQUIRE(seen);
    CHECK(seen->confidence > 0.6);
    const Quad corners = moved(cornersOf((*pattern)->patch), seen->motion);
    Errors errors;
    for (std::size_t k = 0; k < 4; ++k) {
        errors.all.push_back(
            std::hypot(quad.at(k).at(0).get<double>() - corners[k].x, quad.at(k).at(1).get<double>() - corners[k].y));
    }
    MESSAGE("corners off SIFT's by rms ", errors.rms(), " px, ", seen->inliers, " of ", seen->asked, " points agree");
    CHECK(errors.quantile(1.0) < 1.5);

    SUBCASE("from there it is followed, also under another light and from 12 px off") {
        Motion off = seen->motion;
        off.m[2] += 12.0 * off.m[8];
        cv::Mat dim(scene.height(), scene.width(), CV_8UC1);
        for (int y = 0; y < dim.rows; ++y) {
            for (int x = 0; x < dim.cols; ++x)
                dim.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(20 + scene.at(x, y) / 2);
        }
        const auto again =
            followPlanar(**pattern, {scene.size(), 1, std::vector<std::uint8_t>(dim.datastart, dim.dataend)}, off);
        REQUIRE(again);
        CHECK(farthestCorner(corners, moved(cornersOf((*pattern)->patch), again->motion)) < 1.5);
    }
    SUBCASE("it is not found where it is not") {
        const auto other = testData("04_tracking/aruco/choriginal.jpg");
        CHECK(!findPlanar(**pattern, photo(other->string())));
        const auto wrong = followPlanar(**pattern, photo(other->string()), seen->motion);
        CHECK((!wrong || wrong->confidence < 0.3));
    }
}

TEST_CASE("a patch without texture is refused in words, and so is one outside the picture") {
    const Image<std::uint8_t> plain({200, 100}, 1, std::vector<std::uint8_t>(20'000, 120));
    CHECK(planarPattern(plain, {10, 10, 190, 90}).error().what.find("too little texture") != std::string::npos);
    CHECK(planarPattern(plain, {-10, 10, 190, 90}).error().fault == Fault::outOfRange);
}

}  // namespace ilf
