// Draws ImGui's triangles into a picture on the CPU, so that a test can look at the window.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/geometry.h"

namespace ilf::ui::test {

/// What a texture id points to.
struct RasterTexture {
    Size size;
    std::vector<std::uint8_t> rgba;
};

/// RGBA of `data`, on black. Font texels come from `fontPixels`; all other texture ids are RasterTexture pointers.
inline std::vector<std::uint8_t> rasterised(const ImDrawData& data, const unsigned char* fontPixels, Size font) {
    const int width = static_cast<int>(data.DisplaySize.x), height = static_cast<int>(data.DisplaySize.y);
    std::vector<std::uint8_t> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, 0);
    const auto sample = [&](ImTextureID id, float u, float v, float rgba[4]) {
        const bool isFont = reinterpret_cast<const unsigned char*>(id) == fontPixels;
        const auto* texture = reinterpret_cast<const RasterTexture*>(id);
        const Size size = isFont ? font : texture->size;
        const std::uint8_t* texels = isFont ? fontPixels : texture->rgba.data();
        const float fx = u * static_cast<float>(size.width) - 0.5f, fy = v * static_cast<float>(size.height) - 0.5f;
        const int x = static_cast<int>(std::floor(fx)), y = static_cast<int>(std::floor(fy));
        const float ax = fx - static_cast<float>(x), ay = fy - static_cast<float>(y);
        for (int c = 0; c < 4; ++c)
            rgba[c] = 0;
        for (int j = 0; j < 2; ++j) {
            for (int i = 0; i < 2; ++i) {
                const int sx = std::clamp(x + i, 0, size.width - 1), sy = std::clamp(y + j, 0, size.height - 1);
                const float weight = (i ? ax : 1 - ax) * (j ? ay : 1 - ay);
                const std::uint8_t* texel =
                    texels + (static_cast<std::size_t>(sy) * static_cast<std::size_t>(size.width) +
                              static_cast<std::size_t>(sx)) *
                                 4;
                for (int c = 0; c < 4; ++c)
                    rgba[c] += weight * static_cast<float>(texel[c]) / 255.0f;
            }
        }
    };
    for (int n = 0; n < data.CmdListsCount; ++n) {
        const ImDrawList& list = *data.CmdLists[n];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const int clipX0 = std::max(0, static_cast<int>(command.ClipRect.x)),
                      clipY0 = std::max(0, static_cast<int>(command.ClipRect.y));
            const int clipX1 = std::min(width, static_cast<int>(command.ClipRect.z)),
                      clipY1 = std::min(height, static_cast<int>(command.ClipRect.w));
            for (unsigned e = 0; e + 2 < command.ElemCount; e += 3) {
                const ImDrawVert* v[3];
                for (unsigned k = 0; k < 3; ++k) {
                    const int index = list.IdxBuffer[static_cast<int>(command.IdxOffset + e + k)] +
                                      static_cast<int>(command.VtxOffset);
                    v[k] = &list.VtxBuffer[index];
                }
                const float area = (v[1]->pos.x - v[0]->pos.x) * (v[2]->pos.y - v[0]->pos.y) -
                                   (v[2]->pos.x - v[0]->pos.x) * (v[1]->pos.y - v[0]->pos.y);
                if (area == 0.0f) continue;
                const auto [minX, maxX] = std::minmax({v[0]->pos.x, v[1]->pos.x, v[2]->pos.x});
                const auto [minY, maxY] = std::minmax({v[0]->pos.y, v[1]->pos.y, v[2]->pos.y});
                for (int y = std::max(clipY0, static_cast<int>(minY)); y < std::min(clipY1, static_cast<int>(maxY) + 1);
                     ++y) {
                    for (int x = std::max(clipX0, static_cast<int>(minX));
                         x < std::min(clipX1, static_cast<int>(maxX) + 1); ++x) {
                        const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
                        float w[3];
                        for (int k = 0; k < 3; ++k) {
                            const ImVec2 a = v[(k + 1) % 3]->pos, b = v[(k + 2) % 3]->pos;
                            w[k] = ((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x)) / area;
                        }
                        // The top-left rule would keep shared edges from being drawn twice; half-open does nearly that.
                        if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
                        float u = 0, t = 0, colour[4] = {}, texel[4];
                        for (int k = 0; k < 3; ++k) {
                            u += w[k] * v[k]->uv.x;
                            t += w[k] * v[k]->uv.y;
                            for (int c = 0; c < 4; ++c)
                                colour[c] += w[k] * static_cast<float>((v[k]->col >> (8 * c)) & 255U) / 255.0f;
                        }
                        sample(command.TextureId, u, t, texel);
                        const float alpha = colour[3] * texel[3];
                        std::uint8_t* pixel = &out[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                                    static_cast<std::size_t>(x)) *
                                                   4];
                        for (int c = 0; c < 3; ++c) {
                            pixel[c] = static_cast<std::uint8_t>(static_cast<float>(pixel[c]) * (1 - alpha) +
                                                                 255.0f * colour[c] * texel[c] * alpha + 0.5f);
                        }
                        pixel[3] = 255;
                    }
                }
            }
        }
    }
    return out;
}

}  // namespace ilf::ui::test
