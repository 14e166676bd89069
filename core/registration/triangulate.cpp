#include "core/registration/triangulate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/as_text.h"
#include "core/base/parallel.h"

namespace ilf {

namespace {

/// Slopes of a pinhole's rays at the nodes of a lattice; bilinear between them. Distortion bends slopes by k r^2, so
/// over a cell of 4 px the error stays below a hundredth of a pixel for any lens a scan is made with.
class SlopeTable {
public:
    static constexpr int kCell = 4;

    explicit SlopeTable(const Pinhole& pinhole)
        : columns_(pinhole.size.width / kCell + 2), rows_(pinhole.size.height / kCell + 2),
          slopes_(2 * static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
        parallelFor(rows_, [&](int row) {
            for (int column = 0; column < columns_; ++column) {
                const double x = column * kCell, y = row * kCell;
                const auto slopes = pinhole.slopesOf(x, y);
                const auto back = pinhole.pixelOf(slopes[0], slopes[1]);
                // Beyond where the model of the lens can be undone there is no ray.
                const bool good = std::hypot(back[0] - x, back[1] - y) < 0.01;
                const std::size_t at = 2 * index(column, row);
                slopes_[at] = good ? slopes[0] : std::numeric_limits<double>::quiet_NaN();
                slopes_[at + 1] = good ? slopes[1] : std::numeric_limits<double>::quiet_NaN();
            }
        });
    }

    /// NaN outside the raster (a margin of a cell is continued).
    std::array<double, 2> at(double x, double y) const {
        const double u = x / kCell, v = y / kCell;
        if (!(u > -1.0 && v > -1.0 && u < columns_ && v < rows_)) return {std::nan(""), std::nan("")};
        const int i = std::clamp(static_cast<int>(u), 0, columns_ - 2),
                  j = std::clamp(static_cast<int>(v), 0, rows_ - 2);
        const double a = u - i, b = v - j;
        const double* top = &slopes_[2 * index(i, j)];
        const double* bottom = &slopes_[2 * index(i, j + 1)];
        const double w00 = (1.0 - a) * (1.0 - b), w10 = a * (1.0 - b), w01 = (1.0 - a) * b, w11 = a * b;
        return {w00 * top[0] + w10 * top[2] + w01 * bottom[0] + w11 * bottom[2],
                w00 * top[1] + w10 * top[3] + w01 * bottom[1] + w11 * bottom[3]};
    }

private:
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    int columns_, rows_;
    std::vector<double> slopes_;
};

/// What is the same for every pixel.
struct Geometry {
    const ProcamCalibration& calibration;
    SlopeTable camera, projector;
    double match2, projector2, camera2;  ///< squared deviations, pixels
    double common2;                      ///< squared share of depth

