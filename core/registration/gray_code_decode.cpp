#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#include "core/base/parallel.h"
#include "core/registration/gray_code.h"
#include "core/registration/gray_code_bits.h"
#include "core/registration/gray_code_smooth.h"

namespace ilf {

namespace {

constexpr auto value(PixelState state) { return static_cast<std::uint8_t>(state); }

std::string sizeText(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

/// The pictures of a scan in the order of bits.
struct Sorted {
    const Image<std::uint8_t>*white = nullptr, *black = nullptr;
    using Axis = std::vector<std::pair<const Image<std::uint8_t>*, const Image<std::uint8_t>*>>;  // and inverse
    Axis columns, rows;
};

Result<Sorted> sorted(const Scan& scan) {
    using enum Pattern::Kind;
    if (scan.pictures.empty() || scan.pictures.size() != scan.patterns.size()) {
        return fail(Fault::outOfRange, "The scan has " + std::to_string(scan.pictures.size()) + " pictures for " +
                                           std::to_string(scan.patterns.size()) +
                                           " patterns: each pattern needs its picture.");
    }
    const Size raster = scan.projector;
    if (raster.width < 2 || raster.height < 2 || raster.width > 16384 || raster.height > 16384) {
        return fail(Fault::outOfRange, "A projector of " + sizeText(raster) +
                                           " pixels cannot be scanned: say its raster, such as 1024x768.");
    }
    Sorted out;
    out.columns.resize(static_cast<std::size_t>(bitsFor(raster.width)));
    out.rows.resize(static_cast<std::size_t>(bitsFor(raster.height)));
    const Size size = scan.pictures.front().size();
    for (std::size_t i = 0; i < scan.pictures.size(); ++i) {
        const Image<std::uint8_t>& picture = scan.pictures[i];
        const Pattern& pattern = scan.patterns[i];
        if (picture.empty() || picture.channels() != 1) {
            return fail(Fault::outOfRange, "Picture " + std::to_string(i) + " of the scan is not a grey picture.");
        }
        if (picture.size() != size) {
            return fail(Fault::outOfRange, "Picture " + std::to_string(i) + " of the scan has " +
                                               sizeText(picture.size()) + " pixels, the first " + sizeText(size) +
                                               ": all must come from one camera in one mode.");
        }
        if (pattern.kind == white) out.white = &picture;
        if (pattern.kind == black) out.black = &picture;
        if (pattern.kind != column && pattern.kind != row) continue;
        auto& axis = pattern.kind == column ? out.columns : out.rows;
        if (pattern.bit < 0 || pattern.bit >= static_cast<int>(axis.size())) {
            return fail(Fault::outOfRange, "Picture " + std::to_string(i) + " of the scan shows bit " +
                                               std::to_string(pattern.bit) + ", but a raster of " + sizeText(raster) +
                                               " has " + std::to_string(axis.size()) + " there: check --projector.");
        }
        auto& bit = axis[static_cast<std::size_t>(pattern.bit)];
        (pattern.inverse ? bit.second : bit.first) = &picture;
    }
    if (out.white == nullptr || out.black == nullptr) {
        return fail(Fault::outOfRange, "The scan has no picture of the projector all white and one all black: both are "
                                       "needed to tell light from shadow.");
    }
    for (const auto& [name, axis] : {std::pair{"column", &out.columns}, std::pair{"row", &out.rows}}) {
        for (std::size_t bit = 0; bit < axis->size(); ++bit) {
            if ((*axis)[bit].first == nullptr || (*axis)[bit].second == nullptr) {
                return fail(Fault::outOfRange, "The scan lacks " + std::string(name) + " bit " + std::to_string(bit) +
                                                   ((*axis)[bit].first == nullptr ? "" : " inverted") +
                                                   ": a raster of " + sizeText(raster) + " needs " +
                                                   std::to_string(axis->size()) + " bits with their inverses.");
            }
        }
    }
    return out;
}

std::vector<BitRows> rowsOf(const Sorted::Axis& axis, int y, std::size_t bits) {
    std::vector<BitRows> rows;
    for (std::size_t bit = 0; bit < bits; ++bit)
        rows.push_back({axis[bit].first->row(y), axis[bit].second->row(y)});
    return rows;
}

/// How many bits this camera resolves: the finest are left out while the median lit pixel sees less than 15 % of its
/// contrast in them. Their steps are then found between coarser ones.
std::size_t resolvedBits(const Sorted& scan, const Sorted::Axis& axis, double leastContrast) {
    const Image<std::uint8_t>&white = *scan.white, &black = *scan.black;
    std::size_t bits = axis.size();
    for (; bits > 2; --bits) {
        const auto& [picture, inverse] = axis[bits - 1];
        std::array<int, 101> shares{};
        int lit = 0;
        for (int y = 4; y < white.height(); y += 11) {
            for (int x = 4; x < white.width(); x += 7) {
                const int contrast = white.at(x, y) - black.at(x, y);
                if (contrast < 4.0 * leastContrast || white.at(x, y) == 255) continue;
                const int seen = std::abs(picture->at(x, y) - inverse->at(x, y));
                ++shares[static_cast<std::size_t>(std::min(100, 100 * seen / contrast))];
                ++lit;
            }
        }
        int below = 0;
        for (std::size_t share = 0; share < 15; ++share)
            below += shares[share];
        if (2 * below <= lit) break;
    }
    return bits;
}

/// Judges one pixel along one axis; what is left is how clear its bits are, as a share of its contrast.
struct Judge {
    double margin;
    /// The bit of the even edge may be unclear: then the pixel lies on that edge. Likewise the finest bit.
    bool clear(int contrast, int weakest, int second, int even) const {
        const double least = margin * contrast;
        return second >= least && (weakest >= least || even <= weakest);
    }
};

/// Whether the projector itself lights a pixel: then it follows some of the finer stripes. Where light comes from other
/// surfaces only, from everywhere at once, wide stripes show but fine ones cancel out (Nayar et al., "Fast separation
/// of direct and global components", SIGGRAPH 2006).
bool directlyLit(const std::vector<BitRows>& columns, const std::vector<BitRows>& rows, std::size_t x, double least) {
    constexpr std::size_t kFine = 4;  // bits: stripes of 2 to 16 steps
    for (const auto* bits : {&columns, &rows}) {
        for (std::size_t bit = bits->size() - std::min(kFine, bits->size()); bit < bits->size(); ++bit) {
            if (std::abs((*bits)[bit].picture[x] - (*bits)[bit].inverse[x]) >= least) return true;
        }
    }
    return false;
}

}  // namespace

Result<DecodedScan> decodedScan(const Scan& scan, const DecodeOptions& options) {
    const auto pictures = sorted(scan);
    if (!pictures) return tl::unexpected(pictures.error());
    const Image<std::uint8_t>&white = *pictures->white, &black = *pictures->black;
    const int width = white.width(), height = white.height();
    const auto columns = static_cast<std::size_t>(width);
    const std::size_t pixels = columns * static_cast<std::size_t>(height);
    const std::size_t bitsX = resolvedBits(*pictures, pictures->columns, options.leastContrast);
    const std::size_t bitsY = resolvedBits(*pictures, pictures->rows, options.leastContrast);
    const auto stepX = static_cast<float>(1 << (pictures->columns.size() - bitsX));
    const auto stepY = static_cast<float>(1 << (pictures->rows.size() - bitsY));
    const auto rasterX = static_cast<float>(scan.projector.width), rasterY = static_cast<float>(scan.projector.height);
    const Judge judge{options.leastMargin};

    Places places{white.size(), std::vector<float>(2 * pixels), std::vector<std::uint8_t>(pixels)};
    std::vector<std::uint8_t> clarity(pixels);
    parallelFor(height, [&](int y) {
        AxisRow alongX(width), alongY(width);
        std::vector<std::int16_t> contrast(columns);
        const std::uint8_t *w = white.row(y), *b = black.row(y);
        for (std::size_t x = 0; x < columns; ++x)
            contrast[x] = static_cast<std::int16_t>(std::max(0, w[x] - b[x]));
        const std::vector<BitRows> columnBits = rowsOf(pictures->columns, y, bitsX);
        const std::vector<BitRows> rowBits = rowsOf(pictures->rows, y, bitsY);
        readAxis(columnBits, contrast.data(), width, alongX);
        readAxis(rowBits, contrast.data(), width, alongY);
        for (std::size_t x = 0; x < columns; ++x) {
            const std::size_t n = static_cast<std::size_t>(y) * columns + x;
            const int c = contrast[x];
            PixelState state = PixelState::decoded;
            const float atX = stepX * betweenEdges(alongX.code[x], alongX.finest[x], alongX.even[x]);
            const float atY = stepY * betweenEdges(alongY.code[x], alongY.finest[x], alongY.even[x]);
            if (w[x] == 255) {
                state = PixelState::saturated;
            } else if (c < options.leastContrast) {
                state = PixelState::dark;
            } else if (!judge.clear(c, alongX.weakest[x], alongX.second[x], alongX.even[x]) ||
                       !judge.clear(c, alongY.weakest[x], alongY.second[x], alongY.even[x])) {
                const bool shadow =
                    c < 4.0 * options.leastContrast && !directlyLit(columnBits, rowBits, x, options.leastContrast);
                state = shadow ? PixelState::dark : PixelState::ambiguous;
            } else if (atX >= rasterX || atY >= rasterY) {
                state = PixelState::inconsistent;
            }
            places.state[n] = value(state);
            places.at[2 * n] = atX;
            places.at[2 * n + 1] = atY;
            const int clear = std::min(alongX.second[x], alongY.second[x]);
            clarity[n] = static_cast<std::uint8_t>(std::clamp(255 * 2 * clear / std::max(1, c), 0, 255));
        }
    });

    const std::array<double, 2> within{1.5 * double(stepX), 1.5 * double(stepY)};
    const std::vector<std::uint8_t> agreement = steadied(places, trendOf(places), within);
    withoutIslands(places);

    DecodedScan out;
    out.projector = scan.projector;
    std::vector<std::uint8_t> confidence(pixels, 0);
    constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
    std::vector<std::array<int, 5>> counts(static_cast<std::size_t>(height));
    parallelFor(height, [&](int y) {
        std::array<int, 5> count{};
        for (std::size_t n = static_cast<std::size_t>(y) * columns; n < static_cast<std::size_t>(y + 1) * columns;
             ++n) {
            ++count[places.state[n]];
            if (places.state[n] == value(PixelState::decoded)) {
                confidence[n] = static_cast<std::uint8_t>(std::max(1, clarity[n] * agreement[n] / 255));
            } else {
                places.at[2 * n] = places.at[2 * n + 1] = kNowhere;
            }
        }
        counts[static_cast<std::size_t>(y)] = count;
    });
    for (const auto& count : counts) {
        for (std::size_t state = 0; state < count.size(); ++state)
            out.count[state] += count[state];
    }
    out.projectorOfCamera = {white.size(), 2, std::move(places.at)};
    out.confidence = {white.size(), 1, std::move(confidence)};
    out.state = {white.size(), 1, std::move(places.state)};
    return out;
}

}  // namespace ilf
