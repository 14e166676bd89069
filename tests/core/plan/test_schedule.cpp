// The stand-in schedule: slots of an ideal sine, equal luminance, and the budget.
#include "core/plan/schedule.h"

#include <algorithm>
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
    INFO(s.levels[0].slots.size(), " ", s.levels[1].slots.size(), " ", s.light);
    CHECK(s.levels[0].slots == std::vector<int>{0, 1, 15});
    CHECK(s.levels[1].slots == std::vector<int>{7, 8, 9});
    CHECK(s.light >= 3.0 / 16.0);
    CHECK(s.slots[4].lit.empty());
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
    law("levels stay in their budgets, are equally bright, and focus shares no slot with blur", [] {
        Rig rig;
        rig.bits = *rc::gen::element(8, 6, 1);
        rig.powerBudget = *rc::gen::inRange(5, 50) * 0.01_D;
        const Dioptre high = Dioptre::fromSi(0.01 * *rc::gen::inRange(30, 900));
        const Dioptre middle = *rc::gen::inRange(5, 95) * 0.01 * high;
        const std::vector<LevelWish> wishes{
            {LevelKind::focus, 0.0_D, {}}, {LevelKind::blur, middle, {}}, {LevelKind::blur, high, high - 0.2_D}};
        const Schedule s = scheduled(sine(high, rig), rig, wishes);
        const bool allHeld = std::ranges::none_of(s.levels, [](const Level& level) { return level.slots.empty(); });
        for (const Level& level : s.levels) {
            RC_ASSERT(level.rmsError <= level.budget * (1.0 + 1e-9));
            if (allHeld) RC_ASSERT(std::abs(level.exposure / 16.0 - s.light) < 0.004 * s.light);
        }
        double given = 0.0;
        for (const Slot& slot : s.slots) {
            std::set<LevelKind> kinds;
            for (const LevelLight& light : slot.lit) {
                kinds.insert(s.levels[static_cast<std::size_t>(light.level)].kind);
                RC_ASSERT(light.weight > 0.0);
                RC_ASSERT(light.weight <= 1.0);
                const double steps = light.weight * (std::exp2(rig.bits) - 1.0);
                RC_ASSERT(std::abs(steps - std::round(steps)) < 1e-6);
                given += light.weight;
            }
            RC_ASSERT(kinds.size() <= 1);
        }
        double asked = 0.0;
        for (const Level& level : s.levels)
            asked += level.exposure;
        RC_ASSERT(std::abs(given - asked) < 1e-9);
    });

    law("more error allowed never gives less light", [] {
        Rig rig;
        const Dioptre high = Dioptre::fromSi(0.01 * *rc::gen::inRange(30, 900));
        const std::vector<LevelWish> wishes{{LevelKind::focus, 0.0_D, {}}, {LevelKind::blur, high, {}}};
        const Waveform wave = sine(high, rig);
        rig.powerBudget = *rc::gen::inRange(5, 50) * 0.01_D;
        const double before = scheduled(wave, rig, wishes).light;
        rig.powerBudget = rig.powerBudget + *rc::gen::inRange(1, 20) * 0.01_D;
        // Not exactly monotone: the wave moves only for 2 % of gain.
        RC_ASSERT(scheduled(wave, rig, wishes).light >= before / 1.02 - 1e-9);
    });
}

TEST_CASE("schedule: the light of two levels is what choosing among all sets of slots gives at best") {
    // Every subset of 16 slots for one level, the last one in part: the greedy choice is the optimum.
    Rig rig;
    rig.bits = 8;
    const Waveform wave = sine(2.2_D, rig);
    const Schedule s = scheduled(wave, rig, {{LevelKind::focus, 0.0_D, {}}});
    std::vector<double> errors;
    for (const Slot& slot : s.slots)
        errors.push_back(squareErrorByHand(s.waveform, slot, 0.0_D));
    const double allowed = std::pow(rig.powerBudget.si(), 2);
    double best = 0.0;
    for (unsigned set = 1; set < 1U << 16U; ++set) {
        double sum = 0.0, count = 0.0;
        for (unsigned i = 0; i < 16; ++i) {
            if ((set >> i & 1U) == 0) continue;
            sum += errors[i];
            count += 1.0;
        }
        if (sum > allowed * count || count + 1.0 <= best) continue;
        double part = 0.0;
        for (unsigned i = 0; i < 16; ++i) {
            if ((set >> i & 1U) == 0 && errors[i] > allowed)
                part = std::max(part, std::min(1.0, (allowed * count - sum) / (errors[i] - allowed)));
        }
        best = std::max(best, count + part);
    }
    CHECK(s.levels[0].exposure == doctest::Approx(best).epsilon(1.0 / 255.0 / best + 1e-4));
}
