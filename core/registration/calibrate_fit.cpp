#include "core/registration/calibrate_fit.h"

#include <cmath>
#include <opencv2/calib3d.hpp>

namespace ilf::fit {

namespace {

/// Residuals beyond this many noises count linearly (Huber), so that one wrong corner does not move everything.
constexpr double kHuber = 4.0;

cv::Vec3d rotationOf(const Motion& m) { return {m[0], m[1], m[2]}; }
cv::Vec3d translationOf(const Motion& m) { return {m[3], m[4], m[5]}; }

/// Which of the numbers are unknown, and where each stands in the equations: camera, projector, motion, poses.
struct Layout {
    std::array<std::vector<int>, 2> lens;  ///< indices into Lens
    int motion = -1, firstPose = 0, count = 0;
    std::array<int, 2> lensAt{};

    explicit Layout(const Problem& problem) {
        // In the order in which terms are let in.
        constexpr std::array<int, 5> kTerms{4, 5, 6, 7, 8};
        for (std::size_t d = 0; d < (problem.withProjector() ? 2U : 1U); ++d) {
            lens[d] = {0, 1, 2, 3};
            lens[d].insert(lens[d].end(), kTerms.begin(), kTerms.begin() + problem.terms[d]);
            lensAt[d] = count;
            count += static_cast<int>(lens[d].size());
        }
        if (problem.withProjector()) motion = count, count += 6;
        firstPose = count;
        count += 6 * problem.poses();
    }
};

struct Equations {
    cv::Mat normal, right;  ///< J^T W J and J^T W r
    double cost = 0.0;
};

double& number(Numbers& n, const Layout& layout, int at) {
    for (std::size_t d = 0; d < 2; ++d) {
        const int k = at - layout.lensAt[d];
        if (k >= 0 && k < static_cast<int>(layout.lens[d].size()))
            return n.lens[d][static_cast<std::size_t>(layout.lens[d][static_cast<std::size_t>(k)])];
    }
    if (at < layout.firstPose) return n.projectorFromCamera[static_cast<std::size_t>(at - layout.motion)];
    const int k = at - layout.firstPose;
    return n.cameraFromBoard[static_cast<std::size_t>(k / 6)][static_cast<std::size_t>(k % 6)];
}

/// One device's sightings of one pose, projected.
struct Projected {
    std::vector<cv::Point2d> at;
    cv::Mat jacobian;                        ///< OpenCV's: rotation, translation, f, c, distortion
    cv::Mat rByPoseR, rByPoseT, rByR, rByT;  ///< of the composed motion
    cv::Mat tByPoseR, tByPoseT, tByR, tByT;
};

Projected projected(const Problem& problem, const Numbers& n, std::size_t device, std::size_t pose, bool derivatives) {
    std::vector<cv::Point3d> points;
    for (const Sighting& s : problem.seen[device][pose]) {
        const auto& c = problem.corners[static_cast<std::size_t>(s.corner)];
        points.emplace_back(c.x, c.y, c.z);
    }
    Projected out;
    cv::Mat r(rotationOf(n.cameraFromBoard[pose])), t(translationOf(n.cameraFromBoard[pose]));
    if (device == 1) {
        cv::Mat r3, t3;
        cv::composeRT(r, t, rotationOf(n.projectorFromCamera), translationOf(n.projectorFromCamera), r3, t3,
                      out.rByPoseR, out.rByPoseT, out.rByR, out.rByT, out.tByPoseR, out.tByPoseT, out.tByR, out.tByT);
        r = r3, t = t3;
    }
    const Lens& lens = n.lens[device];
    const cv::Matx33d k(lens[0], 0, lens[2], 0, lens[1], lens[3], 0, 0, 1);
    const std::vector<double> bending(lens.begin() + 4, lens.end());
    if (derivatives) {
        cv::projectPoints(points, r, t, k, bending, out.at, out.jacobian);
    } else {
        cv::projectPoints(points, r, t, k, bending, out.at);
    }
    return out;
}

/// Derivatives of both coordinates of sighting `i` by the unknowns, as (column, dx, dy).
struct Slope {
    int column;
    double dx, dy;
};

std::vector<Slope> slopes(const Layout& layout, const Projected& p, std::size_t device, int pose, int i) {
    const auto j = [&](int row, int column) { return p.jacobian.at<double>(2 * i + row, column); };
    std::vector<Slope> all;
    for (std::size_t k = 0; k < layout.lens[device].size(); ++k) {
        const int column = 6 + layout.lens[device][k];
        all.push_back({layout.lensAt[device] + static_cast<int>(k), j(0, column), j(1, column)});
    }
    const int first = layout.firstPose + 6 * pose;
    if (device == 0) {
        for (int k = 0; k < 6; ++k)
            all.push_back({first + k, j(0, k), j(1, k)});
        return all;
    }
    const auto chained = [&](const cv::Mat& r, const cv::Mat& t, int column, int at) {
        double dx = 0.0, dy = 0.0;
        for (int m = 0; m < 3; ++m) {
            dx += j(0, m) * r.at<double>(m, column) + j(0, 3 + m) * t.at<double>(m, column);
            dy += j(1, m) * r.at<double>(m, column) + j(1, 3 + m) * t.at<double>(m, column);
        }
        all.push_back({at, dx, dy});
    };
    for (int k = 0; k < 3; ++k) {
        chained(p.rByPoseR, p.tByPoseR, k, first + k);
        chained(p.rByPoseT, p.tByPoseT, k, first + 3 + k);
        chained(p.rByR, p.tByR, k, layout.motion + k);
        chained(p.rByT, p.tByT, k, layout.motion + 3 + k);
    }
    return all;
}

Equations equations(const Problem& problem, const Layout& layout, const Numbers& n, bool derivatives) {
    Equations e;
    if (derivatives) {
        e.normal = cv::Mat::zeros(layout.count, layout.count, CV_64F);
        e.right = cv::Mat::zeros(layout.count, 1, CV_64F);
    }
    for (std::size_t d = 0; d < 2; ++d) {
        for (std::size_t pose = 0; pose < problem.seen[d].size(); ++pose) {
            const auto& seen = problem.seen[d][pose];
            if (seen.empty()) continue;
            const Projected p = projected(problem, n, d, pose, derivatives);
            for (std::size_t i = 0; i < seen.size(); ++i) {
                const double rx = (seen[i].x - p.at[i].x) / problem.noise_px[d];
                const double ry = (seen[i].y - p.at[i].y) / problem.noise_px[d];
                const double r = std::hypot(rx, ry);
                e.cost += r <= kHuber ? r * r : kHuber * (2.0 * r - kHuber);
                if (!derivatives) continue;
                const double weight = (r <= kHuber ? 1.0 : kHuber / r) / problem.noise_px[d];
                const auto all = slopes(layout, p, d, static_cast<int>(pose), static_cast<int>(i));
                for (const Slope& a : all) {
                    e.right.at<double>(a.column) += weight * (a.dx * rx + a.dy * ry);
                    for (const Slope& b : all) {
                        e.normal.at<double>(a.column, b.column) +=
                            weight / problem.noise_px[d] * (a.dx * b.dx + a.dy * b.dy);
                    }
                }
            }
        }
    }
    return e;
}

Numbers stepped(Numbers n, const Layout& layout, const cv::Mat& step) {
    for (int i = 0; i < layout.count; ++i)
        number(n, layout, i) += step.at<double>(i);
    return n;
}

/// Residuals as pixels, by device and pose.
void measure(const Problem& problem, Fitted& f) {
    for (std::size_t d = 0; d < 2; ++d) {
        double sum = 0.0;
        for (std::size_t pose = 0; pose < problem.seen[d].size(); ++pose) {
            const auto& seen = problem.seen[d][pose];
            double here = 0.0;
            if (!seen.empty()) {
                const Projected p = projected(problem, f.numbers, d, pose, false);
                for (std::size_t i = 0; i < seen.size(); ++i)
                    here += std::pow(seen[i].x - p.at[i].x, 2) + std::pow(seen[i].y - p.at[i].y, 2);
            }
            f.pose_px[d].push_back(seen.empty() ? 0.0 : std::sqrt(here / static_cast<double>(seen.size())));
            sum += here, f.sightings[d] += static_cast<int>(seen.size());
        }
        f.rms_px[d] = f.sightings[d] > 0 ? std::sqrt(sum / f.sightings[d]) : 0.0;
    }
}

/// The projector's matrix directly from points in the room: nothing is assumed of its principal point.
void startProjector(const Problem& problem, Numbers& n) {
    std::vector<cv::Vec3d> room;
    std::vector<cv::Point2d> raster;
    for (std::size_t pose = 0; pose < problem.seen[1].size(); ++pose) {
        cv::Matx33d r;
        cv::Rodrigues(rotationOf(n.cameraFromBoard[pose]), r);
        for (const Sighting& s : problem.seen[1][pose]) {
            const auto& c = problem.corners[static_cast<std::size_t>(s.corner)];
            room.push_back(r * cv::Vec3d(c.x, c.y, c.z) + translationOf(n.cameraFromBoard[pose]));
            raster.emplace_back(s.x, s.y);
        }
    }
    // Both sides around their middles and of unit spread, or the equations are ill conditioned.
    cv::Vec3d middle(0, 0, 0);
    cv::Point2d centre(0, 0);
    for (std::size_t i = 0; i < room.size(); ++i)
        middle += room[i], centre += raster[i];
    const double count = static_cast<double>(room.size());
    middle /= count, centre = centre / count;
    double far = 0.0, wide = 0.0;
    for (std::size_t i = 0; i < room.size(); ++i)
        far += cv::norm(room[i] - middle) / count, wide += cv::norm(raster[i] - centre) / count;
    cv::Mat lines(static_cast<int>(2 * room.size()), 12, CV_64F, cv::Scalar(0));
    for (std::size_t i = 0; i < room.size(); ++i) {
        const cv::Vec3d q = (room[i] - middle) / far;
        const cv::Point2d p = (raster[i] - centre) / wide;
        const std::array<double, 4> homogeneous{q[0], q[1], q[2], 1.0};
        double* a = lines.ptr<double>(static_cast<int>(2 * i));
        double* b = lines.ptr<double>(static_cast<int>(2 * i + 1));
        for (std::size_t k = 0; k < 4; ++k) {
            a[k] = homogeneous[k], a[8 + k] = -p.x * homogeneous[k];
            b[4 + k] = homogeneous[k], b[8 + k] = -p.y * homogeneous[k];
        }
    }
    cv::Mat twelve;
    cv::SVD::solveZ(lines, twelve);
    cv::Matx34d m;
    std::copy(twelve.begin<double>(), twelve.end<double>(), m.val);
    m = cv::Matx33d(wide, 0, centre.x, 0, wide, centre.y, 0, 0, 1) * m;
    const cv::Matx44d toUnit(1 / far, 0, 0, -middle[0] / far, 0, 1 / far, 0, -middle[1] / far, 0, 0, 1 / far,
                             -middle[2] / far, 0, 0, 0, 1);
    m = m * toUnit;
    // The points lie before the projector.
    const cv::Vec3d first = room.front();
    if (m(2, 0) * first[0] + m(2, 1) * first[1] + m(2, 2) * first[2] + m(2, 3) < 0.0) m = -1.0 * m;
    const cv::Matx33d left = m.get_minor<3, 3>(0, 0);
    cv::Matx33d k, r;
    cv::RQDecomp3x3(left, k, r);
    // A matrix's two factors are given but for signs; focal lengths are positive.
    const cv::Matx33d signs(k(0, 0) < 0 ? -1 : 1, 0, 0, 0, k(1, 1) < 0 ? -1 : 1, 0, 0, 0, k(2, 2) < 0 ? -1 : 1);
    k = k * signs, r = signs * r;
    if (cv::determinant(r) < 0.0) CV_Error(cv::Error::StsNoConv, "the projector's raster is mirrored");
    const cv::Vec3d t = k.inv() * cv::Vec3d(m(0, 3), m(1, 3), m(2, 3));
    cv::Vec3d rotation;
    cv::Rodrigues(r, rotation);
    n.lens[1] = {k(0, 0) / k(2, 2), k(1, 1) / k(2, 2), k(0, 2) / k(2, 2), k(1, 2) / k(2, 2), 0, 0, 0, 0, 0};
    n.projectorFromCamera = {rotation[0], rotation[1], rotation[2], t[0], t[1], t[2]};
}

}  // namespace

Numbers started(const Problem& problem, Size camera) {
    std::vector<std::vector<cv::Point3f>> board;
    std::vector<std::vector<cv::Point2f>> seen;
    for (const auto& pose : problem.seen[0]) {
        auto& points = board.emplace_back();
        auto& pixels = seen.emplace_back();
        for (const Sighting& s : pose) {
            const auto& c = problem.corners[static_cast<std::size_t>(s.corner)];
            points.emplace_back(static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z));
            pixels.emplace_back(static_cast<float>(s.x), static_cast<float>(s.y));
        }
    }
    cv::Mat k, bending;
    std::vector<cv::Mat> r, t;
    cv::calibrateCamera(board, seen, cv::Size(camera.width, camera.height), k, bending, r, t,
                        cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3);
    Numbers n;
    n.lens[0] = {k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2), 0, 0, 0, 0, 0};
    if (problem.terms[0] > 0) n.lens[0][4] = bending.at<double>(0);
    for (std::size_t i = 0; i < r.size(); ++i) {
        n.cameraFromBoard.push_back({r[i].at<double>(0), r[i].at<double>(1), r[i].at<double>(2), t[i].at<double>(0),
                                     t[i].at<double>(1), t[i].at<double>(2)});
    }
    if (problem.withProjector()) startProjector(problem, n);
    return n;
}

