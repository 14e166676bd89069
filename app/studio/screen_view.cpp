#include "app/studio/screen_view.h"

#include "core/base/srgb.h"

namespace ilf::app {
namespace {

Box<ScreenTile> screenTile(const ViewTile& tile) {
    constexpr std::size_t kPixels = static_cast<std::size_t>(ViewTile::kWidth) * ViewTile::kHeight;
    ScreenTile codes;
    srgb8FromPlanes(tile.v.data(), tile.v.data() + kPixels, tile.v.data() + 2 * kPixels, kPixels, codes.data());
    return Box(codes);
}

}  // namespace

ScreenView screenView(const PerceivedView& seen, const PerceivedView& before, const ScreenView& shown) {
    const bool comparable = before.size == seen.size && shown.size == seen.size &&
                            before.tiles.size() == seen.tiles.size() && shown.tiles.size() == seen.tiles.size();
    ScreenView view{seen.size, seen.columns, seen.rows, {}};
    view.tiles.reserve(seen.tiles.size());
    for (std::size_t i = 0; i < seen.tiles.size(); ++i) {
        if (comparable && seen.tiles[i].same(before.tiles[i])) {
            view.tiles.push_back(shown.tiles[i]);
            continue;
        }
        Box<ScreenTile> tile = screenTile(*seen.tiles[i]);
        view.tiles.push_back(comparable && tile == shown.tiles[i] ? shown.tiles[i] : std::move(tile));
    }
    return view;
}

ScreenView screenView(const PerceivedView& seen) { return screenView(seen, {}, {}); }

void shareEqual(ScreenView& view, const ScreenView& other) {
    if (view.size != other.size || view.tiles.size() != other.tiles.size()) return;
    for (std::size_t i = 0; i < view.tiles.size(); ++i) {
        if (view.tiles[i] == other.tiles[i]) view.tiles[i] = other.tiles[i];
    }
}

}  // namespace ilf::app
