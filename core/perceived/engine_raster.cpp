#include "core/perceived/engine_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/perceived/engine_simd.h"

namespace ilf::view {
namespace {

BetweenPixels between(double at, int length) {
    BetweenPixels b;
    b.inside = at >= 0.0 && at <= length;
    if (!b.inside) return b;  // nor need it be a number
    const double u = std::clamp(at - 0.5, 0.0, length - 1.0);
    b.first = static_cast<int>(u);
    b.second = std::min(b.first + 1, length - 1);
    b.part = static_cast<float>(u - b.first);
    return b;
}

}  // namespace

LightMap::LightMap(const PixelMap& to, const ViewScale& scaled, Size of, Size lit)
    : map(to), scale(scaled), view(of), projector(lit) {
    if (map.dense()) {
        const auto width = static_cast<std::size_t>(view.width);
        scanned.resize(width * static_cast<std::size_t>(view.height));
        const int columnsOfTiles = (view.width + kTileW - 1) / kTileW,
                  rowsOfTiles = (view.height + kTileH - 1) / kTileH;
        touched.resize(static_cast<std::size_t>(columnsOfTiles) * static_cast<std::size_t>(rowsOfTiles));
        parallelFor(rowsOfTiles, [&](int row) {
            for (int y = row * kTileH; y < std::min(view.height, (row + 1) * kTileH); ++y) {
                for (int x = 0; x < view.width; ++x) {
                    const auto p = map.toProjector({(x + 0.5) / scale.x, (y + 0.5) / scale.y});
                    scanned[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = {
                        static_cast<float>(p.x), static_cast<float>(p.y)};
                    // A pixel between centres is lit by the pixels on both sides; one more for rounding.
                    const auto left = static_cast<int>(std::clamp(std::floor(p.x), -9.0, lit.width + 9.0));
                    const auto top = static_cast<int>(std::clamp(std::floor(p.y), -9.0, lit.height + 9.0));
                    auto& tile = touched[static_cast<std::size_t>(row * columnsOfTiles + x / kTileW)];
                    tile = tile.united({left - 2, top - 2, left + 3, top + 3});
                }
            }
        });
        return;
    }
    const auto& m = map.nearest().m;
    upright = m[1] == 0.0 && m[3] == 0.0 && m[6] == 0.0 && m[7] == 0.0;
    if (!upright) return;
    for (int x = 0; x < view.width; ++x)
        columns.push_back(between((m[0] * ((x + 0.5) / scale.x) + m[2]) / m[8], projector.width));
    for (int y = 0; y < view.height; ++y)
        rows.push_back(between((m[4] * ((y + 0.5) / scale.y) + m[5]) / m[8], projector.height));
}

bool LightMap::isFor(const PixelMap& other, const ViewScale& scaled, Size of, Size lit) const {
    const bool sameMap = other.dense() || map.dense() ? other.dense().same(map.dense()) : other == map;
    return sameMap && scaled.x == scale.x && scaled.y == scale.y && of == view && lit == projector;
}

Point<ProjectorFrame> LightMap::at(int x, int y) const {
    if (scanned.empty()) return map.toProjector({(x + 0.5) / scale.x, (y + 0.5) / scale.y});
    const auto& p =
        scanned[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x)];
    return {static_cast<double>(p[0]), static_cast<double>(p[1])};
}

std::vector<PixelRect<ProjectorFrame>> LightRaster::update(const LightImage& image) {
    std::vector<PixelRect<ProjectorFrame>> changed;
    const bool anew = image.size() != image_.size();
    if (anew) {
        width_ = image.columns() * kTile;
        height_ = image.rows() * kTile;
        values_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
    }
    for (int row = 0; row < image.rows(); ++row) {
        for (int column = 0; column < image.columns(); ++column) {
            if (!anew && image.tile(column, row).same(image_.tile(column, row))) continue;
            const Tile& tile = *image.tile(column, row);
            PixelRect<ProjectorFrame> part;
            for (int y = 0; y < kTile; ++y) {
                const std::uint8_t* now = tile.v.data() + y * kTile;
                std::uint8_t* kept =
                    values_.data() + static_cast<std::ptrdiff_t>(row * kTile + y) * width_ + column * kTile;
                const auto first = std::mismatch(now, now + kTile, kept).first - now;
                if (first == kTile) continue;
                auto last = static_cast<std::ptrdiff_t>(kTile);
                while (now[last - 1] == kept[last - 1])
                    --last;
                std::copy_n(now, kTile, kept);
                part = part.united({column * kTile + static_cast<int>(first), row * kTile + y,
                                    column * kTile + static_cast<int>(last), row * kTile + y + 1});
            }
            if (!part.empty()) changed.push_back(part);
        }
    }
    if (anew) changed = {{0, 0, image.size().width, image.size().height}};
    image_ = image;
    return changed;
}

void LightRaster::sample(float* out, ViewRect tile, const LightMap& map) const {
    constexpr float kUnit = 1.0F / 255.0F;
    const int width = std::min(kTileW, map.view.width - tile.x0), height = std::min(kTileH, map.view.height - tile.y0);
    if (width < kTileW || height < kTileH) std::fill_n(out, kTilePixels, 0.0F);
    const auto value = [&](const BetweenPixels& x, const BetweenPixels& y) {
        if (!x.inside || !y.inside) return 0.0F;
        const std::uint8_t* top = values_.data() + static_cast<std::ptrdiff_t>(y.first) * width_;
        const std::uint8_t* bottom = values_.data() + static_cast<std::ptrdiff_t>(y.second) * width_;
        const float above =
            static_cast<float>(top[x.first]) * (1.0F - x.part) + static_cast<float>(top[x.second]) * x.part;
        const float below =
            static_cast<float>(bottom[x.first]) * (1.0F - x.part) + static_cast<float>(bottom[x.second]) * x.part;
        return (above * (1.0F - y.part) + below * y.part) * kUnit;
    };
    if (!map.upright) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const auto at = map.at(tile.x0 + x, tile.y0 + y);
                out[y * kTileW + x] = value(between(at.x, map.projector.width), between(at.y, map.projector.height));
            }
        }
        return;
    }
    const BetweenPixels* across = map.columns.data() + tile.x0;
    bool straight = true;  // pixel for pixel
    for (int x = 0; x < width; ++x) {
        const BetweenPixels& u = across[x];
        straight = straight && u.inside && u.part == 0.0F && u.first == across[0].first + x;
    }
    for (int y = 0; y < height; ++y) {
        const BetweenPixels& v = map.rows[static_cast<std::size_t>(tile.y0 + y)];
        float* row = out + y * kTileW;
        if (straight && v.inside && v.part == 0.0F) {
            const std::uint8_t* from = values_.data() + static_cast<std::ptrdiff_t>(v.first) * width_ + across[0].first;
            fromBytes(row, from, width, kUnit);
            continue;
        }
        for (int x = 0; x < width; ++x)
            row[x] = value(across[x], v);
    }
}

}  // namespace ilf::view
