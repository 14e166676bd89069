#include "core/registration/map_check.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "core/registration/gray_code_bits.h"

namespace ilf {

namespace {

constexpr double kFar_px = 4.0;
constexpr int kLeastStep = 10;  // between neighbours, of picture minus inverse: less is noise, not an edge

struct Sum {
    int edges = 0, far = 0;
    double squares = 0.0, largest = 0.0;
};

}  // namespace

Pattern checkPattern(Pattern::Kind kind, Size projector) {
    // Gray stripes of the bit n above the finest are 2^(n + 1) wide: n = 3.
    const int bits = bitsFor(kind == Pattern::Kind::row ? projector.height : projector.width);
    return {kind, std::max(0, bits - 4), false};
}

Result<MapCheck> mapCheck(const DenseMap& map, const Pattern& shown, const Image<std::uint8_t>& picture,
                          const Image<std::uint8_t>& inverse) {
    const bool columns = shown.kind == Pattern::Kind::column;
    if (!columns && shown.kind != Pattern::Kind::row)
        return fail(Fault::outOfRange, "A map is checked with stripes: show a column or a row pattern.");
    if (picture.size() != map.camera() || inverse.size() != map.camera() || picture.channels() != 1 ||
        inverse.channels() != 1) {
        return fail(Fault::outOfRange, "The check's pictures are not of the map's size, " +
                                           std::to_string(map.camera().width) + " x " +
                                           std::to_string(map.camera().height) + ": take them in the scan's mode.");
    }
    const int count = columns ? map.projector().width : map.projector().height;
    // Edges of this bit: at odd multiples of half its period.
    const double half = 1 << (bitsFor(count) - 1 - shown.bit);
    const int axis = columns ? 0 : 1;
    Sum sum;
    const auto look = [&](int x, int y, int toX, int toY) {
        if (map.confidence.at(x, y) == 0 || map.confidence.at(toX, toY) == 0) return;
        const int here = picture.at(x, y) - inverse.at(x, y), there = picture.at(toX, toY) - inverse.at(toX, toY);
        if ((here < 0) == (there < 0) || std::abs(here - there) < kLeastStep) return;
        const double share = static_cast<double>(here) / (here - there);
        const double from = static_cast<double>(map.projectorOfCamera.at(x, y, axis));
        const double to = static_cast<double>(map.projectorOfCamera.at(toX, toY, axis));
        if (std::abs(to - from) > half) return;  // a step in depth
        const double at = from + share * (to - from);
        const double edge = half * (2.0 * std::floor(at / (2.0 * half)) + 1.0);
        ++sum.edges;
        if (std::abs(at - edge) > kFar_px) {
            ++sum.far;
        } else {
            sum.squares += (at - edge) * (at - edge);
            sum.largest = std::max(sum.largest, std::abs(at - edge));
        }
    };
    for (int y = 0; y + 1 < picture.height(); ++y) {
        for (int x = 0; x + 1 < picture.width(); ++x) {
            look(x, y, x + 1, y);
            look(x, y, x, y + 1);
        }
    }
    MapCheck check;
    check.edges = sum.edges;
    check.rms_px = sum.edges > sum.far ? std::sqrt(sum.squares / (sum.edges - sum.far)) : 0.0;
    check.worst_px = sum.largest;
    check.beyond = sum.edges > 0 ? static_cast<double>(sum.far) / sum.edges : 0.0;
    return check;
}

}  // namespace ilf
