#include "devices/plugin/slot_pictures.h"

#include "devices/dlpc350/frame_quantised.h"

namespace ilf::devices {
namespace {

Image<std::uint8_t> uniform(Size size, int value) {
    const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    return {size, 1, std::vector<std::uint8_t>(pixels, static_cast<std::uint8_t>(value))};
}

Image<std::uint8_t> picture(const LightImage& image, int bits) {
    if (bits == 8) return toImage(image);
    LightImage codes(image.size());
    for (int row = 0; row < image.rows(); ++row)
        for (int column = 0; column < image.columns(); ++column) {
            Tile tile;
            dlpc350::tileCodes(*image.tile(column, row), bits, tile.v.data());
            for (std::uint8_t& value : tile.v)
                value = static_cast<std::uint8_t>(value << (8 - bits));
            codes.setTile(column, row, boxed(tile));
        }
    return toImage(codes);
}

}  // namespace

std::vector<Image<std::uint8_t>> slotPictures(const Program& program, int bits) {
    std::vector<Image<std::uint8_t>> images;
    images.reserve(program.images.size());
    for (const LightImage& image : program.images)
        images.push_back(picture(image, bits));
    const auto dark = uniform(program.projector, 0);
    std::vector<Image<std::uint8_t>> slots;
    slots.reserve(program.imageOfSlot.size());
    for (const int image : program.imageOfSlot)
        slots.push_back(image == Program::kDark ? dark : images[static_cast<std::size_t>(image)]);
    return slots;
}

std::vector<Image<std::uint8_t>> whiteSlots(Size raster, int slots, int bits) {
    return std::vector<Image<std::uint8_t>>(static_cast<std::size_t>(slots),
                                            uniform(raster, dlpc350::fullCode(bits) << (8 - bits)));
}

}  // namespace ilf::devices
