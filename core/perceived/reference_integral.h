// The integral over pupil and time of one view.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/lens/waveform.h"
#include "core/perceived/reference.h"
#include "core/perceived/reference_hits.h"

namespace ilf::reference {

/// All that a view by brute force depends on, besides its rays.
struct Setup {
    Scene scene;
    Optics optics;
    Waveform wave;
    bool plain = false;  ///< nothing is blurred for anybody: the view is the picture
};

using Colour = std::array<double, 3>;
/// Two independent estimates; each from half of the rays.
struct Halves {
    std::array<Colour, 2> half{};

    Colour mean() const;
    /// Square of half the difference, summed over the colours: the variance of `mean`, estimated.
    double squaredError() const;
};

/// Integrates pixel by pixel; what all pixels share (moments and matrices of each ray) is worked out once.
class Integral {
public:
    Integral(const Setup& setup, const ReferenceRays& rays);
    ~Integral();
    Integral(const Integral&) = delete;
    Integral& operator=(const Integral&) = delete;

    Halves at(ViewPixel pixel) const;

private:
    struct Moments;
    void addHalf(ViewPixel pixel, std::size_t half, Colour& sum) const;

    const Setup& setup_;
    unsigned seed_;
    std::size_t samples_;  ///< of each half
    std::vector<std::array<std::uint32_t, 3>> points_;
    std::vector<Moments> moments_;  ///< of each half and light
};

/// See Reference::key.
std::string keyOf(const Setup& setup, const ReferenceRays& rays, std::span<const ViewPixel> pixels);

}  // namespace ilf::reference
