// How the window looks, by its pixels: dark enough for a gallery, with text that can be read. With ILF_SCREENSHOT set
// to a path, the window is also written there (ILF_PICTURE: a photograph as its scene), to be looked at.
#include <doctest/doctest.h>
#include <stb_image_write.h>

#include <cstdlib>

#include "core/compile/compile.h"
#include "core/perceived/perceived.h"
#include "core/perceived/seam_profile.h"
#include "tests/ui/headless.h"
#include "tests/ui/raster.h"
#include "ui/overlay.h"

using namespace ilf;
using namespace ilf::ui;
using namespace ilf::ui::test;

namespace {

double linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double luminance(unsigned r, unsigned g, unsigned b) {
    return 0.2126 * linear(r / 255.0) + 0.7152 * linear(g / 255.0) + 0.0722 * linear(b / 255.0);
}
double luminance(ImU32 c) { return luminance(c & 255U, (c >> 8) & 255U, (c >> 16) & 255U); }
double contrast(ImU32 a, ImU32 b) {
    const double high = std::max(luminance(a), luminance(b)), low = std::min(luminance(a), luminance(b));
    return (high + 0.05) / (low + 0.05);
}

std::vector<std::uint8_t> pixelsOf(const Desk& desk) {
    unsigned char* font = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&font, &width, &height);
    return rasterised(*ImGui::GetDrawData(), font, desk.gui.atlas());
}

Texture textureOf(const RasterTexture& texture) { return {reinterpret_cast<std::uintptr_t>(&texture), texture.size}; }

RasterTexture ofPicture(const Picture& picture) {
    RasterTexture texture{picture.size(), {}};
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) {
            for (int c = 0; c < 3; ++c)
                texture.rgba.push_back(static_cast<std::uint8_t>(picture.at(x, y, c) >> 8));
            texture.rgba.push_back(255);
        }
    }
    return texture;
}

RasterTexture ofRadiance(const Radiance& radiance) {
    RasterTexture texture{radiance.size(), {}};
    for (int y = 0; y < radiance.height(); ++y) {
        for (int x = 0; x < radiance.width(); ++x) {
            for (int c = 0; c < 3; ++c) {
                const double v = std::clamp(static_cast<double>(radiance.at(x, y, c)), 0.0, 1.0);
                texture.rgba.push_back(static_cast<std::uint8_t>(
                    255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
            }
            texture.rgba.push_back(255);
        }
    }
    return texture;
}

RasterTexture ofOverlay(const Document& document, const RegionId& selected) {
    const Size size = document.scene.size();
    RasterTexture texture{size, std::vector<std::uint8_t>(static_cast<std::size_t>(size.width) *
                                                          static_cast<std::size_t>(size.height) * 4)};
    for (const auto& [column, row] : overlayTilesThatDiffer({newDocument({}), {}}, {document, selected})) {
        const OverlayTile tile = overlayTile(document, selected, column, row);
        for (int y = 0; y < kTile && row * kTile + y < size.height; ++y) {
            for (int x = 0; x < kTile && column * kTile + x < size.width; ++x) {
                for (std::size_t c = 0; c < 4; ++c) {
                    texture.rgba[(static_cast<std::size_t>(row * kTile + y) * static_cast<std::size_t>(size.width) +
                                  static_cast<std::size_t>(column * kTile + x)) *
                                     4 +
                                 c] = tile[static_cast<std::size_t>(y * kTile + x) * 4 + c];
                }
            }
        }
    }
    return texture;
}

}  // namespace

TEST_CASE("window: without a picture it gives less than 3 cd/m2 on a display whose white is 250 cd/m2") {
    Desk desk(newDocument({}), {1280, 720});
    desk.frame();
    const auto pixels = pixelsOf(desk);
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels.size(); i += 4)
        sum += luminance(pixels[i], pixels[i + 1], pixels[i + 2]);
    const double mean = sum / (static_cast<double>(pixels.size()) / 4.0);
    CHECK(mean * 250.0 < 3.0);
    CHECK(mean > 0.0);
}

