// The textures of the window: scene, overlay, perceived views and slot light, uploaded only where they changed.
#pragma once

#include <array>
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
    /// Brings views and slot images up to date with what was worked out.
    void show(const Done& done, bool lights);
    void showLive(const Image<std::uint8_t>& frame);
    void hideLive() { live_.clear(); }

    /// Fills in the textures of a view.
    void fill(ui::View& view) const;

private:
    GlTexture scene_, overlay_, live_, plain_;
    std::array<GlTexture, 2> perceived_;
    std::vector<GlTexture> lights_;

    // What the textures show, to find what differs.
    Box<Picture> shownPicture_;
    std::optional<ui::OverlaySubject> shownRegions_;
    std::array<ViewPicture, 2> shownPerceived_;
    ViewPicture shownPlain_;
    std::vector<LightImage> shownLights_;
};

}  // namespace ilf::app
