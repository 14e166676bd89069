// An immutable picture: width x height x channels numbers, interleaved, shared when copied.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/base/geometry.h"

namespace ilf {

/// Row-major, channels interleaved, rows without padding. Copies share the pixels, which never change.
template <class T>
class Image {
public:
    Image() = default;
    /// Takes `pixels`, whose length must be width * height * channels.
    Image(Size size, int channels, std::vector<T> pixels)
        : size_(size), channels_(channels), pixels_(std::make_shared<const std::vector<T>>(std::move(pixels))) {
        assert(pixels_->size() == static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) *
                                      static_cast<std::size_t>(channels));
    }

    Size size() const { return size_; }
    int width() const { return size_.width; }
    int height() const { return size_.height; }
    int channels() const { return channels_; }
    bool empty() const { return !pixels_; }
    std::span<const T> pixels() const { return pixels_ ? std::span<const T>(*pixels_) : std::span<const T>(); }
    const T* row(int y) const { return pixels_->data() + static_cast<std::size_t>(y) * stride(); }
    T at(int x, int y, int channel = 0) const {
        return row(
            y)[static_cast<std::size_t>(x) * static_cast<std::size_t>(channels_) + static_cast<std::size_t>(channel)];
    }
    /// Numbers in a row.
    std::size_t stride() const { return static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(channels_); }
    bool same(const Image& other) const { return pixels_ == other.pixels_ && size_ == other.size_; }

    bool operator==(const Image& other) const {
        return size_ == other.size_ && channels_ == other.channels_ &&
               (pixels_ == other.pixels_ || (pixels_ && other.pixels_ && *pixels_ == *other.pixels_));
    }

private:
    Size size_;
    int channels_ = 0;
    std::shared_ptr<const std::vector<T>> pixels_;
};

/// A picture as files and cameras give it: RGB, 16 bits a channel, sRGB-encoded (8-bit sources are multiplied by 257).
using Picture = Image<std::uint16_t>;
/// Linear radiance, 1 = the brightest the picture shows in steady light. 3 channels RGB, or 1.
using Radiance = Image<float>;

}  // namespace ilf
