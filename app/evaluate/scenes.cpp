#include "app/evaluate/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/document/shape.h"

namespace ilf::app {
namespace {

constexpr int kWaves = 40;  ///< of a painting, in each colour

std::uint16_t code(double value) {
    return static_cast<std::uint16_t>(std::lround(65535.0 * std::clamp(value, 0.0, 1.0)));
}

}  // namespace

Picture printedPage(Size size, int stroke, unsigned seed) {
    std::mt19937 random(seed);
    const auto width = static_cast<std::size_t>(size.width), height = static_cast<std::size_t>(size.height);
    std::vector<std::uint16_t> pixels(3 * width * height, code(0.93));
    const auto ink = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= size.width || y >= size.height) return;
        for (std::size_t c = 0; c < 3; ++c)
            pixels[3 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) + c] = code(0.12);
    };
    const auto bar = [&](int x, int y, int across, int down) {
        for (int j = 0; j < down * stroke; ++j) {
            for (int i = 0; i < across * stroke; ++i)
                ink(x + i, y + j);
        }
    };
    // Letters are 4 strokes wide and 5 high, of the bars of a digital clock; a line is 9 strokes high.
    for (int y = 2 * stroke; y < size.height; y += 9 * stroke) {
        // Lines do not begin below each other, so that letters stand in no columns.
        for (int x = -static_cast<int>(random() % static_cast<unsigned>(5 * stroke)); x < size.width; x += 5 * stroke) {
            const unsigned bars = static_cast<unsigned>(random());
            if (bars % 7 == 0) continue;  // between words
            if ((bars & 8U) != 0) bar(x, y, 3, 1);
            if ((bars & 16U) != 0) bar(x, y + 2 * stroke, 3, 1);
            if ((bars & 32U) != 0) bar(x, y + 4 * stroke, 3, 1);
            if ((bars & 64U) != 0) bar(x, y, 1, 5);
            if ((bars & 128U) != 0) bar(x + 2 * stroke, y, 1, 5);
        }
    }
    return {size, 3, std::move(pixels)};
}

Picture painting(Size size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    struct Wave {
        double x, y, phase, strength;
    };
    std::array<std::vector<Wave>, 3> waves;
    for (int i = 0; i < 24; ++i) {
        const double turn = 6.28 * unit(random), fine = std::pow(2.0, 5.0 * unit(random));
        const double step = 6.28 * fine / 160.0;
        for (auto& colour : waves)
            colour.push_back(
                {step * std::cos(turn), step * std::sin(turn), 6.28 * unit(random), 0.35 / std::sqrt(fine)});
    }
    std::vector<std::uint16_t> pixels;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            for (const auto& colour : waves) {
                double value = 0.55;
                for (const Wave& w : colour)
                    value += w.strength / std::sqrt(0.5 * kWaves) * std::sin(w.x * x + w.y * y + w.phase);
                pixels.push_back(code(std::clamp(value, 0.15, 0.95)));
            }
        }
    }
    return {size, 3, std::move(pixels)};
}

Picture whiteSheet(Size size) {
    const auto count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    return {size, 3, std::vector<std::uint16_t>(3 * count, code(0.93))};
}

Region strip(std::string name, Size size, double x0, double x1, Look look, Metre distance) {
    Region made;
    made.id = made.name = std::move(name);
    made.look = look;
    made.distance = ConstantDistance{distance, {}};
    made.mask = rasterised(Rectangle{{x0, 0.0}, {x1, static_cast<double>(size.height)}}, size);
    return made;
}

Document scene(Picture picture, double focalPixels, std::vector<Region> regions, Look background,
               Metre backgroundDistance) {
    Scene made;
    const Size size = picture.size();
    made.picture = Box<Picture>(std::move(picture));
    made.scale = {focalPixels, PixelScale::Source::typed};
    Document document = newDocument(std::move(made));
    for (Region& region : regions)
        document.regions.push_back(Box<Region>(std::move(region)));
    Region behind = *document.background;
    behind.look = background;
    behind.distance = ConstantDistance{backgroundDistance, {}};
    document.background = Box<Region>(behind);
    document.rig.projector = size;
    document.rig.registration = registered(Homography<ProjectorFrame, CameraFrame>{});
    return document;
}

Result<Compiled> played(const Document& document) {
    const auto planned = plan(planInput(document));
    if (!planned) return tl::unexpected(planned.error());
    return compile(document, *planned);
}

}  // namespace ilf::app
