#include "devices/emulated_scene/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"

namespace ilf::devices::scene {
namespace {

constexpr std::size_t kBell = 4096, kCurve = 16384;

/// The normal distribution's values at even steps of probability, by bisection of its integral.
const std::array<float, kBell>& bell() {
    static const std::array<float, kBell> table = [] {
        std::array<float, kBell> values{};
        for (std::size_t i = 0; i < kBell; ++i) {
            const double wanted = (static_cast<double>(i) + 0.5) / kBell;
            double low = -6.0, high = 6.0;
            for (int step = 0; step < 50; ++step) {
                const double middle = 0.5 * (low + high);
                (0.5 * std::erfc(-middle / std::sqrt(2.0)) < wanted ? low : high) = middle;
            }
            values[i] = static_cast<float>(0.5 * (low + high));
        }
        return values;
    }();
    return table;
}

std::uint64_t mixed(std::uint64_t z) {
    z += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

}  // namespace

Image<std::uint8_t> exposed(const LightTransport& transport, const std::vector<float>& light,
                            const SensorSettings& settings) {
    return exposed(transport.stage().camera.size, light, transport.tint(), settings);
}

Image<std::uint8_t> exposed(Size size, const std::vector<float>& light, const std::vector<std::uint8_t>& tint,
                            const SensorSettings& settings) {
    const auto electronsPerLux = static_cast<float>(settings.perLuxSecond * settings.exposure.si());
    const auto share = static_cast<float>(settings.gain / settings.fullWell);
    std::vector<std::uint8_t> curve(kCurve);
    for (std::size_t i = 0; i < kCurve; ++i) {
        const double signal = static_cast<double>(i) / (kCurve - 1);
        curve[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::pow(signal, 1.0 / settings.gamma)));
    }
    const auto& normal = bell();
    const float read2 = static_cast<float>(settings.readNoise * settings.readNoise),
                noisy = settings.noisy ? 1.0F : 0.0F;
    std::vector<std::uint8_t> rgb(3 * light.size());
    parallelFor(size.height, [&](int y) {
        std::uint64_t state = mixed(settings.seed * 0x100000001B3U + static_cast<std::uint64_t>(y)) | 1U;
        const std::size_t begin = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width);
        for (std::size_t i = begin; i < begin + static_cast<std::size_t>(size.width); ++i) {
            state ^= state << 13U;
            state ^= state >> 7U;
            state ^= state << 17U;
            for (std::size_t c = 0; c < 3; ++c) {
                const float mean = electronsPerLux * light[i] * static_cast<float>(tint[3 * i + c]) * (1.0F / 64.0F);
                const float noise = normal[(state >> (12U * c + 8U)) & (kBell - 1)] * std::sqrt(mean + read2);
                const float signal = std::clamp(share * (mean + noisy * noise), 0.0F, 1.0F);
                rgb[3 * i + c] = curve[static_cast<std::size_t>(signal * static_cast<float>(kCurve - 1) + 0.5F)];
            }
        }
    });
    return Image<std::uint8_t>(size, 3, std::move(rgb));
}

}  // namespace ilf::devices::scene