    Geometry(const ProcamCalibration& c, const TriangulateOptions& options)
        : calibration(c), camera(c.camera), projector(c.projector), match2(options.match_px * options.match_px),
          projector2(0.5 * c.projectorRms_px * c.projectorRms_px), camera2(0.5 * c.cameraRms_px * c.cameraRms_px),
          common2(options.common * options.common) {}
};

struct Measured {
    double z = 0.0, sigma = 0.0, miss_px = 0.0, missSigma_px = 0.0;
};

/// Without a depth z is NaN or not positive.
Measured measuredAt(const Geometry& g, int x, int y, double px, double py) {
    const auto& r = g.calibration.projectorFromCamera.rotation;
    const auto& t = g.calibration.projectorFromCamera.translation;
    const Pinhole& projector = g.calibration.projector;
    const auto [a, b] = g.camera.at(x + 0.5, y + 0.5);
    const auto [u, v] = g.projector.at(px, py);
    // A point at depth z lies at z q + t before the projector.
    const double qx = r[0] * a + r[1] * b + r[2], qy = r[3] * a + r[4] * b + r[5], qz = r[6] * a + r[7] * b + r[8];
    // In pixels times the point's depth: z slopes - offsets = 0, for x and for y.
    const double ax = projector.fx * (qx - u * qz), ay = projector.fy * (qy - v * qz);
    const double bx = projector.fx * (u * t[2] - t[0]), by = projector.fy * (v * t[2] - t[1]);
    Measured m;
    const double aa = ax * ax + ay * ay;
    m.z = (ax * bx + ay * by) / aa;
    const double before = m.z * qz + t[2];  // its depth from the projector
    if (!(before > 0.0)) m.z = std::nan("");
    m.miss_px = (ax * by - ay * bx) / (std::sqrt(aa) * before);
    // The raster's pixels that one pixel of the camera covers, by the ratio of what a pixel of each spans there.
    const double cover = projector.fx * m.z / (g.calibration.camera.fx * before);
    const double px2 = g.match2 + g.projector2 + cover * cover * g.camera2;
    m.missSigma_px = std::sqrt(px2);
    m.sigma = std::sqrt(px2 * before * before / aa + g.common2 * m.z * m.z);
    return m;
}

struct Row {
    int measured = 0, missed = 0;
    double miss2 = 0.0;
};

Result<void> comparable(Size camera, Size projector, const ProcamCalibration& c) {
    const auto spoken = [](Size s) { return std::to_string(s.width) + " x " + std::to_string(s.height); };
    if (camera != c.camera.size) {
        return fail(Fault::outOfRange, "The scan's pictures are " + spoken(camera) +
                                           " pixels and the calibration is for " + spoken(c.camera.size) +
                                           ": use the camera mode it was calibrated in, or calibrate again.");
    }
    if (projector != c.projector.size) {
        return fail(Fault::outOfRange, "The scan was made on a raster of " + spoken(projector) +
                                           " pixels and the calibration is for " + spoken(c.projector.size) + ".");
    }
    return {};
}

template <class Known>
Result<Triangulated> triangulatedWhere(const Known& known, const Image<float>& places, Size projector,
                                       const ProcamCalibration& calibration, const TriangulateOptions& options) {
    if (const auto good = comparable(places.size(), projector, calibration); !good) return tl::unexpected(good.error());
    const auto& t = calibration.projectorFromCamera.translation;
    const double baseline = std::hypot(t[0], t[1], t[2]);
    // At a metre, a shorter one than this turns a quarter of a pixel into more than a tenth of the depth.
    const double least = 2.5 / std::max(1.0, calibration.projector.fx);
    if (!(baseline >= least)) {
        return fail(Fault::outOfRange, "Camera and projector are " + asText("%.1f", 1e3 * baseline) +
                                           " mm apart: too near each other to measure depth. Put them " +
                                           asText("%.0f", std::ceil(1e2 * std::max(0.1, 10.0 * least))) +
                                           " cm apart or more and calibrate again.");
    }
    const Geometry geometry(calibration, options);
    const Size size = places.size();
    const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    std::vector<float> depth(pixels, 0.0f), sigma(pixels, 0.0f), miss(pixels, std::numeric_limits<float>::quiet_NaN());
    std::vector<Row> rows(static_cast<std::size_t>(size.height));
    parallelFor(size.height, [&](int y) {
        const float* row = places.row(y);
        const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width);
        Row& sum = rows[static_cast<std::size_t>(y)];
        for (int x = 0; x < size.width; ++x) {
            if (!known(x, y)) continue;
            const Measured m =
                measuredAt(geometry, x, y, static_cast<double>(row[2 * x]), static_cast<double>(row[2 * x + 1]));
            const std::size_t at = first + static_cast<std::size_t>(x);
            miss[at] = static_cast<float>(m.miss_px);
            const double most = options.furthestMiss_px > 0.0 ? options.furthestMiss_px : 4.0 * m.missSigma_px;
            if (!(std::abs(m.miss_px) <= most && m.z >= options.nearest.si() && m.z <= options.farthest.si())) {
                ++sum.missed;
                continue;
            }
            depth[at] = static_cast<float>(m.z);
            sigma[at] = static_cast<float>(m.sigma);
            ++sum.measured;
            sum.miss2 += m.miss_px * m.miss_px;
        }
    });
    Triangulated out;
    double miss2 = 0.0;
    for (const Row& row : rows)
        out.measured += row.measured, out.missed += row.missed, miss2 += row.miss2;
    if (out.measured == 0 || out.measured < out.missed) {
        return fail(Fault::outOfRange, "Of " + std::to_string(out.measured + out.missed) + " decoded pixels only " +
                                           std::to_string(out.measured) +
                                           " have rays that meet within reach: the calibration is not of this camera "
                                           "and projector as they stand now. Calibrate again.");
    }
    out.missRms_px = std::sqrt(miss2 / out.measured);
    out.depth.metres = Image<float>(size, 1, std::move(depth));
    out.depth.sigma = Image<float>(size, 1, std::move(sigma));
    out.depth.camera = calibration.camera;
    out.depth.source = "scan";
    out.depth.provenance = calibration.provenance;
    out.miss_px = Image<float>(size, 1, std::move(miss));
    return out;
}

}  // namespace

Result<Triangulated> triangulated(const DecodedScan& decoded, const ProcamCalibration& calibration,
                                  const TriangulateOptions& options) {
    return triangulatedWhere([&](int x, int y) { return decoded.confidence.at(x, y) != 0; }, decoded.projectorOfCamera,
                             decoded.projector, calibration, options);
}

Result<Triangulated> triangulated(const DenseMap& map, const ProcamCalibration& calibration,
                                  const TriangulateOptions& options) {
    return triangulatedWhere([&](int x, int y) { return map.confidence.at(x, y) != 0; }, map.projectorOfCamera,
                             map.projector(), calibration, options);
}

}  // namespace ilf
