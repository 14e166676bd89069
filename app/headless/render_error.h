// How far a view is from its reference: the figures of an error map.
#pragma once

#include <cstdint>
#include <string>

#include "core/compile/compile.h"
#include "core/perceived/perceived.h"

namespace ilf::app {

/// Largest radius of a blur circle in the view, in its pixels, + 2: as far as a border between regions reaches.
int bandReach(const Compiled& compiled, const ViewRequest& request);

/// 255 where the border between two regions is at most `reach` pixels of the view away, else 0.
Image<std::uint8_t> bordersOf(const Compiled& compiled, Size view, int reach);

struct ErrorFigures {
    double psnr_dB = 0.0;        ///< infinite for equal views
    double bandPsnr_dB = 0.0;    ///< over the pixels of the band; infinite where it has none
    double worst = 0.0;          ///< largest difference of a channel, in radiance
    int worstX = 0, worstY = 0;  ///< where
};
struct ErrorMap {
    Radiance difference;  ///< seen - reference
    ErrorFigures figures;
};
/// Views and band of one size.
ErrorMap errorMap(const Radiance& seen, const Radiance& reference, const Image<std::uint8_t>& band);

/// The smallest of 1, 2 and 5 times a power of ten that no difference exceeds; 0.001 where there is none.
double whiteFor(double worst);

/// "47.2 dB"; where it comes within 3 dB of the reference's own noise, it says no more than that: "above 55.1 dB".
std::string spokenPsnr(double psnr_dB, double noiseFloor_dB);

}  // namespace ilf::app
