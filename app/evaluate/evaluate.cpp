#include "app/evaluate/evaluate.h"

#include <cmath>

namespace ilf::app {

MeanSpread meanSpread(const std::vector<double>& values) {
    MeanSpread out;
    for (const double v : values)
        out.mean += v / static_cast<double>(values.size());
    double squares = 0.0;
    for (const double v : values)
        squares += (v - out.mean) * (v - out.mean);
    if (values.size() > 1) out.spread = std::sqrt(squares / static_cast<double>(values.size() - 1));
    return out;
}

Result<Evaluation> evaluated(const EvaluateOptions& options) {
    Evaluation out;
    auto sizes = blurSizes(options);
    if (!sizes) return tl::unexpected(sizes.error());
    out.sizes = *std::move(sizes);
    out.range = blurRange(options);
    auto objects = fourObjects(options);
    if (!objects) return tl::unexpected(objects.error());
    out.objects = *std::move(objects);
    auto borders = seams(options);
    if (!borders) return tl::unexpected(borders.error());
    out.seams = *std::move(borders);
    return out;
}

}  // namespace ilf::app
