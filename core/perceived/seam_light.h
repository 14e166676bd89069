// The light an eye receives at single points near a border on one even white surface, gathered over its blur discs.
#pragma once

#include <vector>

#include "core/compile/compile.h"
#include "core/compile/patch.h"
#include "core/perceived/seam_patch.h"

namespace ilf::view {

/// A program's light near one place of a border, where the surface is taken as even and as far as the border.
class SeamLight {
public:
    /// `box`: the picture around all points that will be asked for, and all light that can shine there.
    SeamLight(const Compiled& compiled, const Program& program, const PixelRect<CameraFrame>& box);

    /// How one eye sees a surface: for each of the program's levels a disc and a magnification.
    struct View {
        struct Level {
            double radius = 0.0;  ///< on the lit surface, before magnification; picture pixels
            double magnification = 1.0;
            double movedX = 0.0, movedY = 0.0;  ///< the light against where it should be, picture pixels
        };
        Point<CameraFrame> centre;
        std::vector<Level> levels;
    };
    View view(const Looking& looking) const;

    /// 1 = the light of a region away from borders.
    double at(Point<CameraFrame> p, const View& view) const;

private:
    double level(std::size_t l, Point<ProjectorFrame> p) const;

    const Compiled& compiled_;
    PixelMap map_;
    std::vector<Patch<std::uint8_t>> images_;  ///< of each level near the box; beyond the raster its edge goes on
    std::vector<double> weights_;              ///< of each level; 0 where it is not lit
};

}  // namespace ilf::view
