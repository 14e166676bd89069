#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>

#include "core/registration/calibrate.h"
#include "projects/calibration_file.h"
#include "projects/safe_file.h"

namespace ilf::projects {
namespace {

constexpr std::size_t kMostOfImport = std::size_t{1} << 20;

/// The numbers of a matrix, row by row, or none where it is missing or has another count.
std::vector<double> numbersOf(const cv::FileStorage& file, std::initializer_list<const char*> names,
                              std::size_t count) {
    for (const char* name : names) {
        const cv::FileNode node = file[name];
        if (node.empty() || !node.isMap()) continue;
        cv::Mat matrix;
        node >> matrix;
        if (matrix.total() != count || matrix.channels() != 1) return {};
        matrix.convertTo(matrix, CV_64F);
        return {matrix.begin<double>(), matrix.end<double>()};
    }
    return {};
}

Pinhole pinholeOf(Size size, const std::vector<double>& k, const std::vector<double>& distortion) {
    Pinhole pinhole{size, k[0], k[4], k[2] + 0.5, k[5] + 0.5, {}};
    std::ranges::copy(distortion, pinhole.distortion.begin());
    return pinhole;
}

}  // namespace

Result<ProcamCalibration> importCalibration(const fs::path& path, Size projector, Metre unit) {
    const auto text = readWhole(path, kMostOfImport);
    if (!text) return tl::unexpected(text.error());
    const auto bad = [&](const std::string& what) { return fail(Fault::badFile, spoken(path) + ": " + what); };
    try {
        const cv::FileStorage file(*text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
        if (!file.isOpened()) return bad("this is no file of OpenCV's.");
        const auto shape = numbersOf(file, {"img_shape"}, 2);
        const auto cameraMatrix = numbersOf(file, {"cam_int"}, 9), cameraBends = numbersOf(file, {"cam_dist"}, 5);
        const auto projectorMatrix = numbersOf(file, {"proj_int"}, 9),
                   projectorBends = numbersOf(file, {"proj_dist"}, 5);
        const auto rotation = numbersOf(file, {"rotation", "roration"}, 9),
                   translation = numbersOf(file, {"translation"}, 3);
        for (const auto& [name, numbers] :
             {std::pair{"img_shape", &shape}, std::pair{"cam_int", &cameraMatrix}, std::pair{"cam_dist", &cameraBends},
              std::pair{"proj_int", &projectorMatrix}, std::pair{"proj_dist", &projectorBends},
              std::pair{"rotation", &rotation}, std::pair{"translation", &translation}}) {
            if (numbers->empty()) return bad("\"" + std::string(name) + "\" is missing or has another size.");
        }
        const auto whole = [](double v) { return v >= 1.0 && v <= 1e5 ? static_cast<int>(v) : 0; };
        ProcamCalibration c;
        c.camera = pinholeOf({whole(shape[1]), whole(shape[0])}, cameraMatrix, cameraBends);
        c.projector = pinholeOf(projector, projectorMatrix, projectorBends);
        std::ranges::copy(rotation, c.projectorFromCamera.rotation.begin());
        for (std::size_t i = 0; i < 3; ++i)
            c.projectorFromCamera.translation[i] = translation[i] * unit.si();
        // One rms for both devices is all there is; 0 where it is not told.
        const cv::FileNode rms = file["rms"];
        c.cameraRms_px = c.projectorRms_px = rms.isReal() || rms.isInt() ? rms.real() : 0.0;
        c.scale = "board";
        c.provenance = "measured";
        if (const auto good = checked(c); !good) return bad(good.error().what);
        return c;
    } catch (const std::exception& e) {
        return bad("this is no calibration of OpenCV's (" + std::string(e.what()) + ").");
    }
}

}  // namespace ilf::projects
