#include "core/registration/bump.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/registration/convert.h"

namespace ilf {

namespace {

/// Features are looked for in pictures about this wide: a quarter of the work, and fine enough after refinement.
constexpr int kWorkingWidth = 700;
constexpr int kFeatures = 400, kFewest = 40;
/// Bits of 256 that may differ between a feature and itself.
constexpr int kMostBits = 48;
/// Camera pixels: what counts as having stayed, and as following a common motion.
constexpr double kStays = 1.0, kFollows = 3.0;
/// Half the side of the patch that refines a match, and how far it looks, camera pixels.
constexpr int kPatch = 7, kLook = 3;

cv::Mat matrixOf(const Image<std::uint8_t>& picture) {
    auto* pixels = const_cast<std::uint8_t*>(picture.pixels().data());  // OpenCV reads it only
    return {picture.height(), picture.width(), CV_8U, pixels};
}

int reduction(Size size) { return std::max(1, static_cast<int>(std::lround(size.width / double{kWorkingWidth}))); }

cv::Mat reduced(const cv::Mat& grey, int by) {
    if (by == 1) return grey;
    cv::Mat small;
    cv::resize(grey, small, {grey.cols / by, grey.rows / by}, 0, 0, cv::INTER_AREA);
    return small;
}

struct Found {
    std::vector<cv::Point2f> at;  ///< whole-pixel centres, OpenCV's convention, full size
    cv::Mat bits;
};

/// Corners spread over the picture: the best of each field, so that one poster does not take all of them.
Found featuresOf(const cv::Mat& grey) {
    const int by = reduction({grey.cols, grey.rows});
    const cv::Mat small = reduced(grey, by);
    std::vector<cv::KeyPoint> corners;
    cv::FAST(small, corners, 12, true);
    constexpr int kFields = 8;
    const std::size_t each = kFeatures / (kFields * kFields) + 2;
    std::vector<std::vector<cv::KeyPoint>> fields(kFields * kFields);
    for (cv::KeyPoint& corner : corners) {
        const int column = static_cast<int>(corner.pt.x) * kFields / small.cols;
        const int row = static_cast<int>(corner.pt.y) * kFields / small.rows;
        corner.size = 31.0F;
        corner.octave = 0;
        fields[static_cast<std::size_t>(row * kFields + column)].push_back(corner);
    }
    std::vector<cv::KeyPoint> chosen;
    for (auto& field : fields) {
        const auto keep = static_cast<std::ptrdiff_t>(std::min(field.size(), each));
        std::partial_sort(field.begin(), field.begin() + keep, field.end(),
                          [](const auto& a, const auto& b) { return a.response > b.response; });
        chosen.insert(chosen.end(), field.begin(), field.begin() + keep);
    }
    Found found;
    // Upright: a camera that is bumped hardly rolls, and directions cost what they gain.
    for (cv::KeyPoint& corner : chosen)
        corner.angle = 0.0F;
    const auto orb = cv::ORB::create(kFeatures, 1.2F, 1);
    orb->compute(small, chosen, found.bits);
    for (const cv::KeyPoint& corner : chosen) {
        const float half = 0.5F * static_cast<float>(by) - 0.5F;
        found.at.emplace_back(corner.pt.x * static_cast<float>(by) + half, corner.pt.y * static_cast<float>(by) + half);
    }
    return found;
}

/// Normalised correlation of two patches, -1..1; 0 where one is even.
double correlation(const cv::Mat& a, cv::Point p, const cv::Mat& b, cv::Point q) {
    double sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
    for (int y = -kPatch; y <= kPatch; ++y) {
        const std::uint8_t *u = a.ptr(p.y + y) + p.x, *v = b.ptr(q.y + y) + q.x;
        int ra = 0, rb = 0, raa = 0, rbb = 0, rab = 0;
        for (int x = -kPatch; x <= kPatch; ++x) {
            const int i = u[x], j = v[x];
            ra += i, rb += j, raa += i * i, rbb += j * j, rab += i * j;
        }
        sa += ra, sb += rb, aa += raa, bb += rbb, ab += rab;
    }
    constexpr double n = (2 * kPatch + 1) * (2 * kPatch + 1);
    const double va = aa - sa * sa / n, vb = bb - sb * sb / n;
    return va < 1.0 || vb < 1.0 ? 0.0 : (ab - sa * sb / n) / std::sqrt(va * vb);
}

/// The patch's values with its brightness and contrast taken out: mean 0, sum of squares 1.
using Patch = std::array<double, (2 * kPatch + 1) * (2 * kPatch + 1)>;

/// False where it is even.
bool evened(Patch& patch, double& norm) {
    const double mean = std::accumulate(patch.begin(), patch.end(), 0.0) / static_cast<double>(patch.size());
    double squares = 0.0;
    for (double& v : patch)
        v -= mean, squares += v * v;
    norm = std::sqrt(squares);
    if (norm < 1.0) return false;
    for (double& v : patch)
        v /= norm;
    return true;
}

/// How far beside `q` the patch around `p` lies, by Lucas and Kanade's (1981) steps with the gradients of the patch
/// looked for. A parabola through three correlations, which would be cheaper, is drawn to whole pixels: by 0.1 to 0.2
/// at a quarter, 0.5 on the photo of a cup. Nothing where it does not come to rest within a pixel of `q`.
std::optional<cv::Point2d> beside(const cv::Mat& before, cv::Point p, const cv::Mat& now, cv::Point q) {
    Patch wanted, across, down;
    std::size_t n = 0;
    for (int y = -kPatch; y <= kPatch; ++y) {
        for (int x = -kPatch; x <= kPatch; ++x, ++n) {
            const auto at = [&](int i, int j) { return 1.0 * before.at<std::uint8_t>(p.y + y + j, p.x + x + i); };
            wanted[n] = at(0, 0);
            across[n] = 0.5 * (at(1, 0) - at(-1, 0));
            down[n] = 0.5 * (at(0, 1) - at(0, -1));
        }
    }
    double norm = 0.0;
    if (!evened(wanted, norm)) return std::nullopt;
    // What a step changes besides brightness and contrast.
    const auto freed = [&](Patch& gradient) {
        const double mean = std::accumulate(gradient.begin(), gradient.end(), 0.0) / static_cast<double>(n);
        for (double& v : gradient)
            v = (v - mean) / norm;
        const double along = std::inner_product(gradient.begin(), gradient.end(), wanted.begin(), 0.0);
        for (std::size_t i = 0; i < n; ++i)
            gradient[i] -= along * wanted[i];
    };
    freed(across), freed(down);
    const auto dot = [](const Patch& a, const Patch& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    const double xx = dot(across, across), xy = dot(across, down), yy = dot(down, down), det = xx * yy - xy * xy;
    if (!(det > 1e-6 * (xx + yy) * (xx + yy))) return std::nullopt;  // an edge: nothing says where along it
    cv::Point2d d(0.0, 0.0);
    for (int step = 0; step < 12; ++step) {
        const cv::Point whole(q.x + static_cast<int>(std::floor(d.x)), q.y + static_cast<int>(std::floor(d.y)));
        const double fx = d.x - std::floor(d.x), fy = d.y - std::floor(d.y);
        Patch seen;
        std::size_t i = 0;
        for (int y = -kPatch; y <= kPatch; ++y) {
            const std::uint8_t *u = now.ptr(whole.y + y) + whole.x, *v = now.ptr(whole.y + y + 1) + whole.x;
            for (int x = -kPatch; x <= kPatch; ++x, ++i)
                seen[i] = (1.0 - fy) * ((1.0 - fx) * u[x] + fx * u[x + 1]) + fy * ((1.0 - fx) * v[x] + fx * v[x + 1]);
        }
        double seenNorm = 0.0;
        if (!evened(seen, seenNorm)) return std::nullopt;
        for (std::size_t k = 0; k < n; ++k)
            seen[k] -= wanted[k];
        const double bx = dot(across, seen), by = dot(down, seen);
        const cv::Point2d move((yy * bx - xy * by) / det, (xx * by - xy * bx) / det);
        d -= move;
        if (!(std::abs(d.x) < 1.0 && std::abs(d.y) < 1.0)) return std::nullopt;
        if (std::abs(move.x) < 0.005 && std::abs(move.y) < 0.005) return d;
    }
    return std::nullopt;
}

/// Where the patch around `from` lies near `to`, to a fraction of a pixel; nothing where it does not look alike.
std::optional<cv::Point2f> refined(const cv::Mat& before, cv::Point2f from, const cv::Mat& now, cv::Point2f to) {
    const cv::Point p(cvRound(from.x), cvRound(from.y)), q(cvRound(to.x), cvRound(to.y));
    const int rim = kPatch + kLook + 2;
    const auto inside = [&](cv::Point at, const cv::Mat& of) {
        return at.x >= rim && at.y >= rim && at.x < of.cols - rim && at.y < of.rows - rim;
    };
    if (!inside(p, before) || !inside(q, now)) return std::nullopt;
    cv::Point best = q;
    double most = -1.0;
    for (int dy = -kLook; dy <= kLook; ++dy) {
        for (int dx = -kLook; dx <= kLook; ++dx) {
            const double c = correlation(before, p, now, q + cv::Point(dx, dy));
            if (c > most) most = c, best = q + cv::Point(dx, dy);
        }
    }
    if (most < 0.7) return std::nullopt;
    const auto rest = beside(before, p, now, best);
    if (!rest) return std::nullopt;
    return cv::Point2f(static_cast<float>(best.x + rest->x) + (from.x - static_cast<float>(p.x)),
                       static_cast<float>(best.y + rest->y) + (from.y - static_cast<float>(p.y)));
}

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// OpenCV's homography between whole-pixel centres as one between this program's points.
Homography<CameraFrame, CameraFrame> shifted(const cv::Matx33d& h) {
    const cv::Matx33d on(1, 0, 0.5, 0, 1, 0.5, 0, 0, 1), off(1, 0, -0.5, 0, 1, -0.5, 0, 0, 1);
    const cv::Matx33d m = on * h * off;
    Homography<CameraFrame, CameraFrame> out;
    std::copy(m.val, m.val + 9, out.m.begin());
    return out;
}

double apart(cv::Point2f a, cv::Point2f b) { return std::hypot(double{a.x} - double{b.x}, double{a.y} - double{b.y}); }

/// Pairs of points of two pictures that look alike.
struct Pairs {
    std::vector<cv::Point2f> from, to;
};

/// Whether a motion is one that a bumped camera makes: hardly any change of size or shape.
bool plausible(const cv::Matx33d& h) {
    const double area = h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0);
    return std::isfinite(area) && area > 0.5 && area < 2.0 && std::abs(h(2, 0)) < 1e-3 && std::abs(h(2, 1)) < 1e-3;
}

}  // namespace

struct BumpAlarm::Features {
    Image<std::uint8_t> picture;
    Found found;
};

Result<BumpAlarm> BumpAlarm::of(const Image<std::uint8_t>& reference) {
    if (reference.channels() != 1 || reference.width() < 64 || reference.height() < 64) {
        return fail(Fault::outOfRange, "The bump alarm needs a grey picture of at least 64 x 64 pixels.");
    }
    try {
        auto features = std::make_shared<Features>();
        features->picture = reference;
        features->found = featuresOf(matrixOf(reference));
        if (static_cast<int>(features->found.at.size()) < kFewest) {
            return fail(Fault::unsupported,
                        "The picture has too few corners to notice a bump by: put something printed into the scene.");
        }
        return BumpAlarm(std::move(features));
    } catch (const cv::Exception& e) {
        return fail(Fault::unsupported, "No features could be found in the picture: " + e.err + ".");
    }
}

Result<BumpReport> BumpAlarm::compared(const Image<std::uint8_t>& picture) const {
    const Features& before = *reference_;
    if (picture.size() != before.picture.size() || picture.channels() != 1) {
        return fail(Fault::outOfRange,
                    "The camera's picture has another size than when the bump alarm was set: register "
                    "again, or choose the old size.");
    }
    try {
        const cv::Mat old = matrixOf(before.picture), now = matrixOf(picture);
        BumpReport report;
        report.features = static_cast<int>(before.found.at.size());
        std::vector<bool> placed(before.found.at.size(), false);
        std::size_t stayed = 0, together = 0;
        std::vector<double> ways;
        // First those that are where they were: cheap, and all of them on a quiet day.
        for (std::size_t i = 0; i < placed.size(); ++i) {
            const cv::Point2f at = before.found.at[i];
            const auto again = refined(old, at, now, at);
            if (!again || apart(*again, at) > kStays) continue;
            placed[i] = true;
            ++stayed;
            ways.push_back(apart(*again, at));
        }
        Pairs pairs;
        if (stayed < placed.size() * 7 / 10) {
            const Found found = featuresOf(now);
            std::vector<cv::DMatch> matches;
            if (!found.at.empty()) cv::BFMatcher(cv::NORM_HAMMING, true).match(before.found.bits, found.bits, matches);
            for (const cv::DMatch& match : matches) {
                const auto i = static_cast<std::size_t>(match.queryIdx), j = static_cast<std::size_t>(match.trainIdx);
                if (placed[i] || match.distance > static_cast<float>(kMostBits)) continue;
                pairs.from.push_back(before.found.at[i]);
                pairs.to.push_back(found.at[j]);
            }
        }
        cv::Matx33d motion = cv::Matx33d::eye();
        constexpr std::size_t kLeastPairs = 12;
        if (pairs.from.size() >= kLeastPairs) {
            const cv::Mat rough = cv::findHomography(pairs.from, pairs.to, cv::RANSAC, kFollows, cv::noArray(), 1000);
            Pairs fine;
            if (!rough.empty()) {
                std::vector<cv::Point2f> expected;
                cv::perspectiveTransform(pairs.from, expected, rough);
                for (std::size_t i = 0; i < pairs.from.size(); ++i) {
                    if (apart(expected[i], pairs.to[i]) > kFollows) continue;
                    const auto at = refined(old, pairs.from[i], now, expected[i]);
                    if (!at) continue;
                    fine.from.push_back(pairs.from[i]);
                    fine.to.push_back(*at);
                }
            }
            if (fine.from.size() >= kLeastPairs) {
                const cv::Mat better = cv::findHomography(fine.from, fine.to, cv::RANSAC, 1.0, cv::noArray(), 1000);
                if (!better.empty()) motion = better;
                if (!better.empty() && plausible(motion)) {
                    together = fine.from.size();
                    for (std::size_t i = 0; i < fine.from.size(); ++i)
                        ways.push_back(apart(fine.from[i], fine.to[i]));
                }
            }
        }
        const auto all = static_cast<double>(report.features);
        report.found = static_cast<double>(stayed + together) / all;
        report.stayed =
            stayed + together == 0 ? 0.0 : static_cast<double>(stayed) / static_cast<double>(stayed + together);
        report.moved_px = median(ways);
        constexpr double kEnough = 0.15, kMostlyMoved = 0.4;
        report.blind = report.found < kEnough;
        report.bumped = !report.blind && report.stayed < kMostlyMoved && report.moved_px > kStays;
        if (report.bumped) report.newFromOld = shifted(motion);
        return report;
    } catch (const cv::Exception& e) {
        return fail(Fault::unsupported, "The camera's picture could not be compared: " + e.err + ".");
    }
}

Registration afterBump(const Registration& registration, const Homography<CameraFrame, CameraFrame>& newFromOld) {
    Registration after = registration;
    const Size picture = registration.map.dense() ? registration.map.dense()->camera() : registration.camera.picture;
    after.map = remapped(registration.map, newFromOld.inverted(), picture);
    return after;
}

}  // namespace ilf
