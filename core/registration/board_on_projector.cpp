#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "core/base/as_text.h"
#include "core/base/parallel.h"
#include "core/registration/board.h"

namespace ilf {

namespace {

/// A decoded pixel near a corner: from the corner in window radii, and on the raster.
struct Near {
    double x, y;
    cv::Point2d there;
};

/// What a window may hold at most: more pixels only take time.
constexpr int kMostPixels = 2500;
/// Far from a wrong bit's 2 px or more, well above a decoder's noise.
constexpr double kWrong_px = 1.5;

/// Distance to the nearest other corner, in camera pixels.
double nearestOther(const std::vector<Point<CameraFrame>>& corners, std::size_t i) {
    double nearest = 1e9;
    for (std::size_t j = 0; j < corners.size(); ++j) {
        if (j != i) nearest = std::min(nearest, std::hypot(corners[j].x - corners[i].x, corners[j].y - corners[i].y));
    }
    return nearest;
}

std::vector<Near> decodedAround(const DecodedScan& decoded, Point<CameraFrame> corner, double radius) {
    const auto& map = decoded.projectorOfCamera;
    const int x0 = std::max(0, static_cast<int>(corner.x - radius)),
              x1 = std::min(map.width() - 1, static_cast<int>(corner.x + radius));
    const int y0 = std::max(0, static_cast<int>(corner.y - radius)),
              y1 = std::min(map.height() - 1, static_cast<int>(corner.y + radius));
    const double area = std::max(0, x1 - x0 + 1) * std::max(0, y1 - y0 + 1);
    const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(area / kMostPixels))));
    std::vector<Near> near;
    for (int y = y0; y <= y1; y += step) {
        const float* row = map.row(y);
        for (int x = x0; x <= x1; x += step) {
            if (decoded.confidence.at(x, y) == 0) continue;
            near.push_back({(x + 0.5 - corner.x) / radius,
                            (y + 0.5 - corner.y) / radius,
                            {static_cast<double>(row[2 * x]), static_cast<double>(row[2 * x + 1])}});
        }
    }
    return near;
}

/// Whether the pixels lie around the corner, so that nothing is continued beyond them: their mean near it, their spread
/// wide both ways. White squares on two opposite sides are enough.
bool surrounds(const std::vector<Near>& near) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (const Near& n : near)
        sx += n.x, sy += n.y, sxx += n.x * n.x, sxy += n.x * n.y, syy += n.y * n.y;
    const double count = static_cast<double>(near.size()), mx = sx / count, my = sy / count;
    const double a = sxx / count - mx * mx, b = sxy / count - mx * my, c = syy / count - my * my;
    const double least = 0.5 * (a + c - std::hypot(a - c, 2.0 * b));
    return std::hypot(mx, my) < 0.5 && least > 0.05;
}

struct Fit {
    cv::Matx33d h;
    double rms_px = 0.0;
    int count = 0;
};

/// A homography by weighted least squares, again and again with Tukey's weights: wrong codes end with weight 0.
std::optional<Fit> fitted(const std::vector<Near>& near) {
    std::vector<cv::Point2d> from, to;
    for (const Near& n : near)
        from.emplace_back(n.x, n.y), to.push_back(n.there);
    cv::Mat start = cv::findHomography(from, to, cv::RANSAC, kWrong_px, cv::noArray(), 500, 0.99);
    if (start.empty()) return std::nullopt;
    Fit fit;
    fit.h = cv::Matx33d(start);
    const cv::Point2d middle(fit.h(0, 2), fit.h(1, 2));
    double scale_px = kWrong_px;
    for (int round = 0; round < 6; ++round) {
        // Around the middle, so that the equations are well conditioned.
        cv::Matx<double, 8, 8> normal = cv::Matx<double, 8, 8>::zeros();
        cv::Matx<double, 8, 1> right = cv::Matx<double, 8, 1>::zeros();
        std::vector<double> off;
        double sum = 0.0;
        fit.count = 0;
        for (const Near& n : near) {
            const double w = fit.h(2, 0) * n.x + fit.h(2, 1) * n.y + 1.0;
            const double u = n.there.x - middle.x, v = n.there.y - middle.y;
            const double ex = (fit.h(0, 0) * n.x + fit.h(0, 1) * n.y + fit.h(0, 2)) / w - n.there.x;
            const double ey = (fit.h(1, 0) * n.x + fit.h(1, 1) * n.y + fit.h(1, 2)) / w - n.there.y;
            const double e = std::hypot(ex, ey);
            const double k = e / (3.0 * scale_px);
            if (k >= 1.0) continue;
            off.push_back(e);
            sum += e * e, ++fit.count;
            const double weight = (1.0 - k * k) * (1.0 - k * k) / (w * w);
            const cv::Matx<double, 8, 1> rx(n.x, n.y, 1, 0, 0, 0, -u * n.x, -u * n.y);
            const cv::Matx<double, 8, 1> ry(0, 0, 0, n.x, n.y, 1, -v * n.x, -v * n.y);
            normal += weight * (rx * rx.t() + ry * ry.t());
            right += weight * (u * rx + v * ry);
        }
        if (fit.count < 16) return std::nullopt;
        fit.rms_px = std::sqrt(sum / fit.count);
        bool good = true;
        const cv::Matx<double, 8, 1> h = normal.solve(right, cv::DECOMP_CHOLESKY);
        for (int i = 0; i < 8; ++i)
            good = good && std::isfinite(h(i));
        if (!good || h == cv::Matx<double, 8, 1>::zeros()) return std::nullopt;
        fit.h = cv::Matx33d(h(0) + middle.x * h(6), h(1) + middle.x * h(7), h(2) + middle.x,  //
                            h(3) + middle.y * h(6), h(4) + middle.y * h(7), h(5) + middle.y, h(6), h(7), 1.0);
        std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
        scale_px = std::clamp(1.2 * off[off.size() / 2], 0.1, kWrong_px);
    }
    return fit;
}

}  // namespace

