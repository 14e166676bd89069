#include "core/lens/waveform.h"

#include <array>
#include <utility>

namespace ilf {
namespace {

template <class T, std::size_t N>
using Words = std::array<std::pair<T, std::string_view>, N>;

constexpr Words<WaveMode, 5> kModes{{{WaveMode::idealSine, "ideal-sine"},
                                     {WaveMode::paper, "paper"},
                                     {WaveMode::slotAware, "slot-aware"},
                                     {WaveMode::continuous, "continuous"},
                                     {WaveMode::shaped, "shaped"}}};
constexpr Words<DriveUnit, 2> kUnits{{{DriveUnit::volt, "V"}, {DriveUnit::ampere, "A"}}};
constexpr Words<Provenance, 3> kProvenances{
    {{Provenance::simulated, "simulated"}, {Provenance::measured, "measured"}, {Provenance::imported, "imported"}}};

template <class T, std::size_t N>
std::string_view wordOf(const Words<T, N>& words, T value) {
    for (const auto& [one, word] : words) {
        if (one == value) return word;
    }
    return "?";
}

template <class T, std::size_t N>
std::optional<T> fromWord(const Words<T, N>& words, std::string_view word) {
    for (const auto& [one, its] : words) {
        if (its == word) return one;
    }
    return std::nullopt;
}

}  // namespace

std::string_view word(WaveMode mode) { return wordOf(kModes, mode); }
std::optional<WaveMode> waveModeFromWord(std::string_view word) { return fromWord(kModes, word); }
std::string_view word(DriveUnit unit) { return wordOf(kUnits, unit); }
std::string_view word(Provenance provenance) { return wordOf(kProvenances, provenance); }
std::optional<Provenance> provenanceFromWord(std::string_view word) { return fromWord(kProvenances, word); }

Waveform idealSine(Dioptre rest, Dioptre low, Dioptre high, Hertz rate, Second tLow) {
    Waveform wave;
    wave.rest = rest;
    wave.low = low;
    wave.high = high;
    wave.rate = rate;
    wave.power.c = {0.5 * (low + high).si()};
    if (low != high) {
        const Harmonics cosine{{0.0, -0.5 * (high - low).si()}};
        wave.power.c.push_back(cosine.delayed(tLow * rate).c[1]);
    }
    return wave;
}

Waveform stillWave(Dioptre rest, Dioptre power, Hertz rate) { return idealSine(rest, power, power, rate, {}); }

}  // namespace ilf
