#include "app/headless/received_light.h"

#include <algorithm>
#include <cmath>

#include "devices/dlpc350/frame.h"

namespace ilf::app {
namespace {

/// Light of each slot, 8 bits a pixel, as the projector's pictures can have it.
std::vector<LightImage> statedLight(const Program& program, const Rig& rig) {
    return devices::dlpc350::intendedLight(program, rig.kind == ProjectorKind::lightCrafter4500 ? rig.bits : 8);
}

}  // namespace

Harmonics receivedPower(const std::vector<Dioptre>& powers) {
    // Up to some 2 kHz at 60 sweeps a second: a lens follows nothing faster.
    constexpr std::size_t kHarmonics = 32;
    std::vector<double> samples(powers.size());
    std::ranges::transform(powers, samples.begin(), [](Dioptre power) { return power.si(); });
    return harmonicsOf(samples, std::min(kHarmonics, (samples.size() - 1) / 2));
}

std::vector<devices::SlotLight> intendedSlots(const Program& program, const Rig& rig) {
    std::vector<devices::SlotLight> slots;
    const Second length = 1.0 / program.slotRate;
    for (const LightImage& light : statedLight(program, rig)) {
        const Second start = program.projectorDelay + static_cast<double>(slots.size()) * length;
        slots.push_back({toImage(light), start, length});
    }
    return slots;
}

std::vector<devices::SlotLight> receivedSlots(const ReceivedSweep& sweep) {
    std::vector<devices::SlotLight> slots;
    for (std::size_t i = 0; i < sweep.light.size(); ++i) {
        const auto& exposure = sweep.received.exposures[i];
        const auto& light = sweep.light[i];
        // Light of another raster than it says is no light at all; the comparison then counts every pixel.
        const auto pixels =
            static_cast<std::size_t>(light.raster.width) * static_cast<std::size_t>(light.raster.height);
        Image<std::uint8_t> picture;
        if (light.light.size() == pixels) picture = {light.raster, 1, light.light};
        slots.push_back({std::move(picture), exposure.start, exposure.length, exposure.colours});
    }
    return slots;
}

Quantisation quantisationOf(const Program& program, const Rig& rig) {
    Quantisation found;
    found.bits = rig.kind == ProjectorKind::lightCrafter4500 ? rig.bits : 8;
    found.step = 1.0 / static_cast<double>((1 << found.bits) - 1);
    const auto stated = statedLight(program, rig);
    std::int64_t sum = 0, signedSum = 0, count = 0;
    int largest = 0;
    for (std::size_t slot = 0; slot < stated.size(); ++slot) {
        const int image = program.imageOfSlot[slot];
        const auto after = toImage(stated[slot]);
        const auto before = image == Program::kDark ? toImage(LightImage(program.projector))
                                                    : toImage(program.images[static_cast<std::size_t>(image)]);
        for (std::size_t i = 0; i < after.pixels().size(); ++i) {
            const int error = int(after.pixels()[i]) - int(before.pixels()[i]);
            largest = std::max(largest, std::abs(error));
            sum += std::abs(error);
            signedSum += error;
            ++count;
        }
    }
    const double all = 255.0 * static_cast<double>(std::max<std::int64_t>(count, 1));
    found.largest = largest / 255.0;
    found.mean = static_cast<double>(sum) / all;
    found.shift = static_cast<double>(signedSum) / all;
    return found;
}

LensDeviation deviationOf(const std::vector<Dioptre>& powers, Second sweep, const Program& program,
                          const devices::LightComparison& comparison) {
    LensDeviation found;
    const auto count = static_cast<double>(powers.size());
    const Harmonics received = receivedPower(powers);
    const auto away = [&](std::size_t i) {
        const Second t = static_cast<double>(i) / count * sweep - program.projectorDelay;
        return (powers[i] - program.waveform.powerAt(t)).si();
    };
    double squares = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < powers.size(); ++i) {
        squares += away(i) * away(i);
        worst = std::max(worst, std::abs(away(i)));
    }
    found.rms = Dioptre::fromSi(std::sqrt(squares / count));
    found.worst = Dioptre::fromSi(worst);
    double inSlots = 0.0;
    const Second length = 1.0 / program.slotRate;
    for (std::size_t slot = 0; slot < comparison.slots.size(); ++slot) {
        const Second due = static_cast<double>(slot) * length;
        const Second start = due + program.projectorDelay + comparison.slots[slot].late;
        const Second lit = length + comparison.slots[slot].longer;
        const double predicted =
            program.waveform.power.meanOver(due * program.waveform.rate, length * program.waveform.rate);
        found.slots.push_back(
            {Dioptre::fromSi(predicted), Dioptre::fromSi(received.meanOver(start / sweep, lit / sweep))});
        inSlots += std::pow((found.slots.back().received - found.slots.back().predicted).si(), 2);
    }
    if (!found.slots.empty())
        found.rmsInSlots = Dioptre::fromSi(std::sqrt(inSlots / static_cast<double>(found.slots.size())));
    return found;
}

Ended endedAs(const ReceivedSweep& sweep, Dioptre rest) {
    Ended ended;
    constexpr double kGaps = 0.001;
    double lit = 0.0;
    bool full = true;
    for (std::size_t i = 0; i < sweep.light.size(); ++i) {
        const auto& pixels = sweep.light[i].light;
        double sum = 0.0;
        for (const std::uint8_t value : pixels)
            sum += value;
        full = full && !pixels.empty() && sweep.received.exposures[i].colours == 7 &&
               std::ranges::all_of(pixels, [](std::uint8_t value) { return value == 255; });
        const double share = sweep.received.exposures[i].length / sweep.received.sweep;
        lit += share;
        if (!pixels.empty()) ended.light += share * sum / (255.0 * static_cast<double>(pixels.size()));
    }
    ended.steadyWhite = full && lit >= 1.0 - kGaps;
    for (const auto* powers : {&sweep.received.left, &sweep.received.right}) {
        for (const Dioptre power : *powers)
            ended.farthest = std::max(ended.farthest, abs(power - rest));
    }
    ended.atRest = !sweep.received.left.empty() && !sweep.received.right.empty() && ended.farthest <= kAtRest;
    return ended;
}

}  // namespace ilf::app
