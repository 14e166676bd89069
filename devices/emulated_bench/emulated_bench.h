// Lenses before a photodiode, with an emulated converter, on a clock that only waiting moves: a bench to measure on.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "devices/clock.h"
#include "devices/emulators/daq.h"
#include "devices/simulated/lens_emulator.h"
#include "devices/usb/usb_link.h"

namespace ilf::devices {

/// Laser, lens, photodiode and its amplifier as they might be. Measuring code knows none of these numbers, and of the
/// formula only that light goes about with the inverse of the beam's area.
struct EmulatedPhotodiode {
    double behind_m = 0.045;                  ///< the lens
    double beam_m = 0.0030, cell_m = 0.0006;  ///< radii: of the beam where the lens is, of the photodiode
    double full_V = 45.0;                     ///< if all of the beam fell on it
    double dark_V = 0.043, noise_V = 0.012;   ///< noise: standard deviation of a sample
    double slow_s = 0.0;                      ///< time constant
    bool lit = true;
    /// A Gaussian beam's share within the photodiode, without noise.
    double volts(double power_D) const;
};

/// What a wire to an analog input comes from.
enum class Heard { nothing, left, right, trigger, photodiode };

/// Never compared with a real bench. Wires may be plugged in wrongly, and anything may fail, at a test's will.
struct EmulatedBench {
    explicit EmulatedBench(LensPreset preset = LensPreset::datasheet, double room_C = 30.0);

    emulators::EmulatedDaq daq;
    std::array<LensEmulator, 2> lenses;
    EmulatedPhotodiode photodiode;
    Heard ai0 = Heard::left, ai1 = Heard::photodiode;
    int lensInBeam = 0;  ///< 0 left, 1 right
    std::array<bool, 2> lensPlugged{true, true};
    /// Light of a projector onto the photodiode instead of the laser's: volts by the seconds since its trigger.
    std::function<double(double since_s)> projectorLight;
    /// The projector's clock is 40 ppm slower than the converter's: no two crystals agree, and in step with the samples
    /// an edge would fall at the same place between two of them for ever.
    double triggerEvery_s = (1.0 + 40e-6) / 60.0;
    bool unplugged = false;
    int calls = 0, failsAt = 0;  ///< the n-th call of the link fails, and all after it when `goesAway`
    bool goesAway = false;
    double largest_A = 0.0;  ///< that went through any lens

    std::int64_t now_ns() const { return now_ns_; }
    void pass(std::chrono::nanoseconds time);
    Clock clock();
    std::shared_ptr<UsbLink> link();
    /// What the lens does once it repeats, without noise, as warm as it is: its power at n places of a period.
    std::vector<double> truth(int lens, const Harmonics& drive_A, Hertz rate, int n) const;
    /// Mean of what it rests at coming from 20 mA below and from above.
    double truthAtRest(int lens, double current_A) const;
    /// Through each lens now, in amperes.
    std::array<double, 2> currents();

    struct Out {
        std::function<void(std::span<std::uint8_t>)> fill;
        std::vector<std::vector<std::uint8_t>> queued;
        std::size_t bytes = 0;
    };
    struct In {
        std::function<void(std::span<const std::uint8_t>)> taken;
        std::vector<std::uint8_t> room;
        std::size_t filled = 0;
    };
    Out* out = nullptr;
    In* in = nullptr;
    bool failing();

private:
    void pump();
    void simulate();
    double input(int channel, std::int64_t time_ns);

    LensPreset preset_;
    std::int64_t now_ns_ = 1'000'000'000, simulated_ns_ = 1'000'000'000;
    struct Point {
        std::int64_t time_ns = 0;
        std::array<double, 2> power_D{};
    };
    std::deque<Point> past_;  ///< of the last tenth of a second
    std::array<double, 2> driven_A_{};
    std::int64_t seenAt_ns_ = 0;
    double seen_V_ = 0.0;
    std::mt19937 random_{7};
    std::normal_distribution<double> normal_;
};

}  // namespace ilf::devices
