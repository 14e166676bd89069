#include "core/document/depth_seen.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/document/seen_pixels.h"

namespace ilf {

namespace {

constexpr double kDeviations = 2.0;  // of a pixel's depth, towards and away

int wholeTiles(const Region& region, Size picture) {
    if (region.id == kBackgroundId) return TileGrid(picture).columns() * TileGrid(picture).rows();
    int whole = 0;
    for (int row = 0; row < region.mask.rows(); ++row) {
        for (int column = 0; column < region.mask.columns(); ++column)
            whole += region.mask.isUniform(column, row, 255);
    }
    return whole;
}

/// Positive floats sort like their bits: a bin for every 2048 of them from 10 mm to 1000 m is 0.025 % wide or less.
/// Each bin remembers its extreme, so that a quantile is a value that occurs.
class Bins {
public:
    explicit Bins(bool least) : least_(least), bins_(kBins) {}

    void add(float value, std::uint32_t weight) {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(std::max(value, kLow));
        Bin& bin = bins_[std::min<std::size_t>((bits - kFirst) >> kShift, kBins - 1)];
        const bool beyond = least_ ? value < bin.extreme : value > bin.extreme;
        if (bin.weight == 0 || beyond) bin.extreme = value;
        bin.weight += weight;
        total_ += weight;
    }
    std::uint64_t total() const { return total_; }

    /// The value with a thousandth of all weight below it (or above it, for the farthest).
    float quantile() const {
        const std::uint64_t strays = total_ / 1000;
        std::uint64_t passed = 0;
        const auto reached = [&](const Bin& bin) { return (passed += bin.weight) > strays; };
        return least_ ? std::find_if(bins_.begin(), bins_.end(), reached)->extreme
                      : std::find_if(bins_.rbegin(), bins_.rend(), reached)->extreme;
    }

private:
    struct Bin {
        std::uint32_t weight = 0;
        float extreme = 0.0F;
    };
    static constexpr float kLow = 0.01F, kHigh = 1000.0F;
    static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(kLow);
    static constexpr int kShift = 11;
    static constexpr std::size_t kBins = ((std::bit_cast<std::uint32_t>(kHigh) - kFirst) >> kShift) + 1;

    bool least_;
    std::vector<Bin> bins_;
    std::uint64_t total_ = 0;
};

}  // namespace

std::optional<DepthSeen> depthSeen(const Document& document, const Region& region) {
    const Box<DepthMap>& depth = document.scene.depth;
    if (!depth || depth->metres.size() != document.scene.size()) return std::nullopt;
    const bool sigmaKnown = depth->sigma.size() == depth->metres.size();
    // A plan asks this after every dab. Of a large region every fourth pixel each way, where it is whole, tells the
    // quantiles; of a small one, a single stray pixel that was picked would weigh too much.
    constexpr int kSparse = 4;
    const bool large = wholeTiles(region, document.scene.size()) > 64;
    Bins nearest(true), farthest(false);
    std::uint64_t holes = 0;
    double sigmas = 0.0;
    forEachSeenTile(document, region, [&](const SeenTile& seen) {
        const int step = large && seen.all ? kSparse : 1;
        const auto weight = static_cast<std::uint32_t>(step * step);
        for (int y = seen.pixels.y0; y < seen.pixels.y1; y += step) {
            const float* metres = depth->metres.row(y);
            const float* sigma = sigmaKnown ? depth->sigma.row(y) : nullptr;
            for (int x = seen.pixels.x0; x < seen.pixels.x1; x += step) {
                if (!seen.at(x, y)) continue;
                if (!(metres[x] > 0.0F)) {
                    holes += weight;
                    continue;
                }
                const float off = sigma != nullptr ? static_cast<float>(kDeviations) * sigma[x] : 0.0F;
                nearest.add(off < 0.5F * metres[x] ? metres[x] - off : 0.5F * metres[x], weight);
                farthest.add(metres[x] + off, weight);
                if (sigma != nullptr) sigmas += static_cast<double>(weight) * static_cast<double>(sigma[x]);
            }
        }
    });
    const std::uint64_t measured = nearest.total();
    if (measured == 0) return std::nullopt;
    return DepthSeen{Metre::fromSi(static_cast<double>(nearest.quantile())),
                     Metre::fromSi(static_cast<double>(farthest.quantile())),
                     static_cast<double>(holes) / static_cast<double>(holes + measured),
                     Metre::fromSi(sigmas / static_cast<double>(measured))};
}

}  // namespace ilf
