#include "core/solid/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <opencv2/calib3d.hpp>
#include <string>

namespace ilf {

namespace {

constexpr double kFlat = 1e-4;  ///< a spread below this share of the largest counts as none

/// Root mean square extents along the principal axes, largest first.
std::array<double, 3> spread(const std::vector<cv::Point3d>& points) {
    cv::Mat rows(static_cast<int>(points.size()), 3, CV_64F);
    cv::Point3d middle;
    for (const cv::Point3d& p : points)
        middle += p * (1.0 / static_cast<double>(points.size()));
    for (int i = 0; i < rows.rows; ++i) {
        const cv::Point3d p = points[static_cast<std::size_t>(i)] - middle;
        rows.at<double>(i, 0) = p.x;
        rows.at<double>(i, 1) = p.y;
        rows.at<double>(i, 2) = p.z;
    }
    const cv::SVD svd(rows, cv::SVD::NO_UV);
    std::array<double, 3> values{};
    for (int i = 0; i < std::min(3, svd.w.rows); ++i)
        values[static_cast<std::size_t>(i)] = svd.w.at<double>(i) / std::sqrt(static_cast<double>(points.size()));
    return values;
}

Pose<CameraSpace, ModelSpace> poseOf(const cv::Mat& rotationVector, const cv::Mat& translation) {
    cv::Mat rotation;
    cv::Rodrigues(rotationVector, rotation);
    Pose<CameraSpace, ModelSpace> pose;
    for (int i = 0; i < 9; ++i)
        pose.rotation[static_cast<std::size_t>(i)] = rotation.at<double>(i / 3, i % 3);
    for (int i = 0; i < 3; ++i)
        pose.translation[static_cast<std::size_t>(i)] = translation.at<double>(i);
    return pose;
}

/// Residuals of a pose; nothing where it puts a point behind the camera.
std::optional<FoundPose> judged(std::span<const PosePair> pairs, const Pinhole& camera,
                                const Pose<CameraSpace, ModelSpace>& pose) {
    FoundPose found{pose, {}, 0.0, 0, std::nullopt};
    double sum = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Point3<CameraSpace> p = pose(pairs[i].model);
        if (!(p.z > 0.0)) return std::nullopt;
        const auto [x, y] = camera.pixelOf(p.x / p.z, p.y / p.z);
        found.residuals_px.push_back(std::hypot(x - pairs[i].picture.x, y - pairs[i].picture.y));
        sum += found.residuals_px[i] * found.residuals_px[i];
        if (!(found.residuals_px[i] <= found.residuals_px[found.worst])) found.worst = i;
    }
    found.rms_px = std::sqrt(sum / static_cast<double>(pairs.size()));
    if (!std::isfinite(found.rms_px)) return std::nullopt;
    return found;
}

/// All poses that a linear method proposes, refined.
std::vector<FoundPose> candidates(std::span<const PosePair> pairs, const Pinhole& camera,
                                  const std::vector<cv::Point3d>& model, bool flat) {
    std::vector<cv::Point2d> picture;
    for (const PosePair& pair : pairs)  // OpenCV counts from pixel centres
        picture.emplace_back(pair.picture.x - 0.5, pair.picture.y - 0.5);
    const cv::Mat lens =
        (cv::Mat_<double>(3, 3) << camera.fx, 0.0, camera.cx - 0.5, 0.0, camera.fy, camera.cy - 0.5, 0.0, 0.0, 1.0);
    const std::vector<double> bend(camera.distortion.begin(), camera.distortion.end());
    std::vector<FoundPose> found;
    std::vector<int> methods{cv::SOLVEPNP_SQPNP};
    if (flat) methods.push_back(cv::SOLVEPNP_IPPE);
    for (const int method : methods) {
        std::vector<cv::Mat> rotations, translations;
        try {
            cv::solvePnPGeneric(model, picture, lens, bend, rotations, translations, false,
                                static_cast<cv::SolvePnPMethod>(method));
            for (std::size_t i = 0; i < rotations.size(); ++i) {
                cv::solvePnPRefineLM(model, picture, lens, bend, rotations[i], translations[i],
                                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-14});
                if (auto one = judged(pairs, camera, poseOf(rotations[i], translations[i])))
                    found.push_back(std::move(*one));
            }
        } catch (const cv::Exception&) {  // this method cannot do these points; the other may
        }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.rms_px < b.rms_px; });
    return found;
}

/// Whether two poses differ by more than rounding: by a degree of turning.
bool different(const Pose<CameraSpace, ModelSpace>& a, const Pose<CameraSpace, ModelSpace>& b) {
    double trace = 0.0;
    for (std::size_t i = 0; i < 9; ++i)
        trace += a.rotation[i] * b.rotation[i];
    return trace < 1.0 + 2.0 * std::cos(0.0175);
}

