#include "core/perceived/seam_cells.h"

#include <cmath>
#include <map>
#include <utility>

namespace ilf::view {
namespace {

/// Profiles are at most this many patch pixels to each side; longer ones are worked out on coarser pixels.
constexpr double kMostReach = 40.0;
/// Profiles worked out in one cell.
constexpr std::size_t kLines = 6;

}  // namespace

int SeamBorder::samples() const { return static_cast<int>(std::ceil(reach / pitch)); }

SeamCells::SeamCells(const Compiled& compiled, int most, const std::function<bool()>& stopped)
    : compiled_(compiled), regions_(compiled) {
    std::size_t all = 0;
    for (const WholeBorder& whole : wholeBorders(regions_)) {
        if (stopped()) return;
        SeamBorder border{whole.blurred, whole.other, *regions_.all()[whole.blurred].displaced, 0.0, 1.0, {}, 0, 0};
        border.crossings = whole.crossings.size();
        // The same reach along a border: of where it is largest among a few places.
        for (std::size_t i = 0; i < whole.crossings.size(); i += 1 + whole.crossings.size() / 16) {
            const SeamLine line = lineAt(whole.crossings[i]);
            const auto distance = distanceOf(whole.blurred, line.at);
            if (!distance) continue;
            const auto displaced = displacementAt(compiled_, line.at, line.nx, line.ny, *distance, border.power);
            border.reach = std::max(border.reach, displaced.reach(compiled_.document.seam));
        }
        if (border.reach == 0.0) continue;
        border.pitch = std::max(1.0, border.reach / kMostReach);
        const double step_deg = border.pitch / compiled_.document.scene.scale.focalPixels * 57.29577951;
        border.weighting.emplace(step_deg, 2 * border.samples() + 1);
        borders.push_back(std::move(border));
        all += add(whole);
    }
    thinOut(all, most);
}

SeamLine SeamCells::lineAt(const Crossing& crossing) const {
    const auto [nx, ny] = normalAt(regions_, crossing);
    return {crossing.at(), nx, ny};
}

std::optional<Metre> SeamCells::distanceOf(std::size_t region, Point<CameraFrame> at) const {
    return distanceAt(compiled_.document, *regions_.all()[region].region, at);
}

/// Squares about as wide as the seam reaches.
std::size_t SeamCells::add(const WholeBorder& whole) {
    SeamBorder& border = borders.back();
    const int side = std::max(16, static_cast<int>(border.reach));
    std::map<std::pair<int, int>, std::vector<Crossing>> squares;
    for (const Crossing& crossing : whole.crossings)
        squares[{crossing.y / side, crossing.x / side}].push_back(crossing);
    for (const auto& [square, crossings] : squares) {
        const Crossing& middle = crossings[crossings.size() / 2];
        const SeamLine line = lineAt(middle);
        const auto distance = distanceOf(whole.blurred, line.at);
        if (!distance) continue;
        cells.push_back(cellOf(whole, crossings, line, *distance));
        ++border.cells;
    }
    return squares.size();
}

SeamCell SeamCells::cellOf(const WholeBorder& whole, const std::vector<Crossing>& crossings, const SeamLine& line,
                           Metre distance) const {
    SeamCell cell;
    cell.border = borders.size() - 1;
    cell.distance = distance;
    cell.displaced = displacementAt(compiled_, line.at, line.nx, line.ny, distance, borders.back().power);
    const auto behind = distanceOf(whole.other, line.at);
    cell.depthStep = behind && abs(1.0 / *behind - 1.0 / distance) > kDepthStep;
    for (std::size_t r = 0; r < regions_.all().size(); ++r) {
        const auto d = distanceOf(r, line.at);
        const auto like = [&](std::size_t one, std::optional<Metre> at) {
            return r == one || (regions_.all()[r].level == regions_.all()[one].level && d && at &&
                                abs(1.0 / *d - 1.0 / *at) < 1e-3_D);
        };
        cell.kin.push_back(like(whole.blurred, distance) || like(whole.other, behind));
    }
    // Pixel edges along a slanted line are longer than it, by 4 / pi on average.
    cell.length_m = static_cast<double>(crossings.size()) * 0.785 / cell.displaced.pixelsPerMetre;
    const std::size_t count = std::min(kLines, crossings.size());
    for (std::size_t i = 0; i < count; ++i)
        cell.lines.push_back(lineAt(crossings[(2 * i + 1) * crossings.size() / (2 * count)]));
    return cell;
}

/// Every n-th cell of a border, so that a scene with long borders takes no longer than one with short ones.
void SeamCells::thinOut(std::size_t all, int limit) {
    const auto most = static_cast<std::size_t>(std::max(1, limit));
    if (all <= most) return;
    const std::size_t step = (all + most - 1) / most;
    std::vector<SeamCell> kept;
    std::vector<std::size_t> seen(borders.size());
    for (SeamCell& cell : cells) {
        if (seen[cell.border]++ % step == 0) kept.push_back(std::move(cell));
    }
    cells = std::move(kept);
}

PatchWindow SeamCells::windowOf(const SeamCell& cell) const {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const SeamLine& line : cell.lines) {
        x0 = std::min(x0, line.at.x);
        x1 = std::max(x1, line.at.x);
        y0 = std::min(y0, line.at.y);
        y1 = std::max(y1, line.at.y);
    }
    const SeamBorder& border = borders[cell.border];
    const double halo = border.reach + cell.displaced.radius + cell.displaced.shift + 3.0 * border.pitch;
    return PatchWindow::around(x0, y0, x1, y1, std::min(halo, 4.0 * kMostReach * border.pitch), border.pitch);
}