Result<BoardView> boardView(std::vector<Point<CameraFrame>> corners, const DecodedScan& decoded, const Board& board,
                            const std::string& name) {
    if (const auto good = checked(board); !good) return tl::unexpected(good.error());
    if (corners.size() != static_cast<std::size_t>(board.columns) * static_cast<std::size_t>(board.rows)) {
        return fail(Fault::outOfRange, name + ": the board has " + std::to_string(board.columns * board.rows) +
                                           " corners, and " + std::to_string(corners.size()) + " were given.");
    }
    BoardView view;
    view.name = name;
    view.camera = decoded.projectorOfCamera.size();
    view.projector = decoded.projector;
    view.inCamera = std::move(corners);
    view.onProjector.resize(view.inCamera.size());
    std::vector<std::optional<Fit>> fits(view.inCamera.size());
    try {
        parallelFor(static_cast<int>(view.inCamera.size()), [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            // Four squares, two of them white; the wider, the less the lens's bending is a homography's.
            const double radius = std::clamp(0.7 * nearestOther(view.inCamera, at), 6.0, 40.0);
            const std::vector<Near> near = decodedAround(decoded, view.inCamera[at], radius);
            if (near.size() < 40 || !surrounds(near)) return;
            fits[at] = fitted(near);
            // Half of the window wrong: it looks at something else.
            if (fits[at] && 2 * fits[at]->count < static_cast<int>(near.size())) fits[at].reset();
        });
    } catch (const cv::Exception& e) {
        return fail(Fault::badFile, name + ": placing the corners on the projector failed: " + std::string(e.what()));
    }
    double sum = 0.0, count = 0.0;
    std::size_t placed = 0;
    for (std::size_t i = 0; i < fits.size(); ++i) {
        if (!fits[i]) continue;
        view.onProjector[i] = Point<ProjectorFrame>{fits[i]->h(0, 2), fits[i]->h(1, 2)};
        sum += fits[i]->rms_px * fits[i]->rms_px * fits[i]->count, count += fits[i]->count;
        ++placed;
    }
    if (2 * placed < fits.size()) {
        return fail(Fault::notFound, name + ": the scan says where only " + std::to_string(placed) +
                                         " of the board's " + std::to_string(fits.size()) +
                                         " corners lie on the projector. The board must be wholly lit by the projector "
                                         "and its black must not be too dark for the camera: expose longer.");
    }
    view.decoded_px = std::sqrt(sum / count);
    return view;
}

Result<BoardView> boardView(const Image<std::uint8_t>& white, const DecodedScan& decoded, const Board& board,
                            const std::string& name) {
    if (white.size() != decoded.projectorOfCamera.size()) {
        return fail(Fault::badFile, name + ": the white picture and the scan have different sizes.");
    }
    return boardCorners(white, board, name).and_then([&](std::vector<Point<CameraFrame>> corners) {
        return boardView(std::move(corners), decoded, board, name);
    });
}

}  // namespace ilf
