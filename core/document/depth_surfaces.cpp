#include "core/document/depth_surfaces_cv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "core/base/parallel.h"

namespace ilf::surfaces {

void forEachRow(int rows, const std::function<void(int)>& work) {
    constexpr int kRows = 32;
    parallelFor((rows + kRows - 1) / kRows, [&](int part) {
        for (int y = part * kRows; y < std::min(rows, (part + 1) * kRows); ++y)
            work(y);
    });
}

bool differs(const Picture& picture, cv::Point a, cv::Point b) {
    constexpr int kColourStep = 24;  // of 255, of the strongest channel
    int most = 0;
    for (int c = 0; c < std::min(3, picture.channels()); ++c)
        most = std::max(most, std::abs(int{picture.at(a.x, a.y, c)} - int{picture.at(b.x, b.y, c)}));
    return most > kColourStep * 257;
}

namespace {

constexpr float kLeastBend_D = 0.004F;
constexpr float kDeviations = 4.0F, kOwnDeviations = 3.0F;
constexpr float kSupport = 0.3F;  // of the mean's pixels must be measured
constexpr int kColourBaseline = 2;
constexpr float kUnknown = 1e9F, kKnown = 1e8F;  // dioptres; a difference with it is beyond every limit

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
    return smooth(y, x) < kKnown ? std::max({a, b, c, d}) : kUnknown;
}

/// Standard deviation of a second difference where there are only planes and noise, from one pixel in 25: a fifth of
/// even a cluttered picture's pixels lie on such, and of the largest of four normal deviations a fifth stay below 0.97.
float spreadOf(const cv::Mat1f& smooth, int baseline) {
    constexpr int kSparse = 5;
    std::vector<float> known;
    for (int y = baseline; y < smooth.rows - baseline; y += kSparse) {
        for (int x = baseline; x < smooth.cols - baseline; x += kSparse) {
            const float bend = bendAt(smooth, x, y, baseline);
            if (bend < kKnown) known.push_back(bend);
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
        // In two loops of one type each, which compilers turn into vectors.
        std::vector<float> over(static_cast<std::size_t>(columns));
        for (int x = h; x < columns - h; ++x) {
            const float twice = 2.0F * here[x];
            const float a = std::abs(here[x - h] + here[x + h] - twice), b = std::abs(above[x] + below[x] - twice);
            const float c = std::abs(above[x - h] + below[x + h] - twice);
            const float d = std::abs(above[x + h] + below[x - h] - twice);
            const float ab = a > b ? a : b, cd = c > d ? c : d, most = ab > cd ? ab : cd;
            over[static_cast<std::size_t>(x)] = here[x] < kKnown ? most - limit[x] : kUnknown;
        }
        for (int x = h; x < columns - h; ++x)
            to[x] = over[static_cast<std::size_t>(x)] <= 0.0F ? 255 : 0;
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

/// From second differences of neighbours, one in 25: of the amounts of normal deviations a fifth stay below 0.253.
float noiseOf(const cv::Mat1f& vergence) {
    constexpr int kSparse = 5;
    std::vector<float> amounts;
    for (int y = 0; y < vergence.rows; y += kSparse) {
        const float* v = vergence[y];
        for (int x = 1; x < vergence.cols - 1; x += kSparse) {
            if (v[x - 1] > 0.0F && v[x] > 0.0F && v[x + 1] > 0.0F) {
                amounts.push_back(std::abs(v[x - 1] + v[x + 1] - 2.0F * v[x]));
            }
        }
    }
    if (amounts.empty()) return 0.0F;
    const auto fifth = amounts.begin() + static_cast<std::ptrdiff_t>(amounts.size() / 5);
    std::nth_element(amounts.begin(), fifth, amounts.end());
    return *fifth / (0.253F * std::sqrt(6.0F));
}

}  // namespace

Measured measuredOf(const DepthMap& depth) {
    Measured m;
    m.vergence = vergenceOf(depth);
    m.own = ownLimits(depth, m.vergence);
    m.noise = noiseOf(m.vergence);
    return m;
}

Measured reduced(const Measured& full, int side) {
    Measured m;
    const int rows = full.vergence.rows / side, columns = full.vergence.cols / side;
    m.vergence.create(rows, columns);
    if (!full.own.empty()) m.own.create(rows, columns);
    forEachRow(rows, [&](int y) {
        for (int x = 0; x < columns; ++x) {
            float sum = 0.0F, count = 0.0F, own = 0.0F;
            for (int j = y * side; j < (y + 1) * side; ++j) {
                for (int i = x * side; i < (x + 1) * side; ++i) {
                    const float v = full.vergence(j, i);
                    sum += v;
                    count += v > 0.0F ? 1.0F : 0.0F;
                    if (!full.own.empty()) own += full.own(j, i);
                }
            }
            m.vergence(y, x) = count > 0.0F ? sum / count : 0.0F;
            if (!full.own.empty()) m.own(y, x) = count > 0.0F ? own / count : 0.0F;
        }
    });
    m.noise = noiseOf(m.vergence);
    return m;
}

Surfaces surfacesOf(Measured measured, const Picture* edges, double tolerance) {
    Surfaces s;
    s.measured = std::move(measured);
    const cv::Mat1f& vergence = s.measured.vergence;
    cv::Mat1f known(vergence.size());
    forEachRow(known.rows, [&](int y) {
        for (int x = 0; x < known.cols; ++x)
            known(y, x) = vergence(y, x) > 0.0F ? 1.0F : 0.0F;
    });
    s.near = scaledOf(vergence, known, s.measured.own, kShort, tolerance);
    s.far = scaledOf(vergence, known, s.measured.own, kLong, tolerance);
    cv::bitwise_and(s.far.within, s.near.within, s.far.within);
    if (edges != nullptr) {
        cutColourEdges(*edges, s.near.within);
        cutColourEdges(*edges, s.far.within);
    }
    return s;
}

}  // namespace ilf::surfaces