/// Of a camera's place and its axes in the scene, glTF's way: unit vectors backwards (z) and upwards (y).
Pose<CameraSpace, ModelSpace> cameraAt(const glm::dvec3& at, const glm::dvec3& back, const glm::dvec3& up) {
    const glm::dvec3 right = glm::cross(up, back), down = -up, forward = -back;
    Pose<CameraSpace, ModelSpace> pose;
    pose.rotation = {right.x, right.y, right.z, down.x, down.y, down.z, forward.x, forward.y, forward.z};
    pose.translation = {-glm::dot(right, at), -glm::dot(down, at), -glm::dot(forward, at)};
    return pose;
}

}  // namespace

Result<FoundPose> poseFromPairs(std::span<const PosePair> pairs, const Pinhole& camera) {
    const auto refused = [](std::string why) { return fail(Fault::outOfRange, std::move(why)); };
    if (!(camera.fx > 0.0) || !(camera.fy > 0.0))
        return refused("The camera's focal length is not known: calibrate it, or type its focal length in pixels.");
    if (pairs.size() < 4)
        return refused("A pose needs at least 4 points of the scene found in the picture; there are " +
                       std::to_string(pairs.size()) + ". Add points, best of them not in one plane.");
    std::vector<cv::Point3d> model, picture;
    for (const PosePair& pair : pairs) {
        model.emplace_back(pair.model.x, pair.model.y, pair.model.z);
        picture.emplace_back(pair.picture.x, pair.picture.y, 0.0);
        if (!std::isfinite(pair.model.x + pair.model.y + pair.model.z + pair.picture.x + pair.picture.y))
            return refused("A point of the pairs is not a number: pick it again.");
    }
    const auto inScene = spread(model), inPicture = spread(picture);
    if (!(inScene[1] > kFlat * inScene[0]))
        return refused("The points lie in one line of the scene, which leaves the camera free to turn about it: add a "
                       "point beside that line.");
    if (!(inPicture[1] > kFlat * inPicture[0]) || !(inPicture[1] > 0.5))
        return refused(
            "The points lie in one line of the picture, or nearly in one spot: choose points that are farther "
            "apart.");

    const auto found = candidates(pairs, camera, model, inScene[2] < kFlat * inScene[0]);
    if (found.empty())
        return refused("No camera in front of these points could see them so: two of them may have changed places, or "
                       "the picture is mirrored.");
    FoundPose best = found.front();
    const double diagonal = std::hypot(camera.size.width, camera.size.height);
    if (best.rms_px > 0.1 * diagonal)
        return refused("The points do not fit any camera: the closest pose misses them by " +
                       std::to_string(static_cast<int>(best.rms_px)) + " px. Check the pairs, point " +
                       std::to_string(best.worst + 1) + " first.");
    for (std::size_t i = 1; i < found.size(); ++i) {
        const bool near = found[i].rms_px < std::max(3.0 * best.rms_px, best.rms_px + 1.0);
        if (near && different(found[i].cameraFromModel, best.cameraFromModel)) {
            best.rival_px = found[i].rms_px;
            break;
        }
    }
    return best;
}

std::optional<Pose<CameraSpace, ModelSpace>> cameraFromGltfNode(const std::array<double, 16>& m) {
    const auto column = [&](std::size_t i) { return glm::dvec3(m[4 * i], m[4 * i + 1], m[4 * i + 2]); };
    // The view axis is kept, up as nearly as possible.
    const double length = glm::length(column(2));
    const glm::dvec3 back = column(2) / length;
    const glm::dvec3 above = column(1) - back * glm::dot(back, column(1));
    if (!(length > 0.0) || !(glm::length(above) > 1e-12 * glm::length(column(1)))) return std::nullopt;
    return cameraAt(column(3), back, glm::normalize(above));
}

Pose<CameraSpace, ModelSpace> lookingAt(const Point3<ModelSpace>& eye, const Point3<ModelSpace>& target) {
    const glm::dvec3 at(eye.x, eye.y, eye.z);
    const glm::dvec3 back = glm::normalize(at - glm::dvec3(target.x, target.y, target.z));
    glm::dvec3 above = glm::dvec3(0.0, 1.0, 0.0) - back * back.y;
    if (glm::length(above) < 1e-6) above = glm::cross(back, glm::dvec3(1.0, 0.0, 0.0));
    return cameraAt(at, back, glm::normalize(above));
}

}  // namespace ilf
