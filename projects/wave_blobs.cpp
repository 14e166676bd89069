#include "projects/wave_blobs.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace ilf::projects {
namespace {

template <class Unsigned>
void append(std::string& out, Unsigned value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
        out.push_back(static_cast<char>(value >> (8 * i)));
}

template <class Unsigned>
Unsigned taken(std::string_view bytes, std::size_t at) {
    Unsigned value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
        value =
            static_cast<Unsigned>(value | static_cast<Unsigned>(static_cast<unsigned char>(bytes[at + i])) << (8 * i));
    return value;
}

}  // namespace

Samples16 packed16(std::span<const double> samples) {
    assert(!samples.empty());
    const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
    Samples16 out;
    out.offset = 0.5 * *low + 0.5 * *high;
    out.scale = *low == *high ? 1e-6 : (*high - *low) / 65534.0;
    out.atLow = static_cast<std::size_t>(low - samples.begin());
    out.atHigh = static_cast<std::size_t>(high - samples.begin());
    out.data.reserve(2 * samples.size());
    const auto rounded = [&](double sample) {
        return std::clamp(std::round((sample - out.offset) / out.scale), -32767.0, 32767.0);
    };
    for (const double sample : samples)
        append(out.data, static_cast<std::uint16_t>(static_cast<std::int16_t>(rounded(sample))));
    out.low = out.offset + out.scale * rounded(*low);
    out.high = out.offset + out.scale * rounded(*high);
    return out;
}

std::vector<double> unpacked16(std::string_view data, double scale, double offset) {
    if (data.size() % 2 != 0) return {};
    std::vector<double> out(data.size() / 2);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = offset + scale * static_cast<std::int16_t>(taken<std::uint16_t>(data, 2 * i));
    return out;
}

std::string packed(std::span<const std::complex<double>> numbers) {
    std::string out;
    for (const auto& number : numbers) {
        append(out, std::bit_cast<std::uint32_t>(static_cast<float>(number.real())));
        append(out, std::bit_cast<std::uint32_t>(static_cast<float>(number.imag())));
    }
    return out;
}

std::vector<std::complex<double>> unpackedComplex(std::string_view data) {
    if (data.size() % 8 != 0) return {};
    std::vector<std::complex<double>> out;
    for (std::size_t at = 0; at < data.size(); at += 8) {
        out.emplace_back(std::bit_cast<float>(taken<std::uint32_t>(data, at)),
                         std::bit_cast<float>(taken<std::uint32_t>(data, at + 4)));
    }
    return out;
}

std::string packed(std::span<const double> numbers) {
    std::string out;
    for (const double number : numbers)
        append(out, std::bit_cast<std::uint64_t>(number));
    return out;
}

std::vector<double> unpackedDoubles(std::string_view data) {
    if (data.size() % 8 != 0) return {};
    std::vector<double> out;
    for (std::size_t at = 0; at < data.size(); at += 8)
        out.push_back(std::bit_cast<double>(taken<std::uint64_t>(data, at)));
    return out;
}

}  // namespace ilf::projects
