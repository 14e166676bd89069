// Borders between sharp and blurred light cut into cells: where profiles lie, and how far each is worked out.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "core/perceived/seam_border.h"
#include "core/perceived/seam_patch.h"
#include "core/perceived/seam_weighting.h"

namespace ilf::view {

struct SeamLine {
    Point<CameraFrame> at;
    double nx = 1.0, ny = 0.0;  ///< across the border, towards its other side
};

/// One border and what all its patches share.
struct SeamBorder {
    std::size_t blurred = 0, other = 0;
    Dioptre power;
    double reach = 0.0, pitch = 1.0;  ///< picture pixels
    std::optional<SeamWeighting> weighting;
    std::size_t crossings = 0;
    int cells = 0;

    /// Of a profile, to each side.
    int samples() const;
};

/// A part of a border small enough for one patch, and what was found there.
struct SeamCell {
    std::size_t border = 0;
    std::vector<SeamLine> lines;
    Metre distance;
    Displacement displaced;
    bool depthStep = false;
    double length_m = 0.0;
    std::vector<bool> kin{};  ///< regions lit like one of the border's two, as far away

    std::vector<std::array<double, 2>> weber{};  ///< as compiled, of each line
    std::array<BothEyes, 4> blendings{};
};

/// `compiled` must outlive it.
class SeamCells {
public:
    /// At most about `most` cells, evenly taken from all borders.
    SeamCells(const Compiled& compiled, int most, const std::function<bool()>& stopped);

    std::vector<SeamBorder> borders;
    std::vector<SeamCell> cells;

    const LitRegions& regions() const { return regions_; }
    /// What one patch of the cell has to cover.
    PatchWindow windowOf(const SeamCell& cell) const;
    /// All the picture whose light reaches a cell's profiles, under errors too.
    PixelRect<CameraFrame> around(const SeamCell& cell) const;
    /// Where the profile across a line lies: from the border to both sides until it leaves the picture, or comes to a
    /// surface or light that is neither of the border's two, less what shines over from there.
    std::vector<Point<CameraFrame>> profile(const SeamLine& line, const SeamCell& cell) const;
    /// How wide what is seen of the displaced region is, across the surface: the shorter side of its box, or less where
    /// its outline is long for its area.
    Metre extentOf(std::size_t border) const;

private:
    SeamLine lineAt(const Crossing& crossing) const;
    std::optional<Metre> distanceOf(std::size_t region, Point<CameraFrame> at) const;
    std::size_t add(const WholeBorder& whole);
    SeamCell cellOf(const WholeBorder& whole, const std::vector<Crossing>& crossings, const SeamLine& line,
                    Metre distance) const;
    void thinOut(std::size_t all, int most);

    const Compiled& compiled_;
    LitRegions regions_;
};

}  // namespace ilf::view
