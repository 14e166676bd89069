#include "app/headless/received_view.h"

namespace ilf::app {
namespace {

Waveform receivedWave(Waveform wave, const std::vector<Dioptre>& powers, Second sweep) {
    wave.power = receivedPower(powers);
    wave.rate = 1.0 / sweep;
    wave.drive = {};
    return wave;
}

}  // namespace

Result<ReceivedShow> receivedShow(const Compiled& intended, const ReceivedSweep& sweep, Eye eye) {
    const auto& received = sweep.received;
    const auto& powers = eye == Eye::left ? received.left : received.right;
    if (sweep.light.empty() || powers.size() < 3 || !(received.sweep > 0.0_s)) {
        return fail(Fault::device, "The emulated rig received no light or no lens current over a whole sweep, so there "
                                   "is nothing to look at: let it play longer.");
    }
    ReceivedShow show{intended.plan, intended.program};
    show.plan.waveform = show.program.waveform = receivedWave(intended.program.waveform, powers, received.sweep);
    show.plan.levels.clear();
    show.plan.slots.clear();
    show.program.images.clear();
    show.program.imageOfSlot.clear();
    const auto slots = receivedSlots(sweep);
    const auto count = static_cast<double>(slots.size());
    for (std::size_t i = 0; i < slots.size(); ++i) {
        if (slots[i].light.size() != intended.program.projector) {
            return fail(Fault::device,
                        "The emulated rig's light has another raster than the program: it cannot be laid "
                        "over the scene.");
        }
        const int number = static_cast<int>(i);
        Slot slot;
        slot.index = number;
        slot.start = slots[i].start;
        slot.duration = slots[i].length;
        slot.power = show.plan.waveform.powerAt(slot.middle());
        // A view takes slots to be equally long: what was lit longer or shorter weighs as much more or less.
        slot.lit = {{number, count * (slots[i].length / received.sweep)}};
        show.plan.slots.push_back(std::move(slot));
        show.plan.levels.push_back({LevelKind::focus, show.plan.slots.back().power, {number}, 1.0, {}, {}});
        show.program.images.push_back(toTiles(slots[i].light));
        show.program.imageOfSlot.push_back(number);
    }
    show.program.slotRate = count * show.program.waveform.rate;
    return show;
}

}  // namespace ilf::app
