#include "project.h"

#include <array>
#include <cassert>
#include <cstdio>

namespace ilf::samples {
namespace {

/// Where a region's distance comes from.
enum class From {
    typed,    // the number in the table
    range,    // nearest and farthest depth of its pixels: a constant with a tolerance
    plane,    // three of its pixels
    depthMap  // every pixel
};

struct RegionSpec {
    std::string name;
    Look look;
    From from = From::range;
    double metres = 0.0;
};

struct ProjectSpec {
    std::string scene, title;
    std::vector<RegionSpec> regions;  // topmost first
    RegionSpec background;
};

const std::vector<ProjectSpec>& specs() {
    static const std::vector<ProjectSpec> all = {
        {"museum-guide",
         "Museum guide",
         {{"Face", Look::focus}, {"Hands", Look::blur}, {"Base", Look::blur}, {"Body", Look::neutral}},
         {"Gallery", Look::neutral, From::typed, 2.48}},
        {"study-desk",
         "Study desk",
         {{"Left book", Look::focus, From::depthMap},
          {"Right book", Look::focus, From::depthMap},
          {"Clutter", Look::blur, From::depthMap},
          {"Desk", Look::neutral, From::plane}},
         {"Room", Look::neutral, From::typed, 2.0}},
        {"scanned-desk",
         "Scanned desk",
         {{"Left book", Look::focus, From::depthMap},
          {"Right book", Look::focus, From::depthMap},
          {"Clutter", Look::blur, From::depthMap},
          {"Desk", Look::neutral, From::plane}},
         {"Room", Look::neutral, From::typed, 2.0}},
        {"tutorial-recording",
         "Tutorial recording",
         {{"Screwdriver", Look::focus},
          {"Hammer", Look::blur},
          {"Pliers", Look::blur},
          {"Spanner", Look::blur},
          {"Tape measure", Look::blur},
          {"Brush", Look::blur}},
         {"Bench", Look::neutral, From::plane}},
        {"four-objects",
         "Four objects",
         {{"A", Look::blur, From::typed, 0.25},
          {"B", Look::focus, From::typed, 0.50},
          {"C", Look::blur, From::typed, 0.50},
          {"D", Look::blur, From::typed, 1.30}},
         {"Wall", Look::neutral, From::typed, 2.0}},
    };
    return all;
}

/// An id that is the same each time the samples are made: 128 bits of FNV-1a over the names, written as a UUID.
std::string idOf(const std::string& scene, const std::string& region) {
    std::array<std::uint64_t, 2> h{0xcbf29ce484222325u, 0x84222325cbf29ce4u};
    for (const char c : scene + "/" + region)
        for (auto& half : h)
            half = (half ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    char text[40];
    std::snprintf(text, sizeof text, "%08x-%04x-8%03x-8%03x-%012llx", static_cast<unsigned>(h[0] >> 32),
                  static_cast<unsigned>(h[0] >> 16 & 0xffff), static_cast<unsigned>(h[0] & 0xfff),
                  static_cast<unsigned>(h[1] >> 48 & 0xfff), static_cast<unsigned long long>(h[1] & 0xffffffffffff));
    return text;
}

/// Nearest to farthest of the pixels well inside the mask, but for one in two hundred at either end; centimetres.
ConstantDistance rangeOf(const std::vector<std::uint8_t>& mask, const std::vector<float>& depth) {
    std::vector<float> inside;
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask[i] == 255 && depth[i] > 0.0f) inside.push_back(depth[i]);
    assert(!inside.empty());
    std::sort(inside.begin(), inside.end());
    const double nearest = double(inside[inside.size() / 200]);
    const double farthest = double(inside[inside.size() - 1 - inside.size() / 200]);
    const double centre = std::round(50.0 * (nearest + farthest)) / 100.0;
    const double tolerance = std::ceil(100.0 * std::max(centre - nearest, farthest - centre)) / 100.0;
    return {Metre::fromSi(centre), Metre::fromSi(tolerance)};
}

/// Through the pixels that no object covers nearest to three places of the picture, so that noise cannot tilt it.
PlaneDistance planeOf(const Rendering& rendering, const std::vector<std::string>& above) {
    const auto bare = [&](int x, int y) {
        const std::size_t i = std::size_t(y) * std::size_t(rendering.width) + std::size_t(x);
        return std::none_of(above.begin(), above.end(),
                            [&](const std::string& name) { return rendering.masks.at(name)[i] > 0; });
    };
    const int w = rendering.width, h = rendering.height;
    const std::array<std::array<int, 2>, 3> places{{{w / 8, h / 16}, {7 * w / 8, h / 16}, {w / 2, 15 * h / 16}}};
    PlaneDistance plane;
    for (std::size_t k = 0; k < places.size(); ++k) {
        int best = -1, bestAway = 0;
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const int dx = x - places[k][0], dy = y - places[k][1], away = dx * dx + dy * dy;
                if ((best < 0 || away < bestAway) && bare(x, y)) {
                    best = y * w + x;
                    bestAway = away;
                }
            }
        assert(best >= 0);
        plane.anchors[k] = {{best % w + 0.5, best / w + 0.5},
                            Metre::fromSi(double(rendering.depth[std::size_t(best)]))};
    }
    return plane;
}

ilf::Scene sceneOf(const Scene& scene, const Rendering& rendering) {
    const Size size{rendering.width, rendering.height};
    std::vector<std::uint16_t> picture(rendering.picture.size());
    std::transform(rendering.picture.begin(), rendering.picture.end(), picture.begin(),
                   [](std::uint8_t v) { return static_cast<std::uint16_t>(v * 257); });
    // A tenth of a millimetre: 6.5 m in 16 bits.
    std::vector<std::uint16_t> depth(rendering.depth.size());
    std::transform(rendering.depth.begin(), rendering.depth.end(), depth.begin(),
                   [](float metres) { return static_cast<std::uint16_t>(std::lround(metres * 1e4f)); });
    ilf::Scene out;
    out.picture = Box<Picture>(Picture(size, 3, std::move(picture)));
    out.source = scene.name + " (made by make-samples)";
    const double degrees = double(scene.camera.across) * 180.0 / double(kPi);
    out.scale = {focalPixels(rendering.width, std::round(degrees * 1e3) / 1e3), PixelScale::Source::typed};
    out.depth = Box<DepthMap>(depthOf(Image<std::uint16_t>(size, 1, std::move(depth)), 0.1_mm));
    return out;
}

}  // namespace

