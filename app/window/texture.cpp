#include "app/window/texture.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace ilf::app {
namespace {

std::vector<std::uint8_t> toRgba(const Image<std::uint8_t>& image) {
    const auto source = image.pixels();
    const std::size_t channels = static_cast<std::size_t>(image.channels());
    const std::size_t count = source.size() / channels;
    std::vector<std::uint8_t> rgba(count * 4);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* from = &source[i * channels];
        std::uint8_t* to = &rgba[i * 4];
        to[0] = from[0];
        to[1] = from[channels >= 3 ? 1 : 0];
        to[2] = from[channels >= 3 ? 2 : 0];
        to[3] = channels == 4 ? from[3] : 255;
    }
    return rgba;
}

}  // namespace

GlTexture::~GlTexture() { clear(); }

GlTexture::GlTexture(GlTexture&& other) noexcept
    : id_(std::exchange(other.id_, 0)), size_(std::exchange(other.size_, {})) {}

GlTexture& GlTexture::operator=(GlTexture&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(size_, other.size_);
    return *this;
}

void GlTexture::clear() {
    if (id_ != 0) glDeleteTextures(1, &id_);
    id_ = 0;
    size_ = {};
}

void GlTexture::create(Size size, bool smooth) {
    clear();
    glGenTextures(1, &id_);
    glBindTexture(GL_TEXTURE_2D, id_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, smooth ? GL_LINEAR : GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    size_ = size;
}

void GlTexture::upload(const Image<std::uint8_t>& image, bool smooth) {
    const std::vector<std::uint8_t> rgba = toRgba(image);
    const bool fits = id_ != 0 && size_ == image.size();
    if (!fits) create(image.size(), smooth);
    glBindTexture(GL_TEXTURE_2D, id_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (fits) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size_.width, size_.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    } else {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size_.width, size_.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    }
}

bool GlTexture::reserve(Size size, bool smooth) {
    if (id_ != 0 && size_ == size) return false;
    create(size, smooth);
    const std::vector<std::uint8_t> nothing(static_cast<std::size_t>(size.width) *
                                            static_cast<std::size_t>(size.height) * 4);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nothing.data());
    return true;
}

void GlTexture::uploadPart(int x, int y, int width, int height, std::span<const std::uint8_t> rgba) {
    glBindTexture(GL_TEXTURE_2D, id_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, width);
    glTexSubImage2D(GL_TEXTURE_2D, 0, x, y, std::min(width, size_.width - x), std::min(height, size_.height - y),
                    GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

}  // namespace ilf::app
