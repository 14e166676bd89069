#include "tests/bench/perceived/optics_of.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ilf::bench {
namespace {

/// Neighbouring light that differs by this much (of 255) is a border of light: below it lies a ramp's own rounding.
constexpr int kLightStep = 2;

/// The topmost region of each pixel, as an index; the background's is the number of regions.
cv::Mat labels(const Document& document) {
    const Size size = document.scene.size();
    const auto regions = activeRegions(document);
    cv::Mat map(size.height, size.width, CV_8U, cv::Scalar(static_cast<double>(regions.size())));
    for (std::size_t r = regions.size(); r-- > 0;) {
        const Image<std::uint8_t> mask = toImage(regions[r]->mask);
        const cv::Mat covers(size.height, size.width, CV_8U, const_cast<std::uint8_t*>(mask.pixels().data()));
        map.setTo(static_cast<double>(r), covers >= 128);
    }
    return map;
}

bool sameSurface(const Document& document, int a, int b) {
    const auto regions = activeRegions(document);
    const auto distance = [&](int label) -> const Distance& {
        return label < static_cast<int>(regions.size()) ? regions[static_cast<std::size_t>(label)]->distance
                                                        : document.background->distance;
    };
    return distance(a) == distance(b);
}

}  // namespace

Seen seen(const BenchScene& scene, Metre distance, Dioptre power) {
    const Plan& plan = scene.shown.plan;
    const EyeOptics& eye = plan.input.eye;
    Dioptre off = defocus(eye, distance, power);
    if (!plan.input.camera && scene.request.attending) {
        const auto at = std::ranges::find(plan.regions, *scene.request.attending, &RegionPlan::id);
        if (at != plan.regions.end()) off = defocusAttending(eye, distance, power, at->nearest, at->levelPower);
    }
    const double halfAngle = 0.5 * (eye.pupil * off);
    return {
        std::abs(scene.shown.document.scene.scale.focalPixels * halfAngle / magnification(eye, distance, {}, power)),
        magnification(eye, distance, plan.focusPower, power),
        opticalCentre(scene.shown.document, scene.request.eye, distance)};
}

double weightOf(const Plan& plan, std::size_t level) {
    double slots = 0.0;
    for (const Slot& slot : plan.slots)
        for (const LevelLight& lit : slot.lit)
            if (lit.level == static_cast<int>(level)) slots += lit.weight;
    return slots / (static_cast<double>(plan.slots.size()) * plan.light);
}

double perimeterSums(const BenchScene& scene) {
    constexpr int kStep = 4;  // one pixel in 4 x 4 stands for the others
    const Shown& shown = scene.shown;
    double sums = 0.0;
    for (const SceneLayer& layer : layers(shown.document, shown.plan, 1.0)) {
        for (std::size_t l = 0; l < shown.plan.levels.size(); ++l) {
            const double radius = seen(scene, layer.distance, shown.plan.levels[l].power).radius;
            if (radius < 0.5) continue;
            int lit = 0;
            for (int y = 0; y < layer.coverage.height(); y += kStep)
                for (int x = 0; x < layer.coverage.width(); x += kStep)
                    lit += layer.coverage.at(x, y) > 0.0F && shown.program.images[l].at(x, y) > 0;
            sums += 3.0 * 12.0 * radius * kStep * kStep * lit;
        }
    }
    return sums;
}

double leastBytes(const BenchScene& scene) {
    const Size size = scene.shown.document.scene.size();
    return static_cast<double>(size.width) * size.height *
           (6.0 * sizeof(float) + static_cast<double>(scene.shown.plan.levels.size()));
}

std::vector<unsigned char> boundaryBand(const BenchScene& scene) {
    const Document& document = scene.shown.document;
    const Size size = document.scene.size();
    const cv::Mat label = labels(document);
    std::vector<Image<std::uint8_t>> lights;
    for (std::size_t l = 0; l < scene.shown.plan.levels.size(); ++l)
        lights.push_back(toImage(scene.shown.program.images[l]));

    const auto border = [&](int x, int y, int i, int j) {
        if (i >= size.width || j >= size.height) return false;
        const int a = label.at<std::uint8_t>(y, x), b = label.at<std::uint8_t>(j, i);
        if (a != b && !sameSurface(document, a, b)) return true;
        return std::ranges::any_of(lights, [&](const auto& light) {
            return std::abs(static_cast<int>(light.at(x, y)) - static_cast<int>(light.at(i, j))) >= kLightStep;
        });
    };
    cv::Mat away(size.height, size.width, CV_8U, cv::Scalar(255));
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            if (border(x, y, x + 1, y) || border(x, y, x, y + 1)) away.at<std::uint8_t>(y, x) = 0;

    double largest = 0.0;
    for (const RegionPlan& region : scene.shown.plan.regions)
        for (const Level& level : scene.shown.plan.levels)
            for (const Metre distance : {region.nearest, region.farthest})
                largest = std::max(largest, seen(scene, distance, level.power).radius);
    cv::Mat far;
    cv::distanceTransform(away, far, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    std::vector<unsigned char> band;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            band.push_back(far.at<float>(y, x) <= largest + 2.0 ? 1 : 0);
    return band;
}

}  // namespace ilf::bench
