#include "core/registration/calibrate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "core/base/as_text.h"
#include "core/registration/calibrate_fit.h"

namespace ilf {

namespace {

/// Below it, a board's poses are one pose as far as focal lengths go: boards held by hand and meant to be parallel lie
/// within it, and the focal length's uncertainty grows as its inverse.
constexpr double kLeastTilt_deg = 8.0;
constexpr double kMostFocalDeviation = 0.03;
constexpr double kMostRms_px = 5.0;
/// A pose is left out when it fits this many times worse than the poses' median, if it is off at all.
constexpr double kOutlier = 3.0;
constexpr double kOutlier_px = 0.5;

const char* const kTiltBoard =
    "Take the board at five poses or more, tilted by 20 to 40 degrees to different sides, filling the picture.";

/// The terms of distortion that so many poses may carry: k1; k2; p1 and p2; k3.
int mostTerms(int poses) { return poses < 4 ? 1 : poses < 5 ? 2 : poses < 8 ? 4 : 5; }
/// The next poorer model: p1 and p2 go together.
int fewerTerms(int terms) { return terms == 4 ? 2 : terms - 1; }

fit::Problem problemOf(std::span<const BoardView> views, const std::vector<std::size_t>& chosen, const Board& board,
                       bool withProjector) {
    fit::Problem problem;
    problem.corners = cornersOf(board);
    for (const std::size_t v : chosen) {
        auto& camera = problem.seen[0].emplace_back();
        for (std::size_t i = 0; i < views[v].inCamera.size(); ++i)
            camera.push_back({static_cast<int>(i), views[v].inCamera[i].x, views[v].inCamera[i].y});
        if (!withProjector) continue;
        auto& projector = problem.seen[1].emplace_back();
        for (std::size_t i = 0; i < views[v].onProjector.size(); ++i) {
            if (const auto& p = views[v].onProjector[i]) projector.push_back({static_cast<int>(i), p->x, p->y});
        }
    }
    return problem;
}

std::array<double, 3> normalOf(const fit::Motion& pose) {
    cv::Matx33d r;
    cv::Rodrigues(cv::Vec3d(pose[0], pose[1], pose[2]), r);
    return {r(0, 2), r(1, 2), r(2, 2)};
}

double widestTilt(const fit::Numbers& n) {
    double widest = 0.0;
    for (const auto& a : n.cameraFromBoard) {
        for (const auto& b : n.cameraFromBoard) {
            const auto u = normalOf(a), v = normalOf(b);
            const double cosine = std::abs(std::inner_product(u.begin(), u.end(), v.begin(), 0.0));
            widest = std::max(widest, std::acos(std::min(1.0, cosine)) * 180.0 / std::numbers::pi);
        }
    }
    return widest;
}

/// Noise as the richest model leaves it; then poorer models for as long as what they lose is noise: by the Bayesian
/// information criterion a term must lower the cost by ln(sightings) to stay.
fit::Fitted chosenModel(fit::Problem& problem, const fit::Numbers& start) {
    problem.terms.fill(mostTerms(problem.poses()));
    fit::Fitted best = fit::fitted(problem, start, false);
    for (int round = 0; round < 2; ++round) {
        for (std::size_t d = 0; d < 2; ++d)
            problem.noise_px[d] = std::max(0.01, best.rms_px[d] / std::numbers::sqrt2);  // of x and y each
        best = fit::fitted(problem, best.numbers, false);
    }
    const double perTerm = std::log(2.0 * (best.sightings[0] + best.sightings[1]));
    for (std::size_t d = 0; d < (problem.withProjector() ? 2U : 1U); ++d) {
        while (problem.terms[d] > 0) {
            fit::Problem poorer = problem;
            poorer.terms[d] = fewerTerms(problem.terms[d]);
            const fit::Fitted without = fit::fitted(poorer, best.numbers, false);
            if (without.cost - best.cost > perTerm * (problem.terms[d] - poorer.terms[d])) break;
            problem = std::move(poorer);
            best = without;
        }
    }
    return fit::fitted(problem, best.numbers, true);
}

/// The pose that fits so much worse than the others that it is wrong, as an index into the fit's poses.
std::optional<std::size_t> outlier(const fit::Fitted& f) {
    const std::size_t poses = f.pose_px[0].size();
    if (poses < 4) return std::nullopt;
    std::optional<std::size_t> worst;
    double worstShare = kOutlier;
    for (const auto& px : f.pose_px) {
        if (px.empty()) continue;
        std::vector<double> sorted = px;
        std::ranges::sort(sorted);
        const double median = sorted[(sorted.size() - 1) / 2];
        for (std::size_t i = 0; i < poses; ++i) {
            const double share = px[i] / std::max(median, 1e-6);
            if (px[i] > kOutlier_px && share > worstShare) worst = i, worstShare = share;
        }
    }
    return worst;
}

/// What both calibrations have in common.
struct Solved {
    fit::Problem problem;
    fit::Fitted fit;
    std::vector<std::size_t> chosen;
    double tilt_deg = 0.0;
    std::vector<std::string> notes;
};

Pinhole pinholeOf(const fit::Lens& l, Size size) {
    return {size, l[0], l[1], l[2], l[3], {l[4], l[5], l[6], l[7], l[8]}};
}
PinholeDeviation deviationOf(const fit::Lens& l) { return {l[0], l[1], l[2], l[3], {l[4], l[5], l[6], l[7], l[8]}}; }

template <class To, class From>
Pose<To, From> poseOf(const fit::Motion& m) {
    cv::Matx33d r;
    cv::Rodrigues(cv::Vec3d(m[0], m[1], m[2]), r);
    Pose<To, From> pose;
    std::copy(r.val, r.val + 9, pose.rotation.begin());
    pose.translation = {m[3], m[4], m[5]};
    return pose;
}

Result<void> comparable(std::span<const BoardView> views, const Board& board, bool withProjector) {
    if (const auto good = checked(board); !good) return good;
    if (views.size() < 2) {
        return fail(Fault::outOfRange,
                    std::string(views.empty() ? "No pose" : "One pose") +
                        " of the board cannot tell a camera's focal length from the board's distance: a flat board "
                        "gives two equations a pose for four unknowns of each device. " +
                        kTiltBoard);
    }
    const auto corners = cornersOf(board).size();
    for (const BoardView& view : views) {
        if (view.camera != views[0].camera || (withProjector && view.projector != views[0].projector)) {
            return fail(Fault::outOfRange, view.name + ": its picture or raster has another size than " +
                                               views[0].name + "'s. All poses need the same camera mode.");
        }
        if (view.inCamera.size() != corners || (withProjector && view.onProjector.size() != corners)) {
            return fail(Fault::outOfRange, view.name + ": it shows another board than the one that is described.");
        }
        const auto placed = std::ranges::count_if(view.onProjector, [](const auto& p) { return p.has_value(); });
        if (withProjector && placed < 6) {
            return fail(Fault::outOfRange,
                        view.name + ": fewer than six of the board's corners have a place on the projector.");
        }
    }
    return {};
}

Result<void> trusted(const Solved& solved, bool withProjector) {
    if (solved.tilt_deg < kLeastTilt_deg) {
        return fail(Fault::outOfRange, "The board's " + std::to_string(solved.chosen.size()) +
                                           " poses are nearly parallel (at most " + asText("%.1f", solved.tilt_deg) +
                                           " degrees apart), so focal lengths cannot be told from distances. " +
                                           kTiltBoard);
    }
    for (std::size_t d = 0; d < (withProjector ? 2U : 1U); ++d) {
        const char* const device = d == 0 ? "camera" : "projector";
        const double share = std::max(solved.fit.lensDeviation[d][0] / solved.fit.numbers.lens[d][0],
                                      solved.fit.lensDeviation[d][1] / solved.fit.numbers.lens[d][1]);
        if (!(solved.fit.rms_px[d] <= kMostRms_px)) {
            return fail(Fault::outOfRange, "No pinhole explains the board in the " + std::string(device) +
                                               "'s pixels (" + asText("%.1f", solved.fit.rms_px[d]) +
                                               " px rms): check the board's counts, and that neither board nor "
                                               "camera moved during a scan.");
        }
        if (!(share <= kMostFocalDeviation) || solved.fit.numbers.lens[d][0] <= 0.0 ||
            solved.fit.numbers.lens[d][1] <= 0.0) {
            return fail(Fault::outOfRange, "The " + std::string(device) + "'s focal length stays uncertain by " +
                                               asText("%.0f", 100.0 * share) + " %. " + kTiltBoard);
        }
    }
    return {};
}

Result<Solved> solved(std::span<const BoardView> views, const Board& board, bool withProjector) {
    if (const auto good = comparable(views, board, withProjector); !good) return tl::unexpected(good.error());
    Solved s;
    s.chosen.resize(views.size());
    std::iota(s.chosen.begin(), s.chosen.end(), std::size_t{0});
    try {
        while (true) {
            s.problem = problemOf(views, s.chosen, board, withProjector);
            s.fit = chosenModel(s.problem, fit::started(s.problem, views[0].camera));
            const auto bad = outlier(s.fit);
            if (!bad) break;
            std::string note = views[s.chosen[*bad]].name + " fits far worse than the other poses (" +
                               asText("%.1f", s.fit.pose_px[0][*bad]) + " px in the camera";
            if (withProjector) note += ", " + asText("%.1f", s.fit.pose_px[1][*bad]) + " px on the projector";
            s.notes.push_back(note + ") and was left out: did the board move during its scan?");
            s.chosen.erase(s.chosen.begin() + static_cast<std::ptrdiff_t>(*bad));
        }
    } catch (const cv::Exception& e) {
        return fail(Fault::outOfRange,
                    "The poses of the board do not give a calibration (" + e.err + "). " + kTiltBoard);
    }
    s.tilt_deg = widestTilt(s.fit.numbers);
    if (const auto good = trusted(s, withProjector); !good) return tl::unexpected(good.error());
    if (s.chosen.size() < 5) {
        s.notes.push_back("Only " + std::to_string(s.chosen.size()) +
                          " poses: distortion is restrained. Five or more make focal lengths certain to 0.3 %.");
    }
    if (s.tilt_deg < 20.0) {
        s.notes.push_back("The poses differ by " + asText("%.0f", s.tilt_deg) +
                          " degrees at most; 30 or more make focal lengths more certain.");
    }
    return s;
}

std::vector<PoseFit> posesOf(const Solved& s, std::span<const BoardView> views) {
    std::vector<PoseFit> poses;
    for (const BoardView& view : views) {
        PoseFit& pose = poses.emplace_back();
        pose.name = view.name;
        pose.used = false;
        pose.cameraCorners = static_cast<int>(view.inCamera.size());
        if (!s.problem.withProjector()) continue;
        pose.projectorCorners =
            static_cast<int>(std::ranges::count_if(view.onProjector, [](const auto& p) { return p.has_value(); }));
    }
    for (std::size_t i = 0; i < s.chosen.size(); ++i) {
        PoseFit& pose = poses[s.chosen[i]];
        pose.used = true;
        pose.camera_px = s.fit.pose_px[0][i];
        if (s.problem.withProjector()) pose.projector_px = s.fit.pose_px[1][i];
        pose.cameraFromBoard = poseOf<CameraSpace, ModelSpace>(s.fit.numbers.cameraFromBoard[i]);
    }
    return poses;
}

}  // namespace

Result<Calibrated> calibrated(std::span<const BoardView> views, const Board& board) {
    auto s = solved(views, board, true);
    if (!s) return tl::unexpected(s.error());
    Calibrated out;
    ProcamCalibration& c = out.calibration;
    c.camera = pinholeOf(s->fit.numbers.lens[0], views[0].camera);
    c.projector = pinholeOf(s->fit.numbers.lens[1], views[0].projector);
    c.projectorFromCamera = poseOf<ProjectorSpace, CameraSpace>(s->fit.numbers.projectorFromCamera);
    c.cameraRms_px = s->fit.rms_px[0];
    c.projectorRms_px = s->fit.rms_px[1];
    c.poses = static_cast<int>(s->chosen.size());
    c.scale = "board";
    out.camera = deviationOf(s->fit.lensDeviation[0]);
    out.projector = deviationOf(s->fit.lensDeviation[1]);
    const fit::Motion& m = s->fit.motionDeviation;
    out.rotation_rad = {m[0], m[1], m[2]};
    out.translation_m = {m[3], m[4], m[5]};
    out.poses = posesOf(*s, views);
    out.widestTilt_deg = s->tilt_deg;
    out.notes = std::move(s->notes);
    return out;
}

Result<CalibratedCamera> calibratedCamera(std::span<const BoardView> views, const Board& board) {
    auto s = solved(views, board, false);
    if (!s) return tl::unexpected(s.error());
    return CalibratedCamera{pinholeOf(s->fit.numbers.lens[0], views[0].camera),
                            deviationOf(s->fit.lensDeviation[0]),
                            s->fit.rms_px[0],
                            posesOf(*s, views),
                            s->tilt_deg,
                            std::move(s->notes)};
}

Result<ProcamCalibration> rescaled(ProcamCalibration calibration, Metre calibrated, Metre measured) {
    if (!(calibrated > 0.0_m) || !(measured > 0.0_m) || !isFinite(calibrated) || !isFinite(measured)) {
        return fail(Fault::outOfRange, "A length measured with a tape, and the same length as calibrated, must both be "
                                       "more than 0 m.");
    }
    const double by = measured / calibrated;
    for (double& metres : calibration.projectorFromCamera.translation)
        metres *= by;
    calibration.scale = "tape";
    return calibration;
}

}  // namespace ilf
