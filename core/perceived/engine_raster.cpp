#include "core/perceived/engine_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ilf::view {
namespace {

/// Where one coordinate falls between two projector pixels.
struct Between {
    int first = 0, second = 0;
    float part = 0.0F;
    bool inside = false;
};
Between between(double at, int length) {
    Between b;
    b.inside = at >= 0.0 && at <= length;
    const double u = std::clamp(at - 0.5, 0.0, length - 1.0);
    b.first = static_cast<int>(u);
    b.second = std::min(b.first + 1, length - 1);
    b.part = static_cast<float>(u - b.first);
    return b;
}

}  // namespace

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

void LightRaster::sample(float* out, ViewRect tile, Size view,
                         const Homography<ProjectorFrame, CameraFrame>& toProjector, const ViewScale& scale) const {
    constexpr float kUnit = 1.0F / 255.0F;
    const Size size = image_.size();
    const int width = std::min(kTileW, view.width - tile.x0), height = std::min(kTileH, view.height - tile.y0);
    if (width < kTileW || height < kTileH) std::fill_n(out, kTilePixels, 0.0F);
    const auto& m = toProjector.m;
    const bool upright = m[1] == 0.0 && m[3] == 0.0 && m[6] == 0.0 && m[7] == 0.0;
    const auto value = [&](const Between& x, const Between& y) {
        const std::uint8_t* top = values_.data() + static_cast<std::ptrdiff_t>(y.first) * width_;
        const std::uint8_t* bottom = values_.data() + static_cast<std::ptrdiff_t>(y.second) * width_;
        const float above =
            static_cast<float>(top[x.first]) * (1.0F - x.part) + static_cast<float>(top[x.second]) * x.part;
        const float below =
            static_cast<float>(bottom[x.first]) * (1.0F - x.part) + static_cast<float>(bottom[x.second]) * x.part;
        return (above * (1.0F - y.part) + below * y.part) * kUnit;
    };
    if (!upright) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const auto at = toProjector({(tile.x0 + x + 0.5) / scale.x, (tile.y0 + y + 0.5) / scale.y});
                const Between u = between(at.x, size.width), v = between(at.y, size.height);
                out[y * kTileW + x] = u.inside && v.inside ? value(u, v) : 0.0F;
            }
        }
        return;
    }
    std::array<Between, kTileW> across;
    bool straight = true;  // pixel for pixel
    for (int x = 0; x < width; ++x) {
        Between& u = across[static_cast<std::size_t>(x)];
        u = between((m[0] * ((tile.x0 + x + 0.5) / scale.x) + m[2]) / m[8], size.width);
        straight = straight && u.inside && u.part == 0.0F && u.first == across[0].first + x;
    }
    for (int y = 0; y < height; ++y) {
        const Between v = between((m[4] * ((tile.y0 + y + 0.5) / scale.y) + m[5]) / m[8], size.height);
        float* row = out + y * kTileW;
        if (straight && v.inside && v.part == 0.0F) {
            const std::uint8_t* from = values_.data() + static_cast<std::ptrdiff_t>(v.first) * width_ + across[0].first;
            for (int x = 0; x < width; ++x)
                row[x] = static_cast<float>(from[x]) * kUnit;
            continue;
        }
        for (int x = 0; x < width; ++x) {
            const Between& u = across[static_cast<std::size_t>(x)];
            row[x] = u.inside && v.inside ? value(u, v) : 0.0F;
        }
    }
}

}  // namespace ilf::view
