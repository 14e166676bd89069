// A GL texture that is uploaded whole or tile by tile.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/image.h"
#include "ui/view.h"

namespace ilf::app {

/// Owns one 2-D texture of 8-bit RGBA. Use on the thread of the GL context, and destroy it before the context.
class GlTexture {
public:
    GlTexture() = default;
    ~GlTexture();
    GlTexture(GlTexture&& other) noexcept;
    GlTexture& operator=(GlTexture&& other) noexcept;
    GlTexture(const GlTexture&) = delete;
    GlTexture& operator=(const GlTexture&) = delete;

    /// 1 (grey), 3 (RGB) or 4 (RGBA) channels. `smooth`: linear filtering when magnified; else pixels stay square.
    void upload(const Image<std::uint8_t>& image, bool smooth);
    /// Makes an empty (transparent) texture of `size` unless it already has it; true if it was made anew.
    bool reserve(Size size, bool smooth);
    /// Replaces a rectangle, cut to the texture; `rgba` has width * height * 4 values.
    void uploadPart(int x, int y, int width, int height, std::span<const std::uint8_t> rgba);
    void clear();

    ui::Texture handle() const { return {id_, size_}; }
    Size size() const { return size_; }

private:
    void create(Size size, bool smooth);
    unsigned id_ = 0;
    Size size_;
};

}  // namespace ilf::app
