// One eye's lens as a converter's samples move it, and where it has been for the last half second.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "core/base/quantity.h"
#include "devices/simulated/lens_emulator.h"

namespace ilf::devices {

/// Times are in nanoseconds and never go back. A step for each sample: at 48000 a second some hundredths of a
/// processor, and next to nothing at rest.
class SampledLens {
public:
    /// At rest since long, without current.
    SampledLens(LensPreset preset, std::int64_t now_ns);

    /// The coil's current from `time_ns` on.
    void drive(std::int64_t time_ns, Ampere current);
    void advance(std::int64_t time_ns);
    /// So much warmer than usual, coil and all, at once.
    void warmer(double by_C);

    Dioptre power() const { return lens_.power(); }
    double temperature_C() const { return lens_.temperature_C(); }
    /// `count` powers, evenly from `from_ns` on; before and after what is remembered, the nearest.
    std::vector<Dioptre> powers(std::int64_t from_ns, std::int64_t until_ns, std::size_t count) const;
    /// The greatest current between the two, either direction.
    Ampere most(std::int64_t from_ns, std::int64_t until_ns) const;

private:
    struct Point {
        std::int64_t time_ns = 0;
        double power_D = 0.0, current_A = 0.0;
    };
    void note();

    LensEmulator lens_;
    Ampere told_;
    std::int64_t now_ns_;
    std::deque<Point> past_;
};

}  // namespace ilf::devices
