// Small scenes whose program is made by hand: one light image for each level, hard masks, projector pixel = picture
// pixel.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "core/compile/program.h"
#include "core/document/document.h"
#include "core/plan/plan.h"

namespace ilf::test {

inline constexpr Size kSmall{160, 120};

inline Mask maskOf(Size size, const std::function<bool(int, int)>& inside) {
    Mask mask(size);
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            Tile tile;
            for (int y = 0; y < kTile; ++y) {
                for (int x = 0; x < kTile; ++x) {
                    const int i = column * kTile + x, j = row * kTile + y;
                    if (i < size.width && j < size.height && inside(i, j)) tile.at(x, y) = 255;
                }
            }
            mask.setTile(column, row, boxed(tile));
        }
    }
    return mask;
}

/// Blocks of random grey and colour, 5 px a side: edges everywhere.
inline Picture texture(Size size, unsigned seed) {
    std::mt19937 random(seed);
    const int columns = size.width / 5 + 1;
    std::vector<std::uint16_t> blocks(static_cast<std::size_t>(columns * (size.height / 5 + 1) * 3));
    for (auto& value : blocks)
        value = static_cast<std::uint16_t>(8000 + random() % 57000);
    std::vector<std::uint16_t> pixels;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            for (int c = 0; c < 3; ++c)
                pixels.push_back(blocks[static_cast<std::size_t>(((y / 5) * columns + x / 5) * 3 + c)]);
        }
    }
    return Picture(size, 3, std::move(pixels));
}

inline Region region(std::string name, Look look, double metres, Mask mask) {
    Region made;
    made.id = made.name = std::move(name);
    made.look = look;
    made.distance = ConstantDistance{Metre::fromSi(metres), {}};
    made.mask = std::move(mask);
    return made;
}

/// `focalPixels` 400: a 4 mm pupil blurs by 0.8 px a dioptre, twice what a picture this small that spans 60 degrees
/// has.
inline Document document(std::vector<Region> regions, Look background, double backgroundMetres, Size size = kSmall) {
    Scene scene;
    scene.picture = Box<Picture>(texture(size, 7));
    scene.scale = {400.0 * size.width / kSmall.width, PixelScale::Source::typed};
    Document made = newDocument(std::move(scene));
    for (Region& one : regions)
        made.regions.push_back(Box<Region>(std::move(one)));
    Region behind = *made.background;
    behind.look = background;
    behind.distance = ConstantDistance{Metre::fromSi(backgroundMetres), {}};
    made.background = Box<Region>(behind);
    made.rig.projector = size;
    made.rig.registration = registered(Homography<ProjectorFrame, CameraFrame>{});
    return made;
}

/// Hard masks: each pixel is lit in the level of the topmost region there; neutral ones in all lit slots.
inline Program hardProgram(const Document& document, const Plan& plan) {
    const Size size = document.scene.size();
    Program program;
    program.waveform = plan.waveform;
    program.slotRate = plan.input.rig.slotRate;
    program.projector = size;
    double litSlots = 0.0;
    for (const Level& level : plan.levels)
        litSlots += level.exposure;
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
        const double even = plan.light * static_cast<double>(plan.slots.size()) / litSlots;
        TileGrid image(size);
        for (int row = 0; row < image.rows(); ++row) {
            for (int column = 0; column < image.columns(); ++column) {
                Tile tile;
                for (int y = 0; y < std::min(kTile, size.height - row * kTile); ++y) {
                    for (int x = 0; x < std::min(kTile, size.width - column * kTile); ++x) {
                        const Region* top = &*document.background;
                        for (const auto& one : document.regions) {
                            if (one->mask.at(column * kTile + x, row * kTile + y) < 128) continue;
                            top = &*one;
                            break;
                        }
                        for (const RegionPlan& planned : plan.regions) {
                            if (planned.id != top->id) continue;
                            const double share = !planned.level                          ? even
                                                 : *planned.level == static_cast<int>(l) ? 1.0
                                                                                         : 0.0;
                            tile.at(x, y) = static_cast<std::uint8_t>(std::lround(255.0 * share));
                        }
                    }
                }
                image.setTile(column, row, boxed(tile));
            }
        }
        program.images.push_back(std::move(image));
    }
    for (const Slot& slot : plan.slots)
        program.imageOfSlot.push_back(slot.level().value_or(Program::kDark));
    return program;
}

struct Played {
    Document document;
    Plan plan;
    Program program;
};
inline Played played(const Document& document) {
    const Plan made = *plan(planInput(document));
    return {document, made, hardProgram(document, made)};
}

}  // namespace ilf::test
