#include "core/lens/wave_table.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "tests/core/lens/synthetic_lens.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

constexpr double kSlot = 1.0 / 16.0;

const WaveTable& table() {
    static const WaveTable made = *waveTable(allWaves({}, 31, 0.03, 60.0_Hz, 0.005));
    return made;
}

double rmsAbout(const Harmonics& power, double centre, double target) {
    double squares = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const double off = power.at(centre + kSlot * ((i + 0.5) / 2000.0 - 0.5)) - target;
        squares += off * off / 2000.0;
    }
    return std::sqrt(squares);
}

/// The rule as it is written down, waves sorted as a whole.
std::optional<std::size_t> sortedRule(const WaveTable& waves, double low, double high, double shift) {
    std::vector<std::tuple<long, double, double, std::int64_t, std::size_t>> covering;
    for (std::size_t i = 0; i < waves.waves.size(); ++i) {
        if (waves.low_D[i] + shift > low || waves.high_D[i] + shift < high) continue;
        const TableWave& wave = waves.waves[i];
        covering.emplace_back(std::lround((waves.high_D[i] - waves.low_D[i]) * 1e3),
                              slotError(waves, i, low, high, shift, kSlot),
                              std::max(std::abs(wave.driveLow), std::abs(wave.driveHigh)), wave.id, i);
    }
    if (covering.empty()) return std::nullopt;
    return std::get<4>(*std::ranges::min_element(covering));
}

/// Random extremes on a coarse grid, so that ranges tie often.
WaveTable tied(std::size_t count) {
    WaveTable waves;
    std::vector<std::pair<double, double>> ranges;
    for (std::size_t i = 0; i < count; ++i)
        ranges.emplace_back(0.0005 * *rc::gen::inRange(-20, 20), 1.0 + 0.0005 * *rc::gen::inRange(-20, 20));
    std::ranges::stable_sort(ranges, {}, [](const auto& range) { return range.second - range.first; });
    for (const auto& [low, high] : ranges) {
        TableWave wave;
        wave.id = *rc::gen::inRange(1, 5);
        wave.driveLow = -0.01 * *rc::gen::inRange(1, 3);
        wave.driveHigh = 0.01;
        wave.power.c = {0.5 * (low + high), 0.5 * (high - low)};
        waves.low_D.push_back(low);
        waves.high_D.push_back(high);
        for (auto* slots : {&waves.atLow, &waves.atHigh}) {
            slots->centre.push_back(0.0);
            slots->mean.push_back(slots == &waves.atLow ? low : high);
            slots->variance.push_back(0.001 * *rc::gen::inRange(0, 2));
        }
        waves.waves.push_back(wave);
    }
    return waves;
}

}  // namespace

TEST_CASE("wave table: extremes are those of the recorded power, drives those that were played") {
    const SyntheticLens lens;
    const auto records = allWaves(lens, 6, 0.03, 60.0_Hz);
    const auto made = waveTable(records);
    REQUIRE(made);
    REQUIRE(made->waves.size() == 15);
    for (std::size_t i = 0; i < made->waves.size(); ++i) {
        const LensRecord& record = records[static_cast<std::size_t>(made->waves[i].id - 1)];
        const auto [low, high] = std::ranges::minmax(record.power_D);
        CHECK(made->low_D[i] <= low + 1e-9);
        CHECK(made->low_D[i] > low - 0.002);
        CHECK(made->high_D[i] >= high - 1e-9);
        CHECK(made->high_D[i] < high + 0.002);
        CHECK(made->waves[i].driveLow == doctest::Approx(record.drive.mean() - std::abs(record.drive.c[1])));
        CHECK(made->waves[i].driveHigh == doctest::Approx(record.drive.mean() + std::abs(record.drive.c[1])));
        if (i > 0) CHECK(made->high_D[i] - made->low_D[i] >= made->high_D[i - 1] - made->low_D[i - 1]);
    }
}

TEST_CASE("wave table: the narrowest covering wave is the one that sorting all of them gives") {
    law("paper rule = sort", [] {
        const double low = 0.001 * *rc::gen::inRange(-3000, 3000);
        const double high = low + 0.001 * *rc::gen::inRange(0, 6000);
        const double shift = 0.001 * *rc::gen::inRange(-400, 400);
        RC_ASSERT(narrowestCovering(table(), low, high, shift, kSlot) == sortedRule(table(), low, high, shift));
    });
}

TEST_CASE("wave table: ties of range are decided by slot error, then drive, then id, whatever the order of waves") {
    law("ties", [] {
        const WaveTable waves = tied(60);
        const double low = 0.0005 * *rc::gen::inRange(-10, 20), high = 1.0 + 0.0005 * *rc::gen::inRange(-20, 10);
        const double shift = 0.001 * *rc::gen::inRange(-3, 3);
        const auto found = narrowestCovering(waves, low, high, shift, kSlot);
        RC_ASSERT(found == sortedRule(waves, low, high, shift));
    });
}

TEST_CASE("wave table: a chosen wave covers what was asked, and no shorter range does") {
    law("covers", [] {
        const double low = *rc::gen::inRange(-2000, 2000) * 1e-3, high = low + *rc::gen::inRange(1, 5000) * 1e-3;
        const auto found = narrowestCovering(table(), low, high, 0.0, kSlot);
        RC_PRE(found.has_value());
        RC_ASSERT(table().low_D[*found] <= low);
        RC_ASSERT(table().high_D[*found] >= high);
        const double range = table().high_D[*found] - table().low_D[*found];
        for (std::size_t i = 0; i < table().waves.size(); ++i) {
            if (table().low_D[i] <= low && table().high_D[i] >= high)
                RC_ASSERT(table().high_D[i] - table().low_D[i] > range - 1e-3);
        }
    });
}

