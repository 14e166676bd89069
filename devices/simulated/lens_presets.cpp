#include <array>
#include <random>
#include <utility>

#include "devices/simulated/lens_emulator.h"

namespace ilf::devices {
namespace {

constexpr std::array<std::pair<LensPreset, std::string_view>, 5> kWords{{{LensPreset::slow, "slow"},
                                                                         {LensPreset::datasheet, "datasheet"},
                                                                         {LensPreset::lively, "lively"},
                                                                         {LensPreset::clean, "clean"},
                                                                         {LensPreset::dirty, "dirty"}}};

/// Signed `bits` over the clip's range, in volts at the amplifier's input.
double stepOfBits(const LensParameters& p, int bits) {
    return p.clip_A / p.amplifier_A_per_V / static_cast<double>(1 << bits);
}

LensParameters asPublished(LensPreset preset) {
    LensParameters p;
    p.dacStep_V = stepOfBits(p, 15);
    p.stiffnessSquare = 8e-4;
    p.loop_D = 0.05;
    switch (preset) {
    case LensPreset::slow:
        p.mode_Hz = 52.0, p.damping = 0.49;
        break;
    case LensPreset::datasheet:
        break;
    case LensPreset::lively:
        p.mode_Hz = 62.0, p.damping = 0.23;
        break;
    case LensPreset::clean:
        p.dacStep_V = p.stiffnessSquare = p.loop_D = p.mode2Share = 0.0;
        break;
    case LensPreset::dirty:
        p.dacRate_Hz = 1000.0;
        p.dacStep_V = stepOfBits(p, 12);
        p.stiffnessLinear = 0.03;
        p.stiffnessSquare = 0.003;
        p.mode2Share = 0.12;
        p.mode2Damping = 0.03;
        p.loop_D = 0.25;
        break;
    }
    return p;
}

}  // namespace

std::string_view word(LensPreset preset) {
    for (const auto& [one, word] : kWords) {
        if (one == preset) return word;
    }
    return "?";
}

std::optional<LensPreset> lensPresetFromWord(std::string_view word) {
    for (const auto& [one, its] : kWords) {
        if (its == word) return one;
    }
    return std::nullopt;
}

LensParameters lensParameters(LensPreset preset, std::uint64_t seed) {
    LensParameters p = asPublished(preset);
    if (seed == 0) return p;
    std::mt19937_64 random(seed);
    for (double* value : {&p.amplifier_A_per_V, &p.amplifierPole_s, &p.mode_Hz, &p.damping, &p.stiffnessLinear,
                          &p.stiffnessSquare, &p.mode2Ratio, &p.mode2Damping, &p.mode2Share, &p.loop_D, &p.slip_D,
                          &p.coil_ohm, &p.warming_C_per_W, &p.warming_s}) {
        const double unit = static_cast<double>(random() >> 11) * 0x1p-53;  // the same on every C++ library
        *value *= 0.8 + 0.4 * unit;
    }
    return p;
}

}  // namespace ilf::devices
