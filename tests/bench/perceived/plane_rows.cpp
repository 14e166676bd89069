#include "tests/bench/perceived/plane_rows.h"

#include <cmath>

#include "core/base/parallel.h"
#include "tests/bench/perceived/kernels.h"
#include "tests/bench/perceived/textures.h"

namespace ilf::bench {
namespace {

constexpr Size kSize{1024, 768};
/// A gather with its own radius takes seconds for a whole plane: it is timed on these rows, and the time scaled.
constexpr int kGatherRows = 24;

struct Picture2 {
    std::string name;
    std::vector<float> values;
    cv::Mat mat() { return {kSize.height, kSize.width, CV_32F, values.data()}; }
};

/// Peak signal-to-noise ratio and worst pixel of `seen` against `exact`.
std::pair<double, double> against(const cv::Mat& exact, const cv::Mat& seen) {
    cv::Mat wide, apart;
    seen.convertTo(wide, CV_64F);
    cv::absdiff(wide, exact, apart);
    double worst = 0.0;
    cv::minMaxLoc(apart, nullptr, &worst);
    return {-10.0 * std::log10(cv::mean(apart.mul(apart))[0]), worst};
}

/// Loops of the engine inside `work` stay on one thread.
void alone(const std::function<void()>& work) {
    parallelFor(2, [&](int i) {
        if (i == 0) work();
    });
}

std::string decibels(const std::string& of, double value) {
    char text[48];
    std::snprintf(text, sizeof text, "%s %.1f dB", of.c_str(), value);
    return text;
}

}  // namespace

void addPlaneRows(Table& table, const Machine& machine, const Patience& patience) {
    cv::setNumThreads(1);
    std::vector<Picture2> pictures{{"text", plane(kSize, Texture::text, 12345)},
                                   {"natural", plane(kSize, Texture::natural, 12346)},
                                   {"lights", plane(kSize, Texture::lights, 12347)}};
    std::vector<Blur> all{{"engine exact", engineExact}, {"engine at rest", engineAtRest}};
    all.insert(all.end(), libraryBlurs().begin(), libraryBlurs().end());
    const double pixels = static_cast<double>(kSize.width) * kSize.height;
    for (const double radius : {3.0, 5.0, 8.0, 12.0, 20.0, 40.0}) {
        const std::string what = "r = " + std::to_string(static_cast<int>(radius));
        std::vector<cv::Mat> exact;
        for (Picture2& picture : pictures)
            exact.push_back(exactBlur(picture.mat(), radius));
        const auto describe = [&](Row& row, const std::function<cv::Mat(const cv::Mat&)>& blur, cv::Rect part) {
            for (std::size_t p = 0; p < pictures.size(); ++p) {
                const auto [psnr, worst] = against(exact[p](part), blur(pictures[p].mat()));
                if (p == 0) {
                    row.errors.psnr = psnr;
                    row.errors.worst = worst;
                } else {
                    row.note += (row.note.empty() ? "" : "; ") + decibels(pictures[p].name, psnr);
                }
            }
            // Twelve products for each pixel of radius: what the perimeter of the disc alone takes.
            row.ofFma = 12.0 * radius * pixels * 2.0 / (machine.gflops * 1e6) / row.times.p50;
            row.ofMemory = 2.0 * sizeof(float) * pixels / (machine.triad1 * 1e6) / row.times.p50;
        };
        double baseline = kNothing;
        std::vector<Row> rows;
        for (const Blur& blur : all) {
            Row row{.section = "plane", .scene = "1 plane", .method = blur.name, .what = what, .threads = 1};
            cv::Mat out;
            const cv::Mat in = pictures[0].mat();
            row.times = timed(patience, [&](int) { alone([&] { out = blur.run(in, radius); }); });
            describe(row, [&](const cv::Mat& m) { return blur.run(m, radius); }, {0, 0, kSize.width, kSize.height});
            if (blur.name == "filter2D") baseline = row.times.p50;
            rows.push_back(std::move(row));
        }
        Row row{.section = "plane", .scene = "1 plane", .method = "gather", .what = what, .threads = 1};
        const cv::Mat radii(kSize.height, kSize.width, CV_32F, cv::Scalar(radius));
        const cv::Mat in = pictures[0].mat();
        row.times = timed({0.3 * patience.seconds, 10, 2, 30}, [&](int) { gatheredRows(in, radii, kGatherRows); });
        const double scale = static_cast<double>(kSize.height) / kGatherRows;
        row.times.p50 *= scale;
        row.times.p95 *= scale;
        row.times.least *= scale;
        describe(row, [&](const cv::Mat& m) { return gatheredRows(m, radii, kGatherRows); },
                 {0, (kSize.height - kGatherRows) / 2, kSize.width, kGatherRows});
        row.note += "; timed on " + std::to_string(kGatherRows) + " rows";
        rows.push_back(std::move(row));
        for (Row& made : rows) {
            made.ratio = baseline / made.times.p50;
            table.add(std::move(made));
        }
    }
}

}  // namespace ilf::bench
