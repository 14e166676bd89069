#include "core/base/grey.h"

#include <vector>

namespace ilf {

namespace {

template <class T>
Image<std::uint8_t> grey(const Image<T>& picture, unsigned divisor) {
    std::vector<std::uint8_t> out(static_cast<std::size_t>(picture.width()) *
                                  static_cast<std::size_t>(picture.height()));
    const T* p = picture.pixels().data();
    if (picture.channels() >= 3) {
        const auto step = static_cast<std::size_t>(picture.channels());
        for (std::uint8_t& to : out) {
            to = static_cast<std::uint8_t>((54U * p[0] + 183U * p[1] + 19U * p[2]) / 256U / divisor);
            p += step;
        }
    } else {
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = static_cast<std::uint8_t>(p[i * static_cast<std::size_t>(picture.channels())] / divisor);
    }
    return {picture.size(), 1, std::move(out)};
}

}  // namespace

Image<std::uint8_t> greyOf(const Image<std::uint8_t>& rgb) { return rgb.channels() == 1 ? rgb : grey(rgb, 1U); }
Image<std::uint8_t> greyOf(const Picture& picture) { return grey(picture, 257U); }

}  // namespace ilf
