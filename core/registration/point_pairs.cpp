#include "core/registration/point_pairs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "core/base/as_text.h"

namespace ilf {

namespace {

using Plane = Homography<ProjectorFrame, CameraFrame>;

/// A pair is left out when it lies this many times farther off than the others would let it, and by pixels anybody
/// would see.
constexpr double kOutlier = 4.0;
constexpr double kOutlier_px = 3.0;
/// Pairs of a flat scene that are off by more than this share of the raster's diagonal do not belong together.
constexpr double kMostOff = 0.01;

Error refusedPairs(const std::string& what) { return {Fault::outOfRange, what}; }

/// The least squared distance on the raster over the used pairs; nothing where they do not tell a homography.
std::optional<Plane> planeOf(std::span<const PointPair> pairs, const std::vector<bool>& used) {
    std::vector<cv::Point2d> from, to;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!used[i]) continue;
        from.emplace_back(pairs[i].camera.x, pairs[i].camera.y);
        to.emplace_back(pairs[i].projector.x, pairs[i].projector.y);
    }
    try {
        const cv::Mat h = cv::findHomography(from, to, 0);
        if (h.empty()) return std::nullopt;
        Plane plane;
        std::copy(h.begin<double>(), h.end<double>(), plane.m.begin());
        const bool finite = std::ranges::all_of(plane.m, [](double v) { return std::isfinite(v); });
        return finite && std::abs(plane.determinant()) > 1e-12 ? std::optional(plane) : std::nullopt;
    } catch (const cv::Exception&) {
        return std::nullopt;
    }
}

std::vector<double> residuals(const Plane& plane, std::span<const PointPair> pairs) {
    std::vector<double> off;
    for (const PointPair& pair : pairs) {
        const auto there = plane(pair.camera);
        off.push_back(std::hypot(there.x - pair.projector.x, there.y - pair.projector.y));
    }
    return off;
}

/// The rms of the used pairs with the homography's eight numbers counted, as another pair would be off.
double expected_px(const std::vector<double>& off, const std::vector<bool>& used) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < off.size(); ++i)
        if (used[i]) sum += off[i] * off[i], ++count;
    return count > 4 ? std::sqrt(sum / (count - 4)) : 0.0;
}

/// Whether all of the points but one lie on a line: then no homography is told by them.
template <class Points>
bool onLine(const Points& points) {
    for (std::size_t without = 0; without < points.size(); ++without) {
        double mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
        const double n = static_cast<double>(points.size() - 1);
        for (std::size_t i = 0; i < points.size(); ++i)
            if (i != without) mx += points[i].x / n, my += points[i].y / n;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (i == without) continue;
            const double x = points[i].x - mx, y = points[i].y - my;
            xx += x * x, xy += x * y, yy += y * y;
        }
        const double spread = std::hypot(xx - yy, 2.0 * xy);
        const double wide = 0.5 * (xx + yy + spread), narrow = 0.5 * (xx + yy - spread);
        if (!(narrow > 4e-4 * wide) || wide < 1e-6) return true;  // a fiftieth as wide as long
    }
    return false;
}

/// How the plane's way turns areas at a point: negative where it mirrors.
double turn(const Plane& plane, Point<CameraFrame> at) {
    const auto here = plane(at), right = plane({at.x + 1.0, at.y}), down = plane({at.x, at.y + 1.0});
    return (right.x - here.x) * (down.y - here.y) - (right.y - here.y) * (down.x - here.x);
}

const char* const kMirrored =
    "The points are mirrored: the picture's right is the projector's left. Check the order of the points, and whether "
    "the projector or the camera is set to mirror its picture.";

Result<void> sensible(const Plane& plane, std::span<const PointPair> pairs, const std::vector<bool>& used) {
    double sign = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!used[i]) continue;
        const auto& m = plane.m;
        const double w = m[6] * pairs[i].camera.x + m[7] * pairs[i].camera.y + m[8];
        if (sign * w < 0.0) {
            return tl::unexpected(refusedPairs("The points are folded: no view of a flat surface puts them where they "
                                               "are. Check the order of the points."));
        }
        sign = w;
        if (turn(plane, pairs[i].camera) < 0.0) return tl::unexpected(refusedPairs(kMirrored));
    }
    return {};
}

PairedRegistration registrationOf(const Plane& plane, std::span<const PointPair> pairs, std::vector<bool> used,
                                  Size camera, Size projector, Registration::Method method) {
    PairedRegistration out;
    out.residual_px = residuals(plane, pairs);
    out.used = std::move(used);
    double sum = 0.0;
    Registration& r = out.registration;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (out.worst < 0 || out.residual_px[i] > out.residual_px[static_cast<std::size_t>(out.worst)])
            out.worst = static_cast<int>(i);
        if (!out.used[i]) continue;
        sum += out.residual_px[i] * out.residual_px[i], ++r.points;
        r.worst_px = std::max(r.worst_px, out.residual_px[i]);
    }
    r.rms_px = std::sqrt(sum / r.points);
    r.map = PixelMap(plane);
    r.camera.picture = camera;
    r.projector = projector;
    r.method = method;
    return out;
}