Fitted fitted(const Problem& problem, Numbers start, bool deviations) {
    const Layout layout(problem);
    for (std::size_t d = 0; d < 2; ++d)  // terms that are held are not there
        std::fill(start.lens[d].begin() + 4 + problem.terms[d], start.lens[d].end(), 0.0);
    Fitted f;
    f.numbers = std::move(start);
    Equations e = equations(problem, layout, f.numbers, true);
    double damping = 1e-4;
    for (int round = 0; round < 60 && damping < 1e10; ++round) {
        cv::Mat damped = e.normal.clone(), step;
        for (int i = 0; i < layout.count; ++i)
            damped.at<double>(i, i) = damped.at<double>(i, i) * (1.0 + damping) + 1e-12;
        if (!cv::solve(damped, e.right, step, cv::DECOMP_CHOLESKY)) {
            damping *= 10.0;
            continue;
        }
        Numbers next = stepped(f.numbers, layout, step);
        const double cost = equations(problem, layout, next, false).cost;
        if (!(cost < e.cost)) {
            damping *= 10.0;
            continue;
        }
        const bool done = e.cost - cost < 1e-9 * e.cost;
        f.numbers = std::move(next);
        e = equations(problem, layout, f.numbers, true);
        damping = std::max(1e-12, damping * 0.1);
        if (done) break;
    }
    f.cost = e.cost;
    measure(problem, f);
    if (!deviations) return f;
    // Scaled to a unit diagonal: metres, pixels and terms of distortion differ by ten orders of magnitude.
    cv::Mat scale(layout.count, 1, CV_64F), covariance;
    for (int i = 0; i < layout.count; ++i)
        scale.at<double>(i) = 1.0 / std::sqrt(std::max(1e-300, e.normal.at<double>(i, i)));
    const cv::Mat scales = scale * scale.t();
    cv::invert(e.normal.mul(scales), covariance, cv::DECOMP_SVD);
    covariance = covariance.mul(scales);
    const double freedom = 2.0 * (f.sightings[0] + f.sightings[1]) - layout.count;
    const double unit = freedom > 0.0 ? e.cost / freedom : 0.0;
    const auto deviation = [&](int at) { return std::sqrt(std::max(0.0, unit * covariance.at<double>(at, at))); };
    for (std::size_t d = 0; d < 2; ++d) {
        for (std::size_t k = 0; k < layout.lens[d].size(); ++k) {
            f.lensDeviation[d][static_cast<std::size_t>(layout.lens[d][k])] =
                deviation(layout.lensAt[d] + static_cast<int>(k));
        }
    }
    for (int k = 0; layout.motion >= 0 && k < 6; ++k)
        f.motionDeviation[static_cast<std::size_t>(k)] = deviation(layout.motion + k);
    return f;
}

}  // namespace ilf::fit