TEST_CASE("palette: text has a contrast of at least 7 on every ground it stands on") {
    for (const ImU32 ground : {colour::ground, colour::panel, colour::raised, colour::safeGround}) {
        CHECK(contrast(colour::text, ground) >= 7.0);
    }
    CHECK(contrast(colour::safe, colour::safeGround) >= 7.0);
    for (const ImU32 ink : {colour::focus, colour::blur, colour::neutral, colour::good, colour::warn}) {
        CHECK(contrast(ink, colour::panel) >= 6.5);
    }
}

TEST_CASE("window: the picture of a scene with regions is drawn where the layout says") {
    const char* path = std::getenv("ILF_SCREENSHOT");
    const char* size = std::getenv("ILF_WINDOW");
    int width = 1280, height = 720;
    double scale = 1.0;
    if (size != nullptr) std::sscanf(size, "%dx%d@%lf", &width, &height, &scale);
    Document document = twoRegions({640, 480});
    const RasterTexture scene = ofPicture(*document.scene.picture);
    Desk desk(document, {width, height}, scale);
    desk.state.selected = "Clutter";
    const RasterTexture overlay = ofOverlay(document, "Clutter");
    const auto planned = plan(planInput(document));
    REQUIRE(planned);
    const auto compiled = compile(document, *planned);
    REQUIRE(compiled);
    const auto seam = seamProfile(*compiled, {384, 240}, 40);
    const auto seen = perceived(document, *planned, compiled->program, {});
    REQUIRE(seen);
    const RasterTexture view0 = ofRadiance(*seen);
    if (const char* mode = std::getenv("ILF_MODE")) desk.state.mode = static_cast<ViewMode>(std::atoi(mode));
    if (const char* page = std::getenv("ILF_PAGE")) desk.state.page = static_cast<Page>(std::atoi(page));
    if (const char* tool = std::getenv("ILF_TOOL")) desk.state.tool = static_cast<Tool>(std::atoi(tool));
    if (std::getenv("ILF_HINTS") != nullptr) desk.state.hintsUsed.clear();
    if (std::getenv("ILF_KEYS") != nullptr) desk.state.shortcutsOpen = true;
    desk.dress = [&](View& view) {
        view.scene = textureOf(scene);
        view.overlay = textureOf(overlay);
        view.perceived = {textureOf(view0), textureOf(view0)};
        view.plain = textureOf(scene);
        view.editsSinceTake = 3;
        view.computed.compiled = &*compiled;
        if (seam) view.computed.seam = *seam;
        view.core.projector = "1024 x 768, 960 Hz";
        view.core.lens = "0.00 D";
        view.savedAgo_s = 12;
        view.historyLabels = {"", "Add region", "Paint", "Set distance"};
        view.historyPosition = 2;
    };
    const Rect canvas = desk.areas().canvas;
    desk.move({canvas.x + canvas.w * 0.55, canvas.y + canvas.h * 0.6});
    desk.settle();
    if (std::getenv("ILF_MENU") != nullptr) desk.click({70 * scale, 28 * scale});
    if (std::getenv("ILF_OPEN") != nullptr) desk.key('O', true), desk.settle();
    const auto pixels = pixelsOf(desk);
    const auto luminanceAt = [&](Point<WidgetFrame> at) {
        const auto i =
            (static_cast<std::size_t>(at.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(at.x)) * 4;
        return luminance(pixels[i], pixels[i + 1], pixels[i + 2]);
    };
    if (path == nullptr) {
        CHECK(luminanceAt(desk.at(320, 40)) > 3 * luminanceAt({canvas.x + 4, canvas.y + canvas.h / 2}));
    } else {
        stbi_write_png(path, width, height, 4, pixels.data(), width * 4);
    }
}
