// The stand-in schedule: slots of an ideal sine, equal luminance, and the budget.
#include "core/plan/schedule.h"

#include <cmath>
#include <set>

#include "tests/support/law.h"

using namespace ilf;

namespace {

/// From 0 D to `high`, lowest in the middle of slot 0.
Waveform sine(Dioptre high, const Rig& rig) { return idealSine(0.0_D, 0.0_D, high, rig.sweepRate, 0.5 / rig.slotRate); }

Schedule twoLevels(Dioptre high) {
    const Rig rig;
    return scheduled(sine(high, rig), rig, {{LevelKind::focus, 0.0_D, {}}, {LevelKind::blur, high, high - 0.2_D}});
}

double squareErrorByHand(const Waveform& wave, const Slot& slot, Dioptre level) {
    double sum = 0.0;
    const int steps = 2000;
    for (int i = 0; i < steps; ++i) {
        const Second t = slot.start + ((i + 0.5) / steps) * slot.duration;
        sum += std::pow((wave.powerAt(t) - level).si(), 2);
    }
    return sum / steps;
}

}  // namespace

TEST_CASE("schedule: the sine's ends fall on the middles of slots 0 and 8") {
    const Waveform wave = twoLevels(2.2_D).waveform;
    CHECK(wave.powerAt(0.5 / 960.0_Hz).si() == doctest::Approx(0.0));
    CHECK(wave.powerAt(8.5 / 960.0_Hz).si() == doctest::Approx(2.2));
}

TEST_CASE("schedule: 2.2 D at 960 Hz gives three slots a level, or a fifth of the light") {
    const Schedule s = twoLevels(2.2_D);
    CHECK(s.levels[0].slots == std::vector<int>{0, 1, 15});
    CHECK(s.levels[1].slots == std::vector<int>{7, 8, 9});
    CHECK(s.light == doctest::Approx(3.0 / 16.0));
    CHECK(s.slots[4].level == std::nullopt);
}

TEST_CASE("schedule: errors of slots are those of the waveform, by brute integration") {
    const Schedule s = twoLevels(2.2_D);
    for (const Level& level : s.levels) {
        double sum = 0.0;
        for (const int slot : level.slots) {
            sum += squareErrorByHand(s.waveform, s.slots[static_cast<std::size_t>(slot)], level.power);
        }
        const double rms = std::sqrt(sum / static_cast<double>(level.slots.size()));
        CHECK(level.rmsError.si() == doctest::Approx(rms).epsilon(1e-4));
    }
}

TEST_CASE("schedule: a lens that stands still lights every slot fully") {
    const Rig rig;
    const Schedule s = scheduled(sine(0.0_D, rig), rig, {{LevelKind::focus, 0.0_D, {}}});
    CHECK(s.levels[0].slots.size() == 16);
    CHECK(s.light == 1.0);
    CHECK(s.waveform.still());
}

TEST_CASE("schedule: a level in the middle of a fast sweep gets no slot") {
    const Rig rig;
    const Schedule s =
        scheduled(sine(4.0_D, rig), rig,
                  {{LevelKind::focus, 0.0_D, {}}, {LevelKind::focus, 2.2_D, {}}, {LevelKind::blur, 4.0_D, {}}});
    CHECK(s.levels[1].slots.empty());
}

TEST_CASE("schedule: laws") {
    law("levels share no slot, stay in their budgets and are equally bright", [] {
        const Rig rig;
        const Dioptre high = Dioptre::fromSi(0.01 * *rc::gen::inRange(30, 900));
        const Dioptre middle = *rc::gen::inRange(5, 95) * 0.01 * high;
        const Schedule s = scheduled(
            sine(high, rig), rig,
            {{LevelKind::focus, 0.0_D, {}}, {LevelKind::blur, middle, {}}, {LevelKind::blur, high, high - 0.2_D}});
        std::set<int> taken;
        std::size_t slots = 0;
        for (const Level& level : s.levels) {
            taken.insert(level.slots.begin(), level.slots.end());
            slots += level.slots.size();
            const Dioptre budget = level.kind == LevelKind::focus
                                       ? kFocusErrorBudget
                                       : std::max(kFocusErrorBudget, kBlurErrorShare * level.power);
            RC_ASSERT(level.rmsError <= budget * (1.0 + 1e-12));
            const double luminance = static_cast<double>(level.slots.size()) * level.weight / 16.0;
            RC_ASSERT(std::abs(luminance - s.light) < 0.004 * s.light + 1e-15);
        }
        RC_ASSERT(taken.size() == slots);
    });
}
