#include "app/pictures_of.h"

#include <algorithm>
#include <vector>

#include "core/base/srgb.h"
#include "ui/overlay.h"

namespace ilf::app {

Image<std::uint8_t> scenePicture(const Document& document) { return toBytes(*document.scene.picture); }

Image<std::uint8_t> overlayPicture(const Document& document) {
    const Image<std::uint8_t> scene = scenePicture(document);
    const Size size = scene.size();
    std::vector<std::uint8_t> rgb(scene.pixels().begin(), scene.pixels().end());
    for (int row = 0; row * kTile < size.height; ++row) {
        for (int column = 0; column * kTile < size.width; ++column) {
            const ui::OverlayTile marks = ui::overlayTile(document, RegionId(), column, row);
            for (int y = row * kTile; y < std::min((row + 1) * kTile, size.height); ++y) {
                for (int x = column * kTile; x < std::min((column + 1) * kTile, size.width); ++x) {
                    const auto* mark = &marks[static_cast<std::size_t>((y % kTile) * kTile + x % kTile) * 4];
                    auto* pixel = &rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                                        static_cast<std::size_t>(x)) *
                                       3];
                    for (int c = 0; c < 3; ++c) {
                        pixel[c] = static_cast<std::uint8_t>((pixel[c] * (255 - mark[3]) + mark[c] * mark[3]) / 255);
                    }
                }
            }
        }
    }
    return {size, 3, std::move(rgb)};
}

Image<std::uint8_t> slotPicture(const Program& program, int slot) {
    const int image = program.imageOfSlot[static_cast<std::size_t>(slot)];
    if (image == Program::kDark) return toImage(LightImage(program.projector));
    return toImage(program.images[static_cast<std::size_t>(image)]);
}

}  // namespace ilf::app
