#include "core/lens/sine_record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace ilf {

bool sameRate(Hertz a, Hertz b) { return abs(a - b) < 1e-6 * abs(b); }

std::string shortly(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

Result<SineRecord> sineRecord(const LensRecord& record, Hertz rate) {
    const auto refuse = [&](const std::string& what) {
        return fail(Fault::badFile, "Record " + std::to_string(record.id) + " " + what);
    };
    if (record.family != "sine")
        return refuse("is of family \"" + record.family + "\": choosing among sines needs records of family \"sine\".");
    if (!(record.rate > 0.0_Hz) || !sameRate(record.rate, rate)) {
        return refuse("was made at " + shortly(record.rate.si()) + " Hz, the first at " + shortly(rate.si()) +
                      " Hz: keep one table for each rate.");
    }
    if (record.power_D.size() < 8)
        return refuse("has only " + std::to_string(record.power_D.size()) + " samples; 8 are the least, 250 usual.");
    const auto wrong = std::ranges::find_if(record.power_D, [](double p) { return !std::isfinite(p); });
    if (wrong != record.power_D.end())
        return refuse("has no number at sample " + std::to_string(wrong - record.power_D.begin()) +
                      ": record it anew.");
    const auto& drive = record.drive.c;
    const auto several = [](const std::complex<double>& c) { return c != 0.0; };
    if (drive.size() > 2 && std::any_of(drive.begin() + 2, drive.end(), several))
        return refuse("is called a sine, but its drive has several harmonics: its family is wrong.");
    if (!std::ranges::all_of(drive, [](auto c) { return std::isfinite(c.real()) && std::isfinite(c.imag()); }) ||
        !std::isfinite(record.temperature_C))
        return refuse("has no number for its drive or temperature: record it anew.");

    SineRecord sine;
    sine.offset = record.drive.mean();
    sine.temperature_C = record.temperature_C;
    sine.power = harmonicsOf(record.power_D, std::min(kRecordHarmonics, (record.power_D.size() - 1) / 2));
    if (drive.size() < 2 || drive[1] == 0.0) return sine;
    sine.amplitude = std::abs(drive[1]);
    // A sine that begins elsewhere is turned to begin at its rising middle, and the power with it.
    const double late = (std::arg(drive[1]) / std::numbers::pi + 0.5) / 2.0;
    if (std::abs(late) > 1e-12) {
        sine.late = late;
        sine.power = sine.power.delayed(late);
    }
    return sine;
}

Warmth warmth(std::span<const SineRecord> records) {
    // A straight line through (mean square of the drive, temperature).
    const double n = static_cast<double>(records.size());
    const auto square = [](const SineRecord& r) { return r.offset * r.offset + 0.5 * r.amplitude * r.amplitude; };
    double meanSquare = 0.0, mean_C = 0.0, spread = 0.0, together = 0.0;
    for (const SineRecord& r : records) {
        meanSquare += square(r) / n;
        mean_C += r.temperature_C / n;
    }
    for (const SineRecord& r : records) {
        spread += (square(r) - meanSquare) * (square(r) - meanSquare);
        together += (square(r) - meanSquare) * (r.temperature_C - mean_C);
    }
    // A drive never cools the coil.
    const double warming = spread > 0.0 ? std::max(0.0, together / spread) : 0.0;
    Warmth out{mean_C - warming * meanSquare, warming, {}};
    for (const SineRecord& r : records)
        out.warmerThanThat_C.push_back(r.temperature_C - warming * square(r) - out.resting_C);
    return out;
}

}  // namespace ilf
