#include "core/registration/scan_orders.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/registration/gray_code_bits.h"
#include "core/registration/gray_code_smooth.h"

namespace ilf {

namespace {

using Picture8 = Image<std::uint8_t>;

Picture8 thinned(const Picture8& picture, int step) {
    const Size size{(picture.width() + step - 1) / step, (picture.height() + step - 1) / step};
    std::vector<std::uint8_t> pixels;
    pixels.reserve(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    for (int y = 0; y < picture.height(); y += step) {
        for (int x = 0; x < picture.width(); x += step)
            pixels.push_back(picture.at(x, y));
    }
    return {size, 1, std::move(pixels)};
}

template <class Combine>
Picture8 combined(const Picture8& a, const Picture8& b, Combine combine) {
    std::vector<std::uint8_t> pixels(a.pixels().size());
    for (std::size_t n = 0; n < pixels.size(); ++n)
        pixels[n] = static_cast<std::uint8_t>(std::clamp(combine(int{a.pixels()[n]}, int{b.pixels()[n]}), 0, 255));
    return {a.size(), 1, std::move(pixels)};
}

const Picture8* find(const Scan& scan, const Pattern& pattern) {
    const auto at = std::ranges::find(scan.patterns, pattern);
    return at == scan.patterns.end() ? nullptr : &scan.pictures[static_cast<std::size_t>(at - scan.patterns.begin())];
}

/// Patterns without a picture get one that follows from the others; a bit that neither picture nor inverse shows gets
/// two alike, which the decoder leaves out.
Scan completed(Scan scan) {
    Picture8 white = scan.pictures.front(), black = white;
    for (const Picture8& picture : scan.pictures) {
        white = combined(white, picture, [](int a, int b) { return std::max(a, b); });
        black = combined(black, picture, [](int a, int b) { return std::min(a, b); });
    }
    const Picture8 middle = combined(white, black, [](int a, int b) { return (a + b) / 2; });
    for (const Pattern& pattern : grayCodePatterns(scan.projector)) {
        if (find(scan, pattern) != nullptr) continue;
        Picture8 picture = middle;
        const Picture8* other = find(scan, {pattern.kind, pattern.bit, !pattern.inverse});
        if (pattern.kind == Pattern::Kind::white) {
            picture = white;
        } else if (pattern.kind == Pattern::Kind::black) {
            picture = black;
        } else if (other != nullptr) {
            const Picture8 sum = combined(middle, *other, [](int m, int o) { return 2 * m - o; });
            picture = sum;
        }
        scan.patterns.push_back(pattern);
        scan.pictures.push_back(picture);
    }
    return scan;
}

double readable(const Scan& scan) {
    const auto decoded = decodedScan(scan);
    return decoded ? readableShare(*decoded) : 0.0;
}

Scan lagged(const Scan& scan, std::size_t lag) {
    Scan out{scan.projector, {}, {}};
    for (std::size_t i = lag; i < scan.pictures.size(); ++i) {
        out.patterns.push_back(scan.patterns[i - lag]);
        out.pictures.push_back(scan.pictures[i]);
    }
    return completed(std::move(out));
}

std::vector<std::pair<std::string, std::vector<Pattern>>> knownOrders(Size projector) {
    using enum Pattern::Kind;
    const std::vector<Pattern> first = grayCodePatterns(projector);
    const auto columns = static_cast<std::ptrdiff_t>(2 * bitsFor(projector.width));
    std::vector<std::pair<std::string, std::vector<Pattern>>> orders{{"white and black first", first}};
    std::vector<Pattern> order = first;
    std::rotate(order.begin(), order.begin() + 2, order.end());
    orders.emplace_back("white and black last", order);
    order = first;
    std::rotate(order.begin() + 2, order.begin() + 2 + columns, order.end());
    orders.emplace_back("rows before columns", order);
    std::rotate(order.begin(), order.begin() + 2, order.end());
    orders.emplace_back("rows before columns, white and black last", order);
    for (std::size_t i = 0; i < 2; ++i) {
        order = orders[i].second;
        for (Pattern& pattern : order)
            pattern.inverse = !pattern.inverse && (pattern.kind == column || pattern.kind == row);
        orders.emplace_back(orders[i].first + ", each inverse before its pattern", order);
        order = orders[i].second;
        for (Pattern& pattern : order) {
            if (pattern.kind == column) pattern.bit = bitsFor(projector.width) - 1 - pattern.bit;
            if (pattern.kind == row) pattern.bit = bitsFor(projector.height) - 1 - pattern.bit;
        }
        orders.emplace_back(orders[i].first + ", finest stripes first", order);
    }
    return orders;
}

}  // namespace

double readableShare(const DecodedScan& decoded) {
    Places places{decoded.state.size(), {}, {}};
    const auto at = decoded.projectorOfCamera.pixels();
    const auto state = decoded.state.pixels();
    places.at.assign(at.begin(), at.end());
    places.state.assign(state.begin(), state.end());
    const Trend trend = trendOf(places);
    // A twelfth of the raster: depth of a whole room bends a map less, a wrong bit throws half the codes farther.
    const double near = std::max(decoded.projector.width, decoded.projector.height) / 12.0;
    const auto columns = static_cast<std::size_t>(places.camera.width);
    int onTrend = 0, lit = 0;
    for (std::size_t n = 0; n < state.size(); ++n) {
        const auto what = static_cast<PixelState>(state[n]);
        lit += what != PixelState::dark && what != PixelState::saturated;
        if (what != PixelState::decoded) continue;
        const auto i = static_cast<double>(n % columns), j = static_cast<double>(n / columns);
        onTrend += std::abs(trend[0] + trend[1] * i + trend[2] * j - double(at[2 * n])) < near &&
                   std::abs(trend[3] + trend[4] * i + trend[5] * j - double(at[2 * n + 1])) < near;
    }
    return static_cast<double>(onTrend) / std::max<double>(lit, static_cast<double>(state.size()) / 20.0);
}

std::optional<OtherReading> otherReading(const Scan& scan) {
    Scan small{scan.projector, scan.patterns, {}};
    const Size size = scan.pictures.front().size();
    const int step = std::clamp(std::min(size.width, size.height) / 200, 1, 4);
    for (const Picture8& picture : scan.pictures)
        small.pictures.push_back(thinned(picture, step));
    // Twice as much as its own reading, and a third of what is lit: chance alone decodes next to nothing.
    OtherReading best;
    best.share = std::max(1.0 / 3.0, 2.0 * readable(small));
    bool found = false;
    for (std::size_t lag = 1; lag <= 3 && lag + 2 < scan.pictures.size(); ++lag) {
        const double share = readable(lagged(small, lag));
        if (share > best.share) best = {static_cast<int>(lag), "", share}, found = true;
    }
    for (const auto& [words, order] : knownOrders(scan.projector)) {
        if (order.size() != small.pictures.size() || order == scan.patterns) continue;
        const double share = readable({scan.projector, order, small.pictures});
        if (share > best.share) best = {0, words, share}, found = true;
    }
    return found ? std::optional(best) : std::nullopt;
}

}  // namespace ilf
