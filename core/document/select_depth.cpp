#include "core/document/select_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

namespace ilf {

namespace {

constexpr int kBaseline = 6;                        // pixels to either side of a second difference
constexpr int kSmooth = 5;                          // side of the mean before it
constexpr int kBand = kBaseline + kSmooth / 2 + 1;  // so far a step is felt
constexpr float kLeastBend_D = 0.004F;
constexpr float kDeviations = 4.0F, kOwnDeviations = 3.0F;
constexpr float kSupport = 0.3F;  // of the mean's pixels must be measured
constexpr int kLargestHole = 400;
constexpr int kColourBaseline = 2;
constexpr int kColourStep = 24;  // of 255, of the strongest channel

/// What is known of each pixel. `smooth` is 0 where too little was measured.
struct Surfaces {
    cv::Mat1f vergence, smooth;
    cv::Mat1f sigma;   ///< dioptres; empty: not known
    cv::Mat1b within;  ///< 255: neither an edge nor unknown
    float bend = kLeastBend_D;
};

cv::Mat1f vergenceOf(const DepthMap& depth) {
    cv::Mat1f out(depth.metres.height(), depth.metres.width());
    for (int y = 0; y < out.rows; ++y) {
        const float* metres = depth.metres.row(y);
        float* to = out[y];
        for (int x = 0; x < out.cols; ++x)
            to[x] = metres[x] > 0.0F ? 1.0F / metres[x] : 0.0F;
    }
    return out;
}

/// Mean over what was measured, 0 where that is too little.
cv::Mat1f smoothed(const cv::Mat1f& vergence) {
    cv::Mat1f known(vergence.size());
    for (int y = 0; y < vergence.rows; ++y) {
        for (int x = 0; x < vergence.cols; ++x)
            known(y, x) = vergence(y, x) > 0.0F ? 1.0F : 0.0F;
    }
    cv::Mat1f sum, count;
    const cv::Size side(kSmooth, kSmooth);
    cv::boxFilter(vergence, sum, CV_32F, side, {-1, -1}, true, cv::BORDER_REPLICATE);
    cv::boxFilter(known, count, CV_32F, side, {-1, -1}, true, cv::BORDER_REPLICATE);
    for (int y = 0; y < sum.rows; ++y) {
        float* s = sum[y];
        const float* c = count[y];
        for (int x = 0; x < sum.cols; ++x)
            s[x] = c[x] >= kSupport ? s[x] / c[x] : 0.0F;
    }
    return sum;
}

/// The largest second difference of four directions, without sign; negative where a place it needs is unknown. Beyond
/// the picture's rim the nearest one inside counts.
cv::Mat1f bends(const cv::Mat1f& smooth) {
    constexpr std::array<std::array<int, 2>, 4> kWays{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
    cv::Mat1f out(smooth.size());
    for (int y = 0; y < smooth.rows; ++y) {
        const int up = std::min({kBaseline, y, smooth.rows - 1 - y});
        for (int x = 0; x < smooth.cols; ++x) {
            const int side = std::min({kBaseline, x, smooth.cols - 1 - x});
            float bend = smooth(y, x) > 0.0F ? 0.0F : -1.0F;
            for (const auto& [dx, dy] : kWays) {
                const int reach = dx == 0 ? up : dy == 0 ? side : std::min(up, side);
                const float a = smooth(y + reach * dy, x + reach * dx), b = smooth(y - reach * dy, x - reach * dx);
                if (bend < 0.0F || !(a > 0.0F && b > 0.0F)) {
                    bend = -1.0F;
                    break;
                }
                bend = std::max(bend, std::abs(a + b - 2.0F * smooth(y, x)));
            }
            out(y, x) = bend;
        }
    }
    return out;
}

/// Robust standard deviation of the bends of pixels that have one, from every seventh of them.
float spreadOf(const cv::Mat1f& bend) {
    std::vector<float> known;
    int skip = 0;
    for (int y = 0; y < bend.rows; ++y) {
        for (int x = 0; x < bend.cols; ++x) {
            if (bend(y, x) < 0.0F || ++skip % 7 != 0) continue;
            known.push_back(bend(y, x));
        }
    }
    if (known.empty()) return 0.0F;
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    return 1.4826F * *middle / 1.7F;  // the largest of four is some 1.7 times a single one
}

bool differs(const Picture& picture, cv::Point a, cv::Point b) {
    int most = 0;
    for (int c = 0; c < std::min(3, picture.channels()); ++c)
        most = std::max(most, std::abs(int{picture.at(a.x, a.y, c)} - int{picture.at(b.x, b.y, c)}));
    return most > kColourStep * 257;
}

void cutColourEdges(const Picture& picture, cv::Mat1b& within) {
    for (int y = kColourBaseline; y < within.rows - kColourBaseline; ++y) {
        for (int x = kColourBaseline; x < within.cols - kColourBaseline; ++x) {
            if (differs(picture, {x - kColourBaseline, y}, {x + kColourBaseline, y}) ||
                differs(picture, {x, y - kColourBaseline}, {x, y + kColourBaseline})) {
                within(y, x) = 0;
            }
        }
    }
}

Surfaces surfacesOf(const DepthMap& depth, const Picture& picture, const SurfaceSelection& how) {
    Surfaces s;
    s.vergence = vergenceOf(depth);
    s.smooth = smoothed(s.vergence);
    if (depth.sigma.size() == depth.metres.size()) {
        s.sigma.create(s.vergence.size());
        for (int y = 0; y < s.sigma.rows; ++y) {
            for (int x = 0; x < s.sigma.cols; ++x)
                s.sigma(y, x) = depth.sigma.at(x, y) * s.vergence(y, x) * s.vergence(y, x);
        }
    }
    const cv::Mat1f bend = bends(s.smooth);
    s.bend = static_cast<float>(how.tolerance) * std::max(kLeastBend_D, kDeviations * spreadOf(bend));
    s.within.create(bend.size());
    for (int y = 0; y < bend.rows; ++y) {
        for (int x = 0; x < bend.cols; ++x) {
            const float own = s.sigma.empty() ? 0.0F : kOwnDeviations * s.sigma(y, x);
            s.within(y, x) = bend(y, x) >= 0.0F && bend(y, x) <= std::max(s.bend, own) ? 255 : 0;
        }
    }
    if (how.colourEdges && picture.size() == depth.metres.size()) cutColourEdges(picture, s.within);
    return s;
}

/// Where the growing starts: the click, or close to it the pixel inside a surface that is most like it in depth.
std::optional<cv::Point> startNear(const Surfaces& s, cv::Point click) {
    if (s.within(click) != 0) return click;
    float meant = s.vergence(click);
    std::optional<cv::Point> best;
    double least = INFINITY;
    for (int y = std::max(0, click.y - kBand); y <= std::min(s.within.rows - 1, click.y + kBand); ++y) {
        for (int x = std::max(0, click.x - kBand); x <= std::min(s.within.cols - 1, click.x + kBand); ++x) {
            if (s.within(y, x) == 0) continue;
            const double away = std::hypot(x - click.x, y - click.y);
            const double unlike = meant > 0.0F ? std::abs(static_cast<double>(s.smooth(y, x) - meant)) : 0.0;
            const double cost = unlike / static_cast<double>(s.bend) + 0.1 * away;
            if (cost < least) {
                least = cost;
                best = cv::Point(x, y);
            }
        }
    }
    return best;
}

/// Carries a surface, by its own slope, from its inner pixels into the band where the second difference felt its end.
/// `picture`: of which no strong edge may be passed; null where edges do not count.
void continueToItsEnd(const Surfaces& s, const Picture* picture, cv::Mat1b& selected) {
    struct Front {
        cv::Point at, from;
        float vergence, dx, dy;
    };
    const auto slope = [&](cv::Point at, int wx, int wy) {
        // Towards the inside, so that the end itself is not part of it.
        float sum = 0.0F;
        int sides = 0;
        for (const int side : {-1, 1}) {
            const cv::Point to(at.x + side * kBaseline * wx, at.y + side * kBaseline * wy);
            if (to.x < 0 || to.y < 0 || to.x >= selected.cols || to.y >= selected.rows || selected(to) == 0) continue;
            sum += static_cast<float>(side) * (s.smooth(to) - s.smooth(at)) / static_cast<float>(kBaseline);
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
                front.push_back({{x, y}, {x, y}, s.smooth(y, x), slope({x, y}, 1, 0), slope({x, y}, 0, 1)});
                break;
            }
        }
    }
    constexpr int kSteps = kBand * 3 / 2;  // four neighbours: the way to a corner is longer
    for (int step = 0; step < kSteps; ++step) {
        std::vector<Front> next;
        for (const Front& from : front) {
            for (const auto& [dx, dy] : kNeighbours) {
                const cv::Point to(from.at.x + dx, from.at.y + dy);
                if (outside(to) || selected(to) != 0) continue;
                const float expected =
                    from.vergence + static_cast<float>(dx) * from.dx + static_cast<float>(dy) * from.dy;
                const float own = s.sigma.empty() ? 0.0F : kOwnDeviations * s.sigma(to);
                const bool on = std::abs(s.vergence(to) - expected) <= std::max(s.bend, own);
                if (!(s.vergence(to) > 0.0F) || !on) continue;
                if (picture != nullptr && differs(*picture, from.from, to)) continue;
                selected(to) = 255;
                next.push_back({to, from.from, expected, from.dx, from.dy});
            }
        }
        front = std::move(next);
    }
}

void fillSmallHoles(cv::Mat1b& selected) {
    cv::Mat1i labels;
    cv::Mat1i stats;
    cv::Mat centroids;
    cv::Mat1b outside;
    cv::bitwise_not(selected, outside);
    const int count = cv::connectedComponentsWithStats(outside, labels, stats, centroids, 4, CV_32S);
    std::vector<bool> small(static_cast<std::size_t>(count));
    for (int i = 1; i < count; ++i) {
        const int x0 = stats(i, cv::CC_STAT_LEFT), y0 = stats(i, cv::CC_STAT_TOP);
        const int x1 = x0 + stats(i, cv::CC_STAT_WIDTH), y1 = y0 + stats(i, cv::CC_STAT_HEIGHT);
        const bool inner = x0 > 0 && y0 > 0 && x1 < selected.cols && y1 < selected.rows;
        small[static_cast<std::size_t>(i)] = inner && stats(i, cv::CC_STAT_AREA) <= kLargestHole;
    }
    for (int y = 0; y < selected.rows; ++y) {
        for (int x = 0; x < selected.cols; ++x) {
            if (small[static_cast<std::size_t>(labels(y, x))]) selected(y, x) = 255;
        }
    }
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
        const Surfaces surfaces = surfacesOf(depth, picture, how);
        const auto start = startNear(surfaces, {static_cast<int>(seed.x), static_cast<int>(seed.y)});
        if (!start) {
            return fail(Fault::notFound, "No surface was measured there: the depth map has a hole or an edge. Click "
                                         "further inside, or select by colour.");
        }
        cv::Mat1b grown = surfaces.within.clone();
        constexpr int kGrown = 128;
        cv::floodFill(grown, *start, kGrown, nullptr, 0, 0, 4);
        cv::Mat1b selected;
        cv::compare(grown, kGrown, selected, cv::CMP_EQ);
        const bool edges = how.colourEdges && picture.size() == depth.metres.size();
        continueToItsEnd(surfaces, edges ? &picture : nullptr, selected);
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
