#include "core/document/select_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "core/base/parallel.h"

namespace ilf {

namespace {

/// How far the places of a second difference are apart, and the side of the mean before it. The short one finds the
/// edges of small things, the long one the weak creases of far ones, which noise hides from the short.
struct Scale {
    int baseline, smooth;
    int band() const { return baseline + smooth / 2 + 1; }  // so far a step is felt
};
constexpr Scale kShort{6, 5}, kLong{14, 9};

constexpr float kLeastBend_D = 0.004F;
constexpr float kDeviations = 4.0F, kOwnDeviations = 3.0F;
constexpr float kSupport = 0.3F;  // of the mean's pixels must be measured
constexpr int kLargestHole = 400;
constexpr int kColourBaseline = 2;
constexpr int kColourStep = 24;                                      // of 255, of the strongest channel
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();  // compares false with every limit

/// The map in one of the two scales.
struct Scaled {
    cv::Mat1f smooth;  ///< kUnknown where too little was measured
    float bend = kLeastBend_D;
    cv::Mat1b within;  ///< 255: neither an edge nor unknown
};

struct Surfaces {
    cv::Mat1f vergence;  ///< 0 at holes
    cv::Mat1f own;       ///< what a pixel's own uncertainty allows, dioptres; empty: not known
    Scaled near, far;
};

void forEachRow(int rows, const std::function<void(int)>& work) {
    constexpr int kRows = 32;
    parallelFor((rows + kRows - 1) / kRows, [&](int part) {
        for (int y = part * kRows; y < std::min(rows, (part + 1) * kRows); ++y)
            work(y);
    });
}

cv::Mat1f vergenceOf(const DepthMap& depth) {
    cv::Mat1f out(depth.metres.height(), depth.metres.width());
    forEachRow(out.rows, [&](int y) {
        const float* metres = depth.metres.row(y);
        float* to = out[y];
        for (int x = 0; x < out.cols; ++x)
            to[x] = metres[x] > 0.0F ? 1.0F / metres[x] : 0.0F;
    });
    return out;
}

cv::Mat1f ownLimits(const DepthMap& depth, const cv::Mat1f& vergence) {
    if (depth.sigma.size() != depth.metres.size() || depth.sigma.empty()) return {};
    cv::Mat1f out(vergence.size());
    forEachRow(out.rows, [&](int y) {
        const float* sigma = depth.sigma.row(y);
        const float* v = vergence[y];
        for (int x = 0; x < out.cols; ++x)
            out(y, x) = kOwnDeviations * sigma[x] * v[x] * v[x];
    });
    return out;
}

/// Mean over what was measured.
cv::Mat1f smoothed(const cv::Mat1f& vergence, const cv::Mat1f& known, int side) {
    cv::Mat1f sum, count;
    cv::boxFilter(vergence, sum, CV_32F, {side, side}, {-1, -1}, true, cv::BORDER_REPLICATE);
    cv::boxFilter(known, count, CV_32F, {side, side}, {-1, -1}, true, cv::BORDER_REPLICATE);
    forEachRow(sum.rows, [&](int y) {
        float* s = sum[y];
        const float* c = count[y];
        for (int x = 0; x < sum.cols; ++x)
            s[x] = c[x] >= kSupport ? s[x] / c[x] : kUnknown;
    });
    return sum;
}

/// The largest second difference of four directions, without sign; kUnknown where a place it needs is unknown. Near the
/// picture's rim over a shorter baseline.
float bendAt(const cv::Mat1f& smooth, int x, int y, int baseline) {
    const int up = std::min({baseline, y, smooth.rows - 1 - y});
    const int side = std::min({baseline, x, smooth.cols - 1 - x});
    const int both = std::min(up, side);
    const float twice = 2.0F * smooth(y, x);
    const float a = std::abs(smooth(y, x - side) + smooth(y, x + side) - twice);
    const float b = std::abs(smooth(y - up, x) + smooth(y + up, x) - twice);
    const float c = std::abs(smooth(y - both, x - both) + smooth(y + both, x + both) - twice);
    const float d = std::abs(smooth(y - both, x + both) + smooth(y + both, x - both) - twice);
    const float sum = a + b + c + d;
    return std::isnan(sum) ? kUnknown : std::max({a, b, c, d});
}

/// Standard deviation of a second difference where there are only planes and noise, from one pixel in 25: a fifth of
/// even a cluttered picture's pixels lie on such, and of the largest of four normal deviations a fifth stay below 0.97.
float spreadOf(const cv::Mat1f& smooth, int baseline) {
    constexpr int kSparse = 5;
    std::vector<float> known;
    for (int y = baseline; y < smooth.rows - baseline; y += kSparse) {
        for (int x = baseline; x < smooth.cols - baseline; x += kSparse) {
            const float bend = bendAt(smooth, x, y, baseline);
            if (!std::isnan(bend)) known.push_back(bend);
        }
    }
    if (known.empty()) return 0.0F;
    const auto fifth = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 5);
    std::nth_element(known.begin(), fifth, known.end());
    return *fifth / 0.97F;
}

/// Pixels that do not bend more than `bend`, or than their own uncertainty allows.
void findWithin(Scaled& s, const cv::Mat1f& own, int baseline) {
    const cv::Mat1f& smooth = s.smooth;
    s.within.create(smooth.size());
    const int rows = smooth.rows, columns = smooth.cols, h = baseline;
    forEachRow(rows, [&](int y) {
        std::vector<float> limits(static_cast<std::size_t>(columns), s.bend);
        if (!own.empty()) {
            for (int x = 0; x < columns; ++x)
                limits[static_cast<std::size_t>(x)] = std::max(s.bend, own(y, x));
        }
        std::uint8_t* to = s.within[y];
        const auto rim = [&](int x) {
            to[x] = bendAt(smooth, x, y, h) <= limits[static_cast<std::size_t>(x)] ? 255 : 0;
        };
        if (y < h || y >= rows - h || columns <= 2 * h) {
            for (int x = 0; x < columns; ++x)
                rim(x);
            return;
        }
        for (int x = 0; x < h; ++x)
            rim(x);
        for (int x = columns - h; x < columns; ++x)
            rim(x);
        const float *here = smooth[y], *above = smooth[y - h], *below = smooth[y + h], *limit = limits.data();
        for (int x = h; x < columns - h; ++x) {
            const float twice = 2.0F * here[x];
            const bool fits = (std::abs(here[x - h] + here[x + h] - twice) <= limit[x]) &
                              (std::abs(above[x] + below[x] - twice) <= limit[x]) &
                              (std::abs(above[x - h] + below[x + h] - twice) <= limit[x]) &
                              (std::abs(above[x + h] + below[x - h] - twice) <= limit[x]);
            to[x] = fits ? 255 : 0;
        }
    });
    // Along the rim a short baseline sees no edge that runs across it: there the edges of the inside go on outwards.
    if (columns <= 2 * h || rows <= 2 * h) return;
    for (int y = 0; y < rows; ++y) {
        const bool rimRow = y < h || y >= rows - h;
        for (int x = 0; x < columns; ++x) {
            if (!rimRow && x == h) x = columns - h;
            if (s.within(std::clamp(y, h, rows - 1 - h), std::clamp(x, h, columns - 1 - h)) == 0) s.within(y, x) = 0;
        }
    }
}

Scaled scaledOf(const cv::Mat1f& vergence, const cv::Mat1f& known, const cv::Mat1f& own, const Scale& scale,
                double tolerance) {
    Scaled s;
    s.smooth = smoothed(vergence, known, scale.smooth);
    s.bend = static_cast<float>(tolerance) * std::max(kLeastBend_D, kDeviations * spreadOf(s.smooth, scale.baseline));
    findWithin(s, own, scale.baseline);
    return s;
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

Surfaces surfacesOf(const DepthMap& depth, const Picture* edges, double tolerance) {
    Surfaces s;
    s.vergence = vergenceOf(depth);
    s.own = ownLimits(depth, s.vergence);
    cv::Mat1f known(s.vergence.size());
    forEachRow(known.rows, [&](int y) {
        for (int x = 0; x < known.cols; ++x)
            known(y, x) = s.vergence(y, x) > 0.0F ? 1.0F : 0.0F;
    });
    s.near = scaledOf(s.vergence, known, s.own, kShort, tolerance);
    s.far = scaledOf(s.vergence, known, s.own, kLong, tolerance);
    cv::bitwise_and(s.far.within, s.near.within, s.far.within);
    if (edges != nullptr) {
        cutColourEdges(*edges, s.near.within);
        cutColourEdges(*edges, s.far.within);
    }
    return s;
}

/// Where the growing starts: the click, or close to it the pixel inside a surface that is most like it in depth.
std::optional<cv::Point> startNear(const Surfaces& s, const Scaled& in, const Scale& scale, cv::Point click) {
    if (in.within(click) != 0) return click;
    const int reach = scale.band();
    const double meant = static_cast<double>(s.vergence(click));
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

/// Carries a surface, by its own slope, from its inner pixels into the band where the second difference felt its end.
/// `picture`: of which no strong edge may be passed; null where edges do not count.
void continueToItsEnd(const Surfaces& s, const Scaled& in, const Scale& scale, const Picture* picture,
                      cv::Mat1b& selected) {
    struct Front {
        cv::Point at, from;
        float vergence, dx, dy;
    };
    const auto slope = [&](cv::Point at, int wx, int wy) {
        // Towards the inside, so that the end itself is not part of it.
        float sum = 0.0F;
        int sides = 0;
        for (const int side : {-1, 1}) {
            const cv::Point to(at.x + side * scale.baseline * wx, at.y + side * scale.baseline * wy);
            if (to.x < 0 || to.y < 0 || to.x >= selected.cols || to.y >= selected.rows || selected(to) == 0) continue;
            sum += static_cast<float>(side) * (in.smooth(to) - in.smooth(at)) / static_cast<float>(scale.baseline);
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
                front.push_back({{x, y}, {x, y}, in.smooth(y, x), slope({x, y}, 1, 0), slope({x, y}, 0, 1)});
                break;
            }
        }
    }
    const int steps = scale.band() * 3 / 2;  // four neighbours: the way to a corner is longer
    for (int step = 0; step < steps; ++step) {
        std::vector<Front> next;
        for (const Front& from : front) {
            for (const auto& [dx, dy] : kNeighbours) {
                const cv::Point to(from.at.x + dx, from.at.y + dy);
                if (outside(to) || selected(to) != 0) continue;
                const float expected =
                    from.vergence + static_cast<float>(dx) * from.dx + static_cast<float>(dy) * from.dy;
                const float own = s.own.empty() ? 0.0F : s.own(to);
                const bool on = std::abs(s.vergence(to) - expected) <= std::max(in.bend, own);
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
        const bool edges = how.colourEdges && picture.size() == depth.metres.size();
        const Picture* edgesOf = edges ? &picture : nullptr;
        const Surfaces surfaces = surfacesOf(depth, edgesOf, how.tolerance);
        const cv::Point click(static_cast<int>(seed.x), static_cast<int>(seed.y));
        // Things too small for the long baseline are all edge to it.
        auto start = startNear(surfaces, surfaces.far, kLong, click);
        const bool large = start.has_value();
        if (!start) start = startNear(surfaces, surfaces.near, kShort, click);
        if (!start) {
            return fail(Fault::notFound, "No surface was measured there: the depth map has a hole or an edge. Click "
                                         "further inside, or select by colour.");
        }
        const Scaled& in = large ? surfaces.far : surfaces.near;
        cv::Mat1b selected = innerPart(in, *start);
        continueToItsEnd(surfaces, in, large ? kLong : kShort, edgesOf, selected);
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