TEST_CASE("wave table: the least slot error is the least of all that are near") {
    law("slot aware = brute force", [] {
        const double low = *rc::gen::inRange(-1500, 1500) * 1e-3, high = low + *rc::gen::inRange(500, 5000) * 1e-3;
        const double shift = 0.001 * *rc::gen::inRange(-400, 400);
        std::optional<std::size_t> best;
        for (std::size_t i = 0; i < table().waves.size(); ++i) {
            if (std::abs(table().low_D[i] + shift - low) > 0.6 || std::abs(table().high_D[i] + shift - high) > 0.6)
                continue;
            const auto error = [&](std::size_t w) { return slotError(table(), w, low, high, shift, kSlot); };
            if (!best || error(i) < error(*best)) best = i;
        }
        RC_ASSERT(leastSlotError(table(), low, high, shift, kSlot) == best);
    });
}

TEST_CASE("wave table: slot errors are those of the power, of the table's slots and of others") {
    for (const std::size_t i : std::initializer_list<std::size_t>{3, 77, 200, 400}) {
        const Harmonics& power = table().waves[i].power;
        const Extremes e = extremes(power);
        const double low = e.low + 0.1, high = e.high - 0.05;
        const double expected = std::hypot(rmsAbout(power, e.atLow, low), rmsAbout(power, e.atHigh, high));
        CHECK(std::sqrt(slotError(table(), i, low, high, 0.0, kSlot)) == doctest::Approx(expected).epsilon(1e-5));
        CHECK(slotError(table(), i, low, high, 0.0, kSlot * (1.0 + 1e-9)) ==
              doctest::Approx(slotError(table(), i, low, high, 0.0, kSlot)).epsilon(1e-6));
    }
}

TEST_CASE("wave table: waves beyond the limits are no candidates") {
    DriveLimits limits;
    limits.peak = 0.03;
    limits.rms = 0.03;
    const auto free = narrowestCovering(table(), -1.0, 3.0, 0.0, kSlot);
    REQUIRE(free);
    CHECK(narrowestCovering(table(), -1.0, 3.0, 0.0, kSlot, &limits) == free);
    limits.peak = 1e-4;
    CHECK_FALSE(narrowestCovering(table(), -1.0, 3.0, 0.0, kSlot, &limits));
    CHECK_FALSE(leastSlotError(table(), -1.0, 3.0, 0.0, kSlot, &limits));
    limits.peak = 0.03;
    limits.lensMax = 2.9_D;
    CHECK_FALSE(narrowestCovering(table(), -1.0, 3.0, 0.0, kSlot, &limits));
}

TEST_CASE("wave table: a room that warms while recording does not move the waves; a coil's own warmth stays") {
    const SyntheticLens lens;
    auto records = allWaves(lens, 8, 0.03, 60.0_Hz);
    const WaveTable cool = *waveTable(records);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const double own = 1500.0 * records[i].drive.rms() * records[i].drive.rms();
        records[i].temperature_C = 25.0 + own;
        for (double& p : records[i].power_D)
            p += 0.033 * own;
    }
    const WaveTable own = *waveTable(records);
    CHECK(own.temperature_C == doctest::Approx(25.0));
    const LensRecord& fifth = records[static_cast<std::size_t>(cool.waves[5].id - 1)];
    CHECK(own.low_D[5] == doctest::Approx(cool.low_D[5] + 0.033 * (fifth.temperature_C - 25.0)));

    for (LensRecord& record : records) {
        for (double& p : record.power_D)
            p += 0.033 * 0.5;
        record.temperature_C += 0.5;
    }
    const WaveTable warm = *waveTable(records);
    CHECK(warm.temperature_C == doctest::Approx(25.5));
    CHECK(warm.low_D[5] == doctest::Approx(own.low_D[5] + 0.033 * 0.5));
}

TEST_CASE("wave table: what is no record of a sine is refused with a sentence") {
    const SyntheticLens lens;
    auto records = allWaves(lens, 4, 0.03, 60.0_Hz);
    CHECK(waveTable({}).error().fault == Fault::notFound);

    auto wrong = records;
    wrong[2].power_D[17] = std::numeric_limits<double>::quiet_NaN();
    CHECK(waveTable(wrong).error().what == "Record 3 has no number at sample 17: record it anew.");
    wrong = records;
    wrong[1].rate = 62.5_Hz;
    CHECK(waveTable(wrong).error().what ==
          "Record 2 was made at 62.5 Hz, the first at 60 Hz: keep one table for each rate.");
    wrong = records;
    wrong[1].family = "shaped";
    CHECK(waveTable(wrong).error().fault == Fault::badFile);
    wrong = records;
    wrong[1].drive.c.push_back(0.001);
    CHECK(waveTable(wrong).error().fault == Fault::badFile);
    wrong = records;
    wrong[4].power_D.resize(5);
    CHECK(waveTable(wrong).error().fault == Fault::badFile);
    wrong = records;
    wrong[4].temperature_C = std::numeric_limits<double>::infinity();
    CHECK(waveTable(wrong).error().fault == Fault::badFile);
}

TEST_CASE("wave table: nothing covers a range that is not a number or beyond all waves") {
    CHECK_FALSE(narrowestCovering(table(), 0.0, 100.0, 0.0, kSlot));
    CHECK_FALSE(narrowestCovering(table(), std::numeric_limits<double>::quiet_NaN(), 1.0, 0.0, kSlot));
    CHECK_FALSE(leastSlotError(table(), 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0, kSlot));
}
