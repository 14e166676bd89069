#include "app/window/pictures.h"

#include <algorithm>

#include "core/base/srgb.h"

namespace ilf::app {
namespace {

void uploadTile(GlTexture& texture, int column, int row, const ui::OverlayTile& rgba) {
    texture.uploadPart(column * kTile, row * kTile, kTile, kTile, rgba);
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

void Pictures::showLights(const Done& done) {
    if (!done.compiled) return;
    const auto& images = done.compiled->program.images;
    lights_.resize(images.size());
    shownLights_.resize(images.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        uploadLight(lights_[i], shownLights_[i], images[i]);
        shownLights_[i] = images[i];
    }
}

bool Pictures::show(const Seen& seen, std::chrono::microseconds budget) {
    if (!seen.plain.empty() && !seen.plain.same(shownPlain_)) {
        plain_.upload(seen.plain, true);
        shownPlain_ = seen.plain;
    }
    const auto until = std::chrono::steady_clock::now() + budget;
    bool left = false;
    for (std::size_t eye = 0; eye < perceived_.size(); ++eye) {
        if (seen.perceived[eye]) left = !upload(perceived_[eye], seen.perceived[eye], until) || left;
    }
    return left;
}

bool Pictures::upload(EyeTexture& eye, const std::shared_ptr<const ScreenView>& view,
                      std::chrono::steady_clock::time_point until) {
    if (view == eye.complete) return true;
    const std::size_t count = view->tiles.size();
    if (eye.texture.reserve(view->size, true) || eye.tiles.size() != count) {
        eye.tiles.assign(count, {});
        eye.next = 0;
    }
    eye.complete.reset();  // until the last tile, the texture is part this view, part the one before
    // Goes on where the last frame stopped, so that a view that changes all over and often is shown all over.
    for (std::size_t looked = 0; looked < count; ++looked, eye.next = (eye.next + 1) % count) {
        const Box<ScreenTile>& tile = view->tiles[eye.next];
        if (tile.same(eye.tiles[eye.next])) continue;
        if (std::chrono::steady_clock::now() >= until) return false;
        const int column = static_cast<int>(eye.next) % view->columns, row = static_cast<int>(eye.next) / view->columns;
        eye.texture.uploadPart(column * ViewTile::kWidth, row * ViewTile::kHeight, ViewTile::kWidth, ViewTile::kHeight,
                               *tile);
        eye.tiles[eye.next] = tile;
        ++tilesSent_;
    }
    eye.complete = view;
    return true;
}

void Pictures::showLive(const Image<std::uint8_t>& frame) { live_.upload(frame, true); }

void Pictures::showRegistering(const Image<std::uint8_t>& picture) {
    if (picture.empty() || picture.same(shownRegistering_)) return;
    registering_.upload(picture, true);
    shownRegistering_ = picture;
}

void Pictures::fill(ui::View& view) const {
    view.scene = scene_.handle();
    view.overlay = overlay_.handle();
    view.live = live_.handle();
    view.registerPicture = registering_.handle();
    view.plain = plain_.handle();
    for (std::size_t eye = 0; eye < 2; ++eye)
        view.perceived[eye] = perceived_[eye].texture.handle();
    for (const GlTexture& light : lights_)
        view.lights.push_back(light.handle());
}

}  // namespace ilf::app
