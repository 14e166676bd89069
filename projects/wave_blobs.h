// How numbers lie in a wave database's blobs: little endian, whatever the machine.
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ilf::projects {

/// P = offset + scale q, q a 16-bit integer. `low` and `high` are the extremes of the samples as they come back.
struct Samples16 {
    double scale = 1.0, offset = 0.0, low = 0.0, high = 0.0;
    std::size_t atLow = 0, atHigh = 0;
    std::string data;
};
/// The samples' range takes all of -32767..32767. Precondition: finite, not empty.
Samples16 packed16(std::span<const double> samples);
/// Nothing where the length is odd.
std::vector<double> unpacked16(std::string_view data, double scale, double offset);

/// complex64: real and imaginary part as 32-bit IEEE 754.
std::string packed(std::span<const std::complex<double>> numbers);
/// Nothing where the length does not fit.
std::vector<std::complex<double>> unpackedComplex(std::string_view data);

/// 64-bit IEEE 754.
std::string packed(std::span<const double> numbers);
std::vector<double> unpackedDoubles(std::string_view data);

}  // namespace ilf::projects
