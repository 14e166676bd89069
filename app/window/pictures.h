// The textures of the window: scene, overlay, perceived views and slot light, uploaded only where they changed.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/studio/worker.h"
#include "app/window/texture.h"
#include "core/document/document.h"
#include "ui/overlay.h"
#include "ui/view.h"

namespace ilf::app {

/// Owns every texture. Use on the GL thread.
class Pictures {
public:
    /// Brings scene and overlay up to date with what is shown.
    void show(const Document& document, const RegionId& selected);
    /// Brings slot images up to date with what was compiled.
    void showLights(const Done& done);
    /// Brings views up to date with what was seen, as far as `budget` of this frame reaches; true if tiles are left for
    /// the next ones.
    bool show(const Seen& seen, std::chrono::microseconds budget);
    void showLive(const Image<std::uint8_t>& frame);
    void hideLive() { live_.clear(); }
    /// Of the registering page: a camera's picture, or a quality map.
    void showRegistering(const Image<std::uint8_t>& picture);

    /// Fills in the textures of a view.
    void fill(ui::View& view) const;
    /// Tiles of the perceived views that were uploaded so far.
    std::uint64_t tilesSent() const { return tilesSent_; }

private:
    struct EyeTexture {
        GlTexture texture;
        std::vector<Box<ScreenTile>> tiles;          ///< what it shows
        std::shared_ptr<const ScreenView> complete;  ///< the view it shows all of
        std::size_t next = 0;                        ///< where the upload goes on
    };
    /// False when `until` came before all tiles were there.
    bool upload(EyeTexture& eye, const std::shared_ptr<const ScreenView>& view,
                std::chrono::steady_clock::time_point until);

    GlTexture scene_, overlay_, live_, plain_, registering_;
    std::array<EyeTexture, 2> perceived_;
    std::vector<GlTexture> lights_;

    // What the textures show, to find what differs.
    Box<Picture> shownPicture_;
    std::optional<ui::OverlaySubject> shownRegions_;
    Image<std::uint8_t> shownPlain_, shownRegistering_;
    std::vector<LightImage> shownLights_;
    std::uint64_t tilesSent_ = 0;
};

}  // namespace ilf::app
