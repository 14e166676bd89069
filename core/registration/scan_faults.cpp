#include "core/registration/scan_faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <opencv2/calib3d.hpp>

#include "core/registration/gray_code_bits.h"

namespace ilf {

namespace {

constexpr int kLit = 5;

struct Light {
    const Image<std::uint8_t>*white = nullptr, *black = nullptr;
};

Light lightOf(const Scan& scan) {
    Light light;
    for (std::size_t i = 0; i < scan.patterns.size(); ++i) {
        if (scan.patterns[i].kind == Pattern::Kind::white) light.white = &scan.pictures[i];
        if (scan.patterns[i].kind == Pattern::Kind::black) light.black = &scan.pictures[i];
    }
    return light;
}

double median(std::vector<double>& values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Means of a picture less its inverse over blocks of 8 x 8.
std::vector<double> blockChanges(const Image<std::uint8_t>& picture, const Image<std::uint8_t>& inverse) {
    constexpr int kBlock = 8;
    std::vector<double> changes;
    for (int y = 0; y + kBlock <= picture.height(); y += kBlock) {
        for (int x = 0; x + kBlock <= picture.width(); x += kBlock) {
            int sum = 0;
            for (int v = y; v < y + kBlock; ++v) {
                for (int u = x; u < x + kBlock; ++u)
                    sum += picture.at(u, v) - inverse.at(u, v);
            }
            changes.push_back(sum / double(kBlock * kBlock));
        }
    }
    return changes;
}

}  // namespace

std::vector<PatternPair> patternPairs(const Scan& scan) {
    std::vector<PatternPair> pairs;
    for (std::size_t i = 0; i < scan.patterns.size(); ++i) {
        const Pattern& pattern = scan.patterns[i];
        if ((pattern.kind != Pattern::Kind::column && pattern.kind != Pattern::Kind::row) || pattern.inverse) continue;
        const auto other = std::ranges::find(scan.patterns, Pattern{pattern.kind, pattern.bit, true});
        if (other == scan.patterns.end()) continue;
        const int bits = bitsFor(pattern.kind == Pattern::Kind::column ? scan.projector.width : scan.projector.height);
        pairs.push_back({static_cast<int>(i), static_cast<int>(other - scan.patterns.begin()), bits - 1 - pattern.bit});
    }
    std::ranges::sort(pairs, {}, [](const PatternPair& pair) { return std::min(pair.picture, pair.inverse); });
    return pairs;
}

ScanLight scanLight(const Scan& scan) {
    const auto [white, black] = lightOf(scan);
    ScanLight light;
    const auto w = white->pixels(), b = black->pixels();
    std::vector<double> contrasts, shares;
    std::array<std::size_t, 256> levels{};
    std::size_t ends = 0;
    for (std::size_t n = 0; n < w.size(); ++n) {
        ++levels[w[n]];
        light.saturated += w[n] == 255;
        ends += b[n] == 255;
        const int contrast = w[n] - b[n];
        if (contrast < kLit || w[n] == 255) continue;
        ++light.lit;
        contrasts.push_back(contrast);
        shares.push_back(static_cast<double>(contrast) / w[n]);
    }
    light.contrast = median(contrasts);
    light.projectorShare = median(shares);
    light.blackSaturated = static_cast<double>(ends) / static_cast<double>(w.size());
    for (std::size_t above = 0; light.brightest < 255; ++light.brightest) {
        above = 0;
        for (auto level = static_cast<std::size_t>(light.brightest) + 1; level < levels.size(); ++level)
            above += levels[level];
        if (100 * above < w.size()) break;
    }
    // Whether anything follows the patterns at all, whatever white and black show: means over blocks, since noise alone
    // changes pixels, and less the median of all, since a lamp that flickers changes everything at once.
    for (const PatternPair& pair : patternPairs(scan)) {
        constexpr double kFollows = 2.5;  // of 255; noise of 4 leaves 0.7 between two means of 64 pixels
        std::vector<double> changes = blockChanges(scan.pictures[static_cast<std::size_t>(pair.picture)],
                                                   scan.pictures[static_cast<std::size_t>(pair.inverse)]);
        if (changes.empty()) continue;
        std::vector<double> sorted = changes;
        const double all = median(sorted);
        const auto following = std::ranges::count_if(changes, [&](double d) { return std::abs(d - all) >= kFollows; });
        light.following =
            std::max(light.following, static_cast<double>(following) / static_cast<double>(changes.size()));
    }
    return light;
}

std::vector<std::pair<int, int>> staleFrames(const Scan& scan) {
    const auto [white, black] = lightOf(scan);
    std::vector<std::pair<int, int>> stale;
    int wide = 0, clear = 0;
    for (const PatternPair& pair : patternPairs(scan)) {
        constexpr int kWide = 3;  // half a stripe in raster pixels is 2^level; finer ones may be blurred away
        if (pair.level < kWide) continue;
        const auto& p = scan.pictures[static_cast<std::size_t>(pair.picture)];
        const auto& i = scan.pictures[static_cast<std::size_t>(pair.inverse)];
        std::vector<double> shares;
        for (int y = 2; y < p.height(); y += 5) {
            for (int x = 2; x < p.width(); x += 5) {
                const int contrast = white->at(x, y) - black->at(x, y);
                if (contrast < 4 * kLit || white->at(x, y) == 255) continue;
                shares.push_back(static_cast<double>(std::abs(p.at(x, y) - i.at(x, y))) / contrast);
            }
        }
        if (shares.size() < 50) continue;
        // Nearly all pixels: where light of two places mixes, half of them may be unclear in one bit.
        const auto most = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() * 4 / 5);
        std::nth_element(shares.begin(), most, shares.end());
        const double share = *most;
        ++wide;
        clear += share > 0.6;
        if (share < 0.3) stale.emplace_back(std::min(pair.picture, pair.inverse), std::max(pair.picture, pair.inverse));
    }
    // Where most pairs are unclear it is not single frames that are wrong.
    if (2 * clear < wide) stale.clear();
    return stale;
}

Mixed mixedLight(const Scan& scan, const DecodedScan& decoded) {
    const auto [white, black] = lightOf(scan);
    constexpr int kWell = 20;
    Mixed mixed;
    int lit = 0, unclear = 0;
    for (int y = 0; y < white->height(); ++y) {
        for (int x = 0; x < white->width(); ++x) {
            if (white->at(x, y) - black->at(x, y) < kWell || white->at(x, y) == 255) continue;
            ++lit;
            unclear += decoded.state.at(x, y) == static_cast<std::uint8_t>(PixelState::ambiguous) ||
                       decoded.state.at(x, y) == static_cast<std::uint8_t>(PixelState::inconsistent);
        }
    }
    mixed.share = lit > 0 ? static_cast<double>(unclear) / lit : 0.0;
    mixed.area = areaOf(decoded, PixelState::ambiguous);
    return mixed;
}

PixelRect<CameraFrame> areaOf(const DecodedScan& decoded, PixelState state) {
    const int width = decoded.state.width(), height = decoded.state.height();
    std::vector<int> columns(static_cast<std::size_t>(width), 0), rows(static_cast<std::size_t>(height), 0);
    int total = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (decoded.state.at(x, y) != static_cast<std::uint8_t>(state)) continue;
            ++columns[static_cast<std::size_t>(x)];
            ++rows[static_cast<std::size_t>(y)];
            ++total;
        }
    }
    if (total == 0) return {};
    const auto ends = [&](const std::vector<int>& counts) {
        int below = 0, from = 0, to = static_cast<int>(counts.size());
        for (int i = 0; i < static_cast<int>(counts.size()); ++i) {
            if (20 * below <= total) from = i;
            below += counts[static_cast<std::size_t>(i)];
            if (20 * below < 19 * total) to = i + 2;
        }
        return std::pair(from, std::min(to, static_cast<int>(counts.size())));
    };
    const auto [x0, x1] = ends(columns);
    const auto [y0, y1] = ends(rows);
    return {x0, y0, x1, y1};
}

bool isFlat(const DecodedScan& decoded) {
    const int step = std::max(1, std::min(decoded.state.width(), decoded.state.height()) / 50);
    std::vector<cv::Point2d> from, to;
    for (int y = step / 2; y < decoded.state.height(); y += step) {
        for (int x = step / 2; x < decoded.state.width(); x += step) {
            if (decoded.confidence.at(x, y) == 0) continue;
            from.emplace_back(x, y);
            to.emplace_back(decoded.projectorOfCamera.at(x, y, 0), decoded.projectorOfCamera.at(x, y, 1));
        }
    }
    if (from.size() < 20) return false;
    try {
        std::vector<unsigned char> on;
        const cv::Mat plane = cv::findHomography(from, to, cv::RANSAC, 1.0, on, 500);
        return !plane.empty() &&
               10 * static_cast<std::size_t>(std::ranges::count_if(on, [](unsigned char in) { return in != 0; })) >=
                   9 * on.size();
    } catch (const cv::Exception&) {
        return false;
    }
}

}  // namespace ilf
