#include "core/document/select_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/document/depth_surfaces_cv.h"

namespace ilf {

using namespace surfaces;

namespace {

constexpr double kDepthPixels = 0.6e6;
constexpr int kLargestHole = 400;

/// Where the growing starts: the click, or close to it the pixel inside a surface that is most like it in depth.
std::optional<cv::Point> startNear(const Surfaces& s, const Scaled& in, const Scale& scale, cv::Point click) {
    if (in.within(click) != 0) return click;
    const int reach = scale.band();
    const double meant = static_cast<double>(s.measured.vergence(click));
    std::optional<cv::Point> best;
    double least = INFINITY;
    for (int y = std::max(0, click.y - reach); y <= std::min(in.within.rows - 1, click.y + reach); ++y) {
        for (int x = std::max(0, click.x - reach); x <= std::min(in.within.cols - 1, click.x + reach); ++x) {
            if (in.within(y, x) == 0) continue;
            const double away = std::hypot(x - click.x, y - click.y);
            const double bend = static_cast<double>(in.bend);
            const double unlike = meant > 0.0 ? std::abs(static_cast<double>(in.smooth(y, x)) - meant) / bend : 0.0;
            if (unlike > 3.0) continue;
            const double cost = unlike + 0.1 * away;
            if (cost < least) {
                least = cost;
                best = cv::Point(x, y);
            }
        }
    }
    return best;
}

/// The surface around `start`, without the band in which its end is felt.
cv::Mat1b innerPart(const Scaled& in, cv::Point start) {
    cv::Mat1b grown = in.within.clone(), selected;
    constexpr int kGrown = 128;
    cv::floodFill(grown, start, kGrown, nullptr, 0, 0, 4);
    cv::compare(grown, kGrown, selected, cv::CMP_EQ);
    return selected;
}

/// How a surface is carried on.
struct Continuing {
    int baseline = 0;                ///< of its slope, pixels of `Scaled`
    int steps = 0;                   ///< at most; pixels
    int reduced = 1;                 ///< pixels along a side of one of `Scaled`
    const Picture* edges = nullptr;  ///< no strong edge of it may be passed; null: edges do not count
};

/// Carries a surface, by its own slope, from its inner pixels into the band where the second difference felt its end.
void continueToItsEnd(const Measured& measured, const Scaled& in, const Continuing& how, cv::Mat1b& selected) {
    struct Front {
        cv::Point at, from;
        float vergence, dx, dy;
    };
    const int baseline = how.baseline * how.reduced;
    const float allowed = std::max(in.bend, 3.0F * measured.noise);
    const auto smoothAt = [&](cv::Point p) {
        return in.smooth(std::min(p.y / how.reduced, in.smooth.rows - 1),
                         std::min(p.x / how.reduced, in.smooth.cols - 1));
    };
    const auto slope = [&](cv::Point at, int wx, int wy) {
        // Towards the inside, so that the end itself is not part of it.
        float sum = 0.0F;
        int sides = 0;
        for (const int side : {-1, 1}) {
            const cv::Point to(at.x + side * baseline * wx, at.y + side * baseline * wy);
            if (to.x < 0 || to.y < 0 || to.x >= selected.cols || to.y >= selected.rows || selected(to) == 0) continue;
            sum += static_cast<float>(side) * (smoothAt(to) - smoothAt(at)) / static_cast<float>(baseline);
            ++sides;
        }
        return sides > 0 ? sum / static_cast<float>(sides) : 0.0F;
    };
    constexpr std::array<std::array<int, 2>, 4> kNeighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    const auto outside = [&](cv::Point p) {
        return p.x < 0 || p.y < 0 || p.x >= selected.cols || p.y >= selected.rows;
    };
    std::vector<Front> front;
    for (int y = 0; y < selected.rows; ++y) {
        for (int x = 0; x < selected.cols; ++x) {
            if (selected(y, x) == 0) continue;
            for (const auto& [dx, dy] : kNeighbours) {
                const cv::Point to(x + dx, y + dy);
                if (outside(to) || selected(to) != 0) continue;
                front.push_back({{x, y}, {x, y}, smoothAt({x, y}), slope({x, y}, 1, 0), slope({x, y}, 0, 1)});
                break;
            }
        }
    }
    // four neighbours: the way to a corner is longer
    for (int step = 0; step < how.steps; ++step) {
        std::vector<Front> next;
        for (const Front& from : front) {
            for (const auto& [dx, dy] : kNeighbours) {
                const cv::Point to(from.at.x + dx, from.at.y + dy);
                if (outside(to) || selected(to) != 0) continue;
                const float expected =
                    from.vergence + static_cast<float>(dx) * from.dx + static_cast<float>(dy) * from.dy;
                const float own = measured.own.empty() ? 0.0F : measured.own(to);
                const bool on = std::abs(measured.vergence(to) - expected) <= std::max(allowed, own);
                if (!(measured.vergence(to) > 0.0F) || !on) continue;
                if (how.edges != nullptr && differs(*how.edges, from.from, to)) continue;
                selected(to) = 255;
                next.push_back({to, from.from, expected, from.dx, from.dy});
            }
        }
        front = std::move(next);
    }
}

void fillSmallHoles(cv::Mat1b& whole) {
    const cv::Rect around = cv::boundingRect(whole);
    if (around.empty()) return;
    cv::Mat1b selected = whole(around), outside;
    cv::bitwise_not(selected, outside);
    cv::Mat1i labels, stats;
    cv::Mat centroids;
    const int count = cv::connectedComponentsWithStats(outside, labels, stats, centroids, 4, CV_32S);
    std::vector<std::uint8_t> small(static_cast<std::size_t>(count));
    for (int i = 1; i < count; ++i) {
        const int x0 = stats(i, cv::CC_STAT_LEFT), y0 = stats(i, cv::CC_STAT_TOP);
        const int x1 = x0 + stats(i, cv::CC_STAT_WIDTH), y1 = y0 + stats(i, cv::CC_STAT_HEIGHT);
        const bool inner = x0 > 0 && y0 > 0 && x1 < selected.cols && y1 < selected.rows;
        small[static_cast<std::size_t>(i)] = inner && stats(i, cv::CC_STAT_AREA) <= kLargestHole ? 255 : 0;
    }
    forEachRow(selected.rows, [&](int y) {
        const int* label = labels[y];
        std::uint8_t* to = selected[y];
        for (int x = 0; x < selected.cols; ++x)
            to[x] |= small[static_cast<std::size_t>(label[x])];
    });
}

/// Each pixel becomes `side` x `side`; what a whole number of them does not cover repeats the last.
cv::Mat1b enlarged(const cv::Mat1b& small, int side, cv::Size size) {
    cv::Mat1b out(size);
    forEachRow(size.height, [&](int y) {
        const std::uint8_t* from = small[std::min(y / side, small.rows - 1)];
        for (int x = 0; x < size.width; ++x)
            out(y, x) = from[std::min(x / side, small.cols - 1)];
    });
    return out;
}

}  // namespace

Result<Mask> surfaceAt(const DepthMap& depth, const Picture& picture, Point<CameraFrame> seed,
                       const SurfaceSelection& how) {
    if (depth.metres.empty()) {
        return fail(Fault::notFound, "This scene has no depth map to select by: load one, or select by colour.");
    }
    const bool inside =
        seed.x >= 0.0 && seed.y >= 0.0 && seed.x < depth.metres.width() && seed.y < depth.metres.height();
    if (!inside) return fail(Fault::outOfRange, "The click was outside the picture: click on what shall be selected.");
    if (!(how.tolerance >= 0.1 && how.tolerance <= 10.0)) {
        return fail(Fault::outOfRange, "The tolerance of a selection by depth must be from 0.1 to 10.");
    }
    try {
        const bool edges = how.colourEdges && picture.size() == depth.metres.size();
        const Picture* edgesOf = edges ? &picture : nullptr;
        // A large picture is judged at half its size or less: depth is rarely finer than that, and a click is not to
        // wait. Only the surface's end is then looked for in full.
        const Measured full = measuredOf(depth);
        const double all = static_cast<double>(full.vergence.total());
        const int reduce = edges ? 1 : std::max(1, static_cast<int>(std::ceil(std::sqrt(all / kDepthPixels))));
        const Surfaces surfaces = surfacesOf(reduce > 1 ? reduced(full, reduce) : full, edgesOf, how.tolerance);
        const Size size{surfaces.near.within.cols, surfaces.near.within.rows};
        const cv::Point click(std::min(static_cast<int>(seed.x) / reduce, size.width - 1),
                              std::min(static_cast<int>(seed.y) / reduce, size.height - 1));
        // Things too small for the long baseline are all edge to it.
        auto start = startNear(surfaces, surfaces.far, kLong, click);
        const bool large = start.has_value();
        if (!start) start = startNear(surfaces, surfaces.near, kShort, click);
        if (!start) {
            return fail(Fault::notFound, "No surface was measured there: the depth map has a hole or an edge. Click "
                                         "further inside, or select by colour.");
        }
        const Scaled& in = large ? surfaces.far : surfaces.near;
        const Scale& scale = large ? kLong : kShort;
        cv::Mat1b selected = innerPart(in, *start);
        // Across a corner the band is wider, and by way of four neighbours longer still.
        continueToItsEnd(surfaces.measured, in, {scale.baseline, scale.band() * 5 / 2, 1, edgesOf}, selected);
        if (reduce > 1) {
            cv::erode(selected, selected, cv::Mat1b::ones(3, 3));
            selected = enlarged(selected, reduce, full.vergence.size());
            continueToItsEnd(full, in, {scale.baseline, 4 * reduce, reduce, nullptr}, selected);
        }
        fillSmallHoles(selected);
        std::vector<std::uint8_t> pixels(static_cast<std::size_t>(selected.rows) *
                                         static_cast<std::size_t>(selected.cols));
        cv::Mat1b smooth(selected.rows, selected.cols, pixels.data());  // binomial, one pixel to each side
        cv::GaussianBlur(selected, smooth, {3, 3}, 0.0);
        return toTiles(Image<std::uint8_t>(depth.metres.size(), 1, std::move(pixels)));
    } catch (const cv::Exception& e) {
        return fail(Fault::unsupported, std::string("The selection failed, paint the region instead: ") + e.what());
    }
}

}  // namespace ilf
