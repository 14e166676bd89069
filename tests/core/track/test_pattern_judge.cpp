// Whom to believe about corners in photographs: a judge that is right about drawn ones.
#include "tests/support/pattern_judge.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/core/track/drawn_marker.h"

namespace ilf {

TEST_CASE(
    "the judge of corners finds those of drawn markers, small, blurred by pixels and in noise, from half a pixel off") {
    std::vector<double> errors;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> one(-0.5, 0.5);
    for (unsigned i = 0; i < 12; ++i) {
        const double side = 17.0 + 2.0 * i, angle = one(random), shear = 0.5 * one(random);
        const double c = side * std::cos(angle), s = side * std::sin(angle);
        Quad truth{{{-0.5, -0.4}, {0.5, -0.4}, {0.5, 0.4}, {-0.5, 0.4}}}, start;
        for (std::size_t k = 0; k < 4; ++k) {
            const double x = truth[k].x + shear * truth[k].y, y = truth[k].y;
            truth[k] = {50.0 + c * x - s * y, 50.0 + s * x + c * y};
            start[k] = {truth[k].x + one(random), truth[k].y + one(random)};
        }
        DrawnScene scene;
        scene.size = {100, 100};
        scene.noise = 2.0;
        scene.seed = i + 1;
        const auto grey = drawnMarker(scene, cv::aruco::DICT_APRILTAG_36h11, 0, truth);
        const Quad found = PatternJudge(grey, cv::aruco::DICT_APRILTAG_36h11, 0, start).corners(start);
        for (std::size_t k = 0; k < 4; ++k)
            errors.push_back(std::hypot(found[k].x - truth[k].x, found[k].y - truth[k].y));
    }
    double squares = 0.0;
    for (const double e : errors)
        squares += e * e;
    const double rms = std::sqrt(squares / static_cast<double>(errors.size())),
                 worst = *std::ranges::max_element(errors);
    MESSAGE("rms ", rms, " px, worst ", worst);
    CHECK(rms < 0.06);
    CHECK(worst < 0.2);
}

}  // namespace ilf
