// Programs for tests of what sends and plays them: small, valid, and told apart by a seed.
#pragma once

#include <cstdint>

#include "core/compile/program.h"

namespace ilf::test {

/// A picture with a patterned tile here and there, the rest uniform.
inline LightImage picture(Size size, std::uint32_t seed) {
    LightImage image(size, static_cast<std::uint8_t>(seed % 3 == 0 ? 255 : 0));
    std::uint32_t state = seed * 2654435761U + 1U;
    for (int row = 0; row < image.rows(); ++row) {
        for (int column = 0; column < image.columns(); ++column) {
            state = state * 1664525U + 1013904223U;
            if (state >> 30U != 0) continue;
            Tile tile;
            for (std::size_t i = 0; i < tile.v.size(); ++i)
                tile.v[i] = static_cast<std::uint8_t>((state >> 8U) + i);
            image.setTile(column, row, boxed(tile));
        }
    }
    return image;
}

/// Two images in 16 slots under a sweep from rest to `high`.
inline Program program(std::uint32_t seed, Dioptre high = 2.27_D, Size size = {200, 130}) {
    Program p;
    p.waveform = idealSine(0.0_D, 0.0_D, high, 60.0_Hz, 0.0_s);
    p.slotRate = 960.0_Hz;
    p.projectorDelay = 0.46_ms;
    p.projector = size;
    p.images = {picture(size, seed), picture(size, seed + 1)};
    p.imageOfSlot = {0, 0, -1, -1, -1, -1, -1, 1, 1, 1, -1, -1, -1, -1, -1, 0};
    return p;
}

/// The same with one tile of one image changed: what a dab does.
inline Program dabbed(Program p, std::uint8_t value) {
    Tile tile = *p.images[0].tile(1, 1);
    for (std::size_t i = 0; i < tile.v.size(); i += 3)
        tile.v[i] = value;
    p.images[0].setTile(1, 1, boxed(tile));
    return p;
}

}  // namespace ilf::test
