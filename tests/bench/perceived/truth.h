// A scene's reference at some thousand pixels, kept on disk, and how far a view is from it.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tests/bench/perceived/row.h"
#include "tests/bench/perceived/scenes.h"

namespace ilf::bench {

class Truth {
public:
    /// Traced, or taken from the user's cache, where it lies under a name made of all it depends on.
    static Result<Truth> of(const BenchScene& scene);

    /// The pixels: random ones over the view, then more of the boundary band.
    const std::vector<cv::Point>& places() const { return places_; }
    Errors against(const Radiance& view) const;
    /// Three numbers for each place.
    Errors against(const std::vector<float>& radiance) const;

private:
    std::vector<cv::Point> places_;
    std::vector<unsigned char> inBand_;
    std::vector<std::array<double, 3>> radiance_;
    double floor_ = kNothing, bandFloor_ = kNothing;
};

}  // namespace ilf::bench