/// The pair whose leaving makes the others fit so much better that it must be wrong.
std::optional<std::size_t> wrongPair(std::span<const PointPair> pairs, const std::vector<bool>& used) {
    std::optional<std::size_t> wrong;
    double worst = kOutlier;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!used[i]) continue;
        std::vector<bool> others = used;
        others[i] = false;
        const auto plane = planeOf(pairs, others);
        if (!plane) continue;
        const auto off = residuals(*plane, pairs);
        const double share = off[i] / std::max(expected_px(off, others), 0.25 * kOutlier_px);
        if (off[i] > kOutlier_px && share > worst) wrong = i, worst = share;
    }
    return wrong;
}

}  // namespace

Result<PairedRegistration> registeredByCorners(const std::array<Point<CameraFrame>, 4>& corners, Size camera,
                                               Size projector) {
    static constexpr std::array<const char*, 4> kNames{"upper left", "upper right", "lower right", "lower left"};
    // At each corner, twice the area of the triangle with both neighbours; positive where it turns as a raster does.
    std::array<double, 4> area{};
    double all = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto &before = corners[(i + 3) % 4], &at = corners[i], &next = corners[(i + 1) % 4];
        area[i] = (at.x - before.x) * (next.y - at.y) - (at.y - before.y) * (next.x - at.x);
        if (!std::isfinite(area[i])) return tl::unexpected(refusedPairs("A corner's place is not a number."));
        all += 0.5 * std::abs(area[i]);
    }
    const auto turned = std::ranges::count_if(area, [](double a) { return a < 0.0; });
    const auto least = std::ranges::min_element(area, {}, [](double a) { return std::abs(a); }) - area.begin();
    if (std::abs(area[static_cast<std::size_t>(least)]) < std::max(16.0, 1e-3 * all)) {
        return tl::unexpected(refusedPairs("The " + std::string(kNames[static_cast<std::size_t>(least)]) +
                                           " corner lies on a line with its neighbours, or on one of them: drag it to "
                                           "where the raster's corner is seen."));
    }
    if (turned == 4) return tl::unexpected(refusedPairs(kMirrored));
    if (turned == 2) {
        return tl::unexpected(refusedPairs("The corners' outline crosses itself: two of them are exchanged. They run "
                                           "upper left, upper right, lower right, lower left."));
    }
    if (turned != 0) {
        const auto odd = std::ranges::find_if(area, [&](double a) { return turned == 1 ? a < 0.0 : a > 0.0; });
        return tl::unexpected(refusedPairs("The " + std::string(kNames[static_cast<std::size_t>(odd - area.begin())]) +
                                           " corner is folded in behind the other three: drag it out to where the "
                                           "raster's corner is seen."));
    }
    const double w = projector.width, h = projector.height;
    const std::array<PointPair, 4> pairs{
        {{corners[0], {0, 0}}, {corners[1], {w, 0}}, {corners[2], {w, h}}, {corners[3], {0, h}}}};
    const std::vector<bool> used(4, true);
    const auto plane = planeOf(pairs, used);
    if (!plane) return tl::unexpected(refusedPairs("The four corners do not give a map: drag them farther apart."));
    if (const auto good = sensible(*plane, pairs, used); !good) return tl::unexpected(good.error());
    return registrationOf(*plane, pairs, used, camera, projector, Registration::Method::corners);
}

Result<PairedRegistration> registeredByPairs(std::span<const PointPair> pairs, Size camera, Size projector) {
    if (pairs.size() < 4) {
        return tl::unexpected(refusedPairs(std::to_string(pairs.size()) +
                                           " point pairs are too few: a flat surface takes four, far apart; with five "
                                           "or more their residuals tell how good they are."));
    }
    std::vector<Point<CameraFrame>> seen;
    std::vector<Point<ProjectorFrame>> lit;
    for (const PointPair& pair : pairs)
        seen.push_back(pair.camera), lit.push_back(pair.projector);
    if (onLine(seen) || onLine(lit)) {
        return tl::unexpected(
            refusedPairs("The points lie on one line (all, or all but one): add pairs away from it."));
    }
    std::vector<bool> used(pairs.size(), true);
    std::string left;
    // Below five others nothing tells which pair is wrong; more than a third wrong means that nothing is known.
    const auto keep = std::max<std::size_t>(5, (2 * pairs.size() + 2) / 3);
    for (std::size_t count = pairs.size(); count > keep; --count) {
        const auto wrong = wrongPair(pairs, used);
        if (!wrong) break;
        used[*wrong] = false;
        left += (left.empty() ? "" : ", ") + std::to_string(*wrong + 1);
    }
    const auto plane = planeOf(pairs, used);
    if (!plane) return tl::unexpected(refusedPairs("The points do not give a map: add pairs far from each other."));
    if (const auto good = sensible(*plane, pairs, used); !good) return tl::unexpected(good.error());
    auto out = registrationOf(*plane, pairs, used, camera, projector, Registration::Method::pointPairs);
    const double off = expected_px(out.residual_px, used);
    if (off > kMostOff * std::hypot(projector.width, projector.height)) {
        return tl::unexpected(refusedPairs("The pairs do not fit each other (" + asText("%.0f", off) + " px): pair " +
                                           std::to_string(out.worst + 1) +
                                           " fits worst. Set it again, or scan: the scene may not be flat."));
    }
    if (!left.empty()) out.note = "Left out, as they do not fit the others: pair " + left + ".";
    if (left.empty() && pairs.size() == 4) out.note = "Four pairs always fit: a fifth one tells how good they are.";
    return out;
}

}  // namespace ilf
