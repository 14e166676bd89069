// The fast way to a perceived view: remembers the last one, and works out only the tiles that an edit can reach.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/box.h"
#include "core/perceived/perceived.h"

namespace ilf {

/// A tile of a view: three planes (red, green, blue) of linear radiance, each row by row. Tiles at the right and lower
/// edge reach beyond the picture and are 0 there.
struct ViewTile {
    static constexpr int kWidth = 64, kHeight = 32;
    std::array<float, 3 * kWidth * kHeight> v{};
    bool operator==(const ViewTile&) const = default;
};

/// What a frame took, and why the rest was not worked out.
struct ViewCounters {
    int tiles = 0;      ///< of the view
    int computed = 0;   ///< worked out now; the others by reason:
    int unchanged = 0;  ///< no edit since the last frame reaches them
    int plain = 0;      ///< nothing is blurred for anybody: the picture
    int left = 0;       ///< still to be worked out: the view was cancelled
    int dark = 0;       ///< of those computed: no light reaches them

    int lights = 0;      ///< powers of the lens at which something is lit (a slot mid-sweep counts as two)
    int darkLights = 0;  ///< levels whose image is dark
    int blurred = 0;     ///< surfaces seen blurred in a light, over all tiles worked out
    int sharp = 0;       ///< seen sharp: copied or moved
    int unlit = 0;       ///< skipped: no light on them near the tile
    int hidden = 0;      ///< skipped: behind what hides all of the tile
    int conflicts = 0;   ///< tiles where blurred surfaces hide each other and the pupil was cut into cells
    double geometry_ms = 0.0, light_ms = 0.0, tiles_ms = 0.0;  ///< surfaces and visibility; light on them; the view
};

/// One view. Tiles are shared with the view before where nothing changed.
struct PerceivedView {
    Size size;
    int columns = 0, rows = 0;
    std::vector<Box<ViewTile>> tiles;  ///< row by row
    Rung rung = Rung::rest;
    bool complete = true;  ///< false: it was cancelled, some tiles are of the view before (or dark)
    ViewCounters counters;

    const Box<ViewTile>& tile(int column, int row) const {
        return tiles[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
    }
    /// The whole view, 3 channels.
    Radiance radiance() const;
};

/// Sees one eye's view again and again. What it shows depends on what it is asked alone: a view after any number of
/// edits is bit for bit the view of a fresh engine, for any number of threads.
class ViewEngine {
public:
    /// `threads`: 1 or 2.
    explicit ViewEngine(int threads = 2);
    ~ViewEngine();
    ViewEngine(ViewEngine&&) noexcept;
    ViewEngine& operator=(ViewEngine&&) noexcept;

    /// Refusals as `perceived`. `cancelled` is asked between tiles: when it says true, the view so far is given, and
    /// the next call goes on from there.
    Result<PerceivedView> see(const Document& document, const Plan& plan, const Program& program,
                              const ViewRequest& request, const std::function<bool()>& cancelled = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ilf
