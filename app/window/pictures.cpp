#include "app/window/pictures.h"

#include <algorithm>

#include "core/base/srgb.h"

namespace ilf::app {
namespace {

/// Uploads one tile, cut to the texture; `rgba` is a whole tile.
void uploadTile(GlTexture& texture, int column, int row, const ui::OverlayTile& rgba) {
    const int width = std::min(kTile, texture.size().width - column * kTile);
    const int height = std::min(kTile, texture.size().height - row * kTile);
    if (width == kTile) {
        texture.uploadPart(column * kTile, row * kTile, width, height, rgba);
        return;
    }
    std::vector<std::uint8_t> cut;
    for (int y = 0; y < height; ++y) {
        const auto* from = &rgba[static_cast<std::size_t>(y) * kTile * 4];
        cut.insert(cut.end(), from, from + static_cast<std::size_t>(width) * 4);
    }
    texture.uploadPart(column * kTile, row * kTile, width, height, cut);
}

void uploadIfNew(GlTexture& texture, ViewPicture& shown, const ViewPicture& now, bool smooth) {
    if (now.empty() || now.same(shown)) return;
    texture.upload(now, smooth);
    shown = now;
}

/// Uploads the tiles of a slot image that differ from what the texture shows.
void uploadLight(GlTexture& texture, const LightImage& shown, const LightImage& now) {
    const bool anew = texture.reserve(now.size(), false) || shown.size() != now.size();
    for (int row = 0; row < now.rows(); ++row) {
        for (int column = 0; column < now.columns(); ++column) {
            const Box<Tile>& tile = now.tile(column, row);
            if (!anew && tile.same(shown.tile(column, row))) continue;
            ui::OverlayTile rgba;
            for (std::size_t i = 0; i < tile->v.size(); ++i) {
                rgba[4 * i] = rgba[4 * i + 1] = rgba[4 * i + 2] = tile->v[i];
                rgba[4 * i + 3] = 255;
            }
            uploadTile(texture, column, row, rgba);
        }
    }
}

}  // namespace

void Pictures::show(const Document& document, const RegionId& selected) {
    if (!document.scene.picture) return;
    if (!document.scene.picture.same(shownPicture_)) {
        scene_.upload(toBytes(*document.scene.picture), false);
        shownPicture_ = document.scene.picture;
    }
    const ui::OverlaySubject now{document, selected};
    const bool anew = overlay_.reserve(document.scene.size(), true) || !shownRegions_;
    const ui::OverlaySubject before = anew ? ui::OverlaySubject{} : *shownRegions_;
    for (const auto& [column, row] : ui::overlayTilesThatDiffer(before, now)) {
        uploadTile(overlay_, column, row, ui::overlayTile(document, selected, column, row));
    }
    shownRegions_ = now;
}

void Pictures::show(const Done& done, bool lights) {
    for (std::size_t eye = 0; eye < 2; ++eye)
        uploadIfNew(perceived_[eye], shownPerceived_[eye], done.perceived[eye], true);
    uploadIfNew(plain_, shownPlain_, done.plain, true);
    if (!lights || !done.compiled) return;
    const auto& images = done.compiled->program.images;
    lights_.resize(images.size());
    shownLights_.resize(images.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        uploadLight(lights_[i], shownLights_[i], images[i]);
        shownLights_[i] = images[i];
    }
}

void Pictures::showLive(const Image<std::uint8_t>& frame) { live_.upload(frame, true); }

void Pictures::fill(ui::View& view) const {
    view.scene = scene_.handle();
    view.overlay = overlay_.handle();
    view.live = live_.handle();
    view.plain = plain_.handle();
    for (std::size_t eye = 0; eye < 2; ++eye)
        view.perceived[eye] = perceived_[eye].handle();
    for (const GlTexture& light : lights_)
        view.lights.push_back(light.handle());
}

}  // namespace ilf::app