Document project(const Scene& scene, const Rendering& rendering) {
    const auto spec =
        std::find_if(specs().begin(), specs().end(), [&](const auto& s) { return s.scene == scene.name; });
    assert(spec != specs().end());
    Document document = newDocument(sceneOf(scene, rendering));
    document.name = spec->title;

    std::vector<std::string> above;
    const auto distanceOf = [&](const RegionSpec& r) -> Distance {
        switch (r.from) {
        case From::typed:
            return ConstantDistance{Metre::fromSi(r.metres), Metre{}};
        case From::range:
            return rangeOf(rendering.masks.at(r.name), rendering.depth);
        case From::plane:
            return planeOf(rendering, above);
        case From::depthMap:
            break;
        }
        return FromDepthMap{};
    };
    const Size size{rendering.width, rendering.height};
    for (const RegionSpec& r : spec->regions) {
        Region region;
        region.id = idOf(scene.name, r.name);
        region.name = r.name;
        region.look = r.look;
        region.distance = distanceOf(r);
        // A plane lies under all that stands on it, so that nothing shows through where edges are soft.
        region.mask = r.from == From::plane ? TileGrid(size, 255)
                                            : toTiles(Image<std::uint8_t>(size, 1, rendering.masks.at(r.name)));
        document.regions.emplace_back(std::move(region));
        above.push_back(r.name);
    }
    Region background = *document.background;
    background.name = spec->background.name;
    background.look = spec->background.look;
    background.distance = distanceOf(spec->background);
    document.background = Box<Region>(std::move(background));
    return document;
}

}  // namespace ilf::samples