std::vector<Point<CameraFrame>> SeamCells::profile(const SeamLine& line, const SeamCell& cell) const {
    const SeamBorder& border = borders[cell.border];
    const int reach = border.samples();
    const double margin = cell.displaced.radius + std::abs(cell.displaced.seam());
    const int blur = static_cast<int>(std::ceil(margin / border.pitch));
    const auto point = [&](int i) {
        return Point<CameraFrame>{line.at.x + i * border.pitch * line.nx, line.at.y + i * border.pitch * line.ny};
    };
    const auto last = [&](int side) {
        int i = 0;
        for (; i < reach; ++i) {
            const auto p = point(side * (i + 1));
            const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
            if (!regions_.inside(x, y)) return i;
            if (!cell.kin[regions_.owner(x, y)]) return i - blur;
        }
        return i;
    };
    std::vector<Point<CameraFrame>> points;
    for (int i = -last(-1); i <= last(1); ++i)
        points.push_back(point(i));
    return points;
}

PixelRect<CameraFrame> SeamCells::around(const SeamCell& cell) const {
    const PatchWindow window = windowOf(cell);
    const double more = 0.5 * cell.displaced.radius + 8.0;
    return {static_cast<int>(window.x0 - more), static_cast<int>(window.y0 - more),
            static_cast<int>(window.x0 + window.pitch * window.size.width + more) + 1,
            static_cast<int>(window.y0 + window.pitch * window.size.height + more) + 1};
}

Metre SeamCells::extentOf(std::size_t b) const {
    const SeamBorder& border = borders[b];
    double pixels = 0.0, metre = 1.0;
    int x0 = 1 << 30, y0 = 1 << 30, x1 = 0, y1 = 0;
    for (int y = 0; y < regions_.size().height; y += 4) {
        for (int x = 0; x < regions_.size().width; x += 4) {
            if (regions_.owner(x, y) != border.blurred) continue;
            pixels += 16.0;
            x0 = std::min(x0, x);
            x1 = std::max(x1, x + 4);
            y0 = std::min(y0, y);
            y1 = std::max(y1, y + 4);
        }
    }
    for (const SeamCell& cell : cells) {
        if (cell.border == b) metre = cell.displaced.pixelsPerMetre;
    }
    const double outline = 0.785 * static_cast<double>(border.crossings);
    const double side = std::min(std::max(0, x1 - x0), std::max(0, y1 - y0));
    return Metre::fromSi(std::min(side, 4.0 * pixels / std::max(1.0, outline)) / metre);
}

}  // namespace ilf::view
