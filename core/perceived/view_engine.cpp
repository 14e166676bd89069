#include "core/perceived/view_engine.h"

#include <algorithm>

#include "core/perceived/composite.h"
#include "core/perceived/setting.h"

namespace ilf {
namespace {

Result<Radiance> wholeView(const Document& document, const Plan& plan, const Program& program,
                           const ViewRequest& request) {
    const auto setting = view::setting(document, plan, program, request);
    if (!setting) return tl::unexpected(setting.error());
    if (setting->plain) return view::albedo(document, setting->scale);

    const Size size = setting->scale.size;
    const PixelRect<view::ViewFrame> window{0, 0, size.width, size.height};
    const Radiance albedo = view::albedo(document, setting->scale);
    const auto surfaces = view::surfaces(layers(document, plan, request.scale), window);
    view::Block seen(size.width, size.height, albedo.channels());
    for (const view::Light& light : view::lights(document, plan, program, setting->scale, window)) {
        std::vector<view::Appearance> looks;
        for (const view::Surface& surface : surfaces) {
            looks.push_back(view::appearance(document, plan, request.eye, setting->attention, setting->scale, window,
                                             surface.distance, light.power));
        }
        view::addLight(seen, surfaces, looks, albedo, light);
    }
    return Radiance(size, albedo.channels(), std::move(seen.values));
}

}  // namespace

struct ViewEngine::State {
    int threads = 2;
};

ViewEngine::ViewEngine(int threads) : state_(std::make_unique<State>(State{threads})) {}
ViewEngine::~ViewEngine() = default;
ViewEngine::ViewEngine(ViewEngine&&) noexcept = default;
ViewEngine& ViewEngine::operator=(ViewEngine&&) noexcept = default;

Result<PerceivedView> ViewEngine::see(const Document& document, const Plan& plan, const Program& program,
                                      const ViewRequest& request, const std::function<bool()>&) {
    const auto whole = wholeView(document, plan, program, request);
    if (!whole) return tl::unexpected(whole.error());
    PerceivedView view;
    view.size = whole->size();
    view.rung = request.rung;
    view.columns = (view.size.width + ViewTile::kWidth - 1) / ViewTile::kWidth;
    view.rows = (view.size.height + ViewTile::kHeight - 1) / ViewTile::kHeight;
    for (int row = 0; row < view.rows; ++row) {
        for (int column = 0; column < view.columns; ++column) {
            ViewTile tile;
            for (int c = 0; c < 3; ++c) {
                for (int y = 0; y < std::min(ViewTile::kHeight, view.size.height - row * ViewTile::kHeight); ++y) {
                    for (int x = 0; x < std::min(ViewTile::kWidth, view.size.width - column * ViewTile::kWidth); ++x) {
                        tile.v[static_cast<std::size_t>((c * ViewTile::kHeight + y) * ViewTile::kWidth + x)] =
                            whole->at(column * ViewTile::kWidth + x, row * ViewTile::kHeight + y, c);
                    }
                }
            }
            view.tiles.emplace_back(tile);
        }
    }
    view.counters.tiles = view.counters.computed = view.columns * view.rows;
    return view;
}

Radiance PerceivedView::radiance() const {
    std::vector<float> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3);
    for (int y = 0; y < size.height; ++y) {
        float* out = pixels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) * 3;
        for (int column = 0; column < columns; ++column) {
            const auto& v = tile(column, y / ViewTile::kHeight)->v;
            const int width = std::min(ViewTile::kWidth, size.width - column * ViewTile::kWidth);
            for (int c = 0; c < 3; ++c) {
                const float* row = v.data() + (c * ViewTile::kHeight + y % ViewTile::kHeight) * ViewTile::kWidth;
                for (int x = 0; x < width; ++x)
                    out[(column * ViewTile::kWidth + x) * 3 + c] = row[x];
            }
        }
    }
    return Radiance(size, 3, std::move(pixels));
}

}  // namespace ilf
