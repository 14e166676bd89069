#include "tests/bench/perceived/baseline_rows.h"

#include <opencv2/imgproc.hpp>

#include "core/perceived/perceived.h"
#include "tests/bench/perceived/kernels.h"
#include "tests/bench/perceived/optics_of.h"

namespace ilf::bench {
namespace {

/// Of the gather, which takes seconds for a whole view.
constexpr int kGatherRows = 16;

/// What a program would keep between frames: coverage and lit colour of each layer and level.
struct Prepared {
    struct Part {
        cv::Mat lit;  ///< red, green, blue and coverage
        Seen look;
    };
    std::vector<std::vector<Part>> levels;  ///< each with its layers, nearest first
    std::vector<cv::Mat> whole, radii;      ///< of each level: all lit colours, and each pixel's own radius
    cv::Size size;
};

Prepared prepared(const BenchScene& scene) {
    const Shown& shown = scene.shown;
    const Size size = shown.document.scene.size();
    Prepared all;
    all.size = {size.width, size.height};
    const Radiance albedo = plainView(shown.document, 1.0);
    const std::vector<SceneLayer> cut = layers(shown.document, shown.plan, 1.0);
    for (std::size_t l = 0; l < shown.plan.levels.size(); ++l) {
        const Image<std::uint8_t> light = toImage(shown.program.images[l]);
        const auto weight = static_cast<float>(weightOf(shown.plan, l) / 255.0);
        cv::Mat whole(all.size, CV_32FC3), radii(all.size, CV_32F, cv::Scalar(0.0)),
            most(all.size, CV_32F, cv::Scalar(0.0));
        std::vector<Prepared::Part> parts;
        for (const SceneLayer& layer : cut) {
            cv::Mat lit(all.size, CV_32FC4);
            const Seen look = seen(scene, layer.distance, shown.plan.levels[l].power);
            for (int y = 0; y < size.height; ++y) {
                for (int x = 0; x < size.width; ++x) {
                    const float share = layer.coverage.at(x, y);
                    const float here = share * weight * static_cast<float>(light.at(x, y));
                    lit.at<cv::Vec4f>(y, x) = {here * albedo.at(x, y, 0), here * albedo.at(x, y, 1),
                                               here * albedo.at(x, y, 2), share};
                    if (share > most.at<float>(y, x)) {
                        most.at<float>(y, x) = share;
                        radii.at<float>(y, x) = static_cast<float>(look.radius);
                    }
                }
            }
            parts.push_back({lit, look});
        }
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                for (int c = 0; c < 3; ++c)
                    whole.at<cv::Vec3f>(y, x)[c] = weight * static_cast<float>(light.at(x, y)) * albedo.at(x, y, c);
        all.levels.push_back(std::move(parts));
        all.whole.push_back(whole);
        all.radii.push_back(radii);
    }
    return all;
}

/// Blurred, magnified about the optical centre, nearest first over what lies behind.
cv::Mat composed(const Prepared& prepared, const Blur& blur) {
    cv::Mat view = cv::Mat::zeros(prepared.size, CV_32FC3);
    for (const auto& parts : prepared.levels) {
        cv::Mat passing(prepared.size, CV_32F, cv::Scalar(1.0));
        for (const auto& [lit, look] : parts) {
            const cv::Mat blurred = look.radius < 0.5 ? lit : blur.run(lit, look.radius);
            const double s = look.magnification;
            // Pixel centres lie half a pixel off the library's coordinates.
            const cv::Mat map = (cv::Mat_<double>(2, 3) << s, 0.0, (1.0 - s) * (look.centre.x - 0.5), 0.0, s,
                                 (1.0 - s) * (look.centre.y - 0.5));
            cv::Mat larger;
            cv::warpAffine(blurred, larger, map, prepared.size, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
            for (int y = 0; y < prepared.size.height; ++y) {
                const auto* from = larger.ptr<cv::Vec4f>(y);
                auto* to = view.ptr<cv::Vec3f>(y);
                auto* left = passing.ptr<float>(y);
                for (int x = 0; x < prepared.size.width; ++x) {
                    for (int c = 0; c < 3; ++c)
                        to[x][c] += left[x] * from[x][c];
                    left[x] *= 1.0F - from[x][3];
                }
            }
        }
    }
    return view;
}

std::vector<float> picked(const cv::Mat& view, const std::vector<cv::Point>& places) {
    std::vector<float> out;
    for (const cv::Point place : places)
        for (int c = 0; c < 3; ++c)
            out.push_back(view.at<cv::Vec3f>(place)[c]);
    return out;
}

}  // namespace

void addBaselineRows(Table& table, const BenchScene& scene, const Truth* truth, int threads) {
    cv::setNumThreads(threads);
    const Prepared all = prepared(scene);
    double baseline = kNothing;
    for (const Blur& blur : libraryBlurs()) {
        Row row{.section = "baseline", .scene = scene.name, .method = blur.name, .what = "full frame"};
        row.threads = threads;
        cv::Mat view;
        row.times = timed({0.5, 10, 2, 10}, [&](int) { view = composed(all, blur); });
        if (truth) row.errors = truth->against(picked(view, truth->places()));
        if (blur.name == "filter2D") baseline = row.times.p50;
        row.ratio = baseline / row.times.p50;
        row.note = "layers by the product of blurred coverage";
        table.add(std::move(row));
    }
    Row row{.section = "baseline", .scene = scene.name, .method = "gather", .what = "full frame", .threads = 1};
    row.times = timed({0.3, 10, 2, 10}, [&](int) {
        for (std::size_t l = 0; l < all.whole.size(); ++l)
            gatheredRows(all.whole[l], all.radii[l], kGatherRows);
    });
    const double scale = static_cast<double>(all.size.height) / kGatherRows;
    row.times.p50 *= scale;
    row.times.p95 *= scale;
    row.times.least *= scale;
    if (truth) {
        std::vector<float> sum(3 * truth->places().size());
        for (std::size_t l = 0; l < all.whole.size(); ++l) {
            const std::vector<float> part = gathered(all.whole[l], all.radii[l], truth->places());
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += part[i];
        }
        row.errors = truth->against(sum);
    }
    row.ratio = baseline / row.times.p50;
    row.note = "each pixel's own radius; no layers; timed on " + std::to_string(kGatherRows) + " rows";
    table.add(std::move(row));
    cv::setNumThreads(1);
}

}  // namespace ilf::bench
