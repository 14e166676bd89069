#include "core/lens/continuous_model.h"

#include <algorithm>
#include <limits>

#include "tests/core/lens/synthetic_lens.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

std::vector<LensRecord> someRecords(std::size_t count, double noise_D) {
    std::vector<LensRecord> records;
    for (const SineDrive& drive : drivesToRecord(-0.02, 0.045, count)) {
        records.push_back(SyntheticLens{}.record(static_cast<std::int64_t>(records.size()) + 1, drive.offset,
                                                 drive.amplitude, 60.0_Hz, noise_D));
    }
    return records;
}

const ContinuousModel& model() {
    static const ContinuousModel made = *fitted(someRecords(40, 0.007));
    return made;
}

}  // namespace

TEST_CASE("continuous model: it says what the lens does between its records") {
    CHECK(model().degree >= 3);
    CHECK(model().rmsFit_D == doctest::Approx(0.007).epsilon(0.1));
    law("predicted = true", [] {
        const double half = 0.0325, a = half * 0.001 * *rc::gen::inRange(0, 1000);
        const double o = 0.0125 + (half - a) * 0.001 * *rc::gen::inRange(-1000, 1000);
        const Harmonics predicted = model().power(o, a), truth = SyntheticLens{}.power(o, a, 60.0_Hz);
        for (int i = 0; i < 40; ++i)
            RC_ASSERT(std::abs(predicted.at(i / 40.0) - truth.at(i / 40.0)) < 0.006);
    });
}

TEST_CASE("continuous model: the amplitude's sign is half a period") {
    for (const double a : {0.003, 0.011, 0.02}) {
        const Harmonics turned = model().power(0.01, -a), late = model().power(0.01, a).delayed(0.5);
        for (int i = 0; i < 20; ++i)
            CHECK(turned.at(i / 20.0) == doctest::Approx(late.at(i / 20.0)));
    }
    const Harmonics still = model().power(0.01, 0.0);
    for (std::size_t k = 1; k < still.c.size(); ++k)
        CHECK(still.c[k] == 0.0);
}

TEST_CASE("continuous model: inverted, the predicted wave has the extremes that were asked for") {
    law("inverted", [] {
        const double half = 0.0325, a = half * 0.001 * *rc::gen::inRange(60, 1001);
        const double o = 0.0125 + (half - a) * 0.001 * *rc::gen::inRange(-1000, 1001);
        const double shift = 0.001 * *rc::gen::inRange(-300, 300);
        const Extremes wanted = extremes(model().power(o, a));
        const auto found = inverted(model(), wanted.low + shift, wanted.high + shift, shift);
        RC_ASSERT(found.has_value());
        const Extremes e = extremes(found->power);
        RC_ASSERT(std::abs(e.low - wanted.low - shift) < 1e-9);
        RC_ASSERT(std::abs(e.high - wanted.high - shift) < 1e-9);
        RC_ASSERT(std::abs(e.low - found->extremes.low) < 1e-12 && std::abs(e.high - found->extremes.high) < 1e-12);
        RC_ASSERT(std::abs(e.atLow - found->extremes.atLow) < 1e-6);
        RC_ASSERT(std::abs(e.atHigh - found->extremes.atHigh) < 1e-6);
        // One drive alone does it on a lens whose answer rises.
        RC_ASSERT(std::abs(found->drive.offset - o) < 1e-7);
        RC_ASSERT(std::abs(found->drive.amplitude - a) < 1e-7);
    });
}

TEST_CASE("continuous model: of two drives the one of less amplitude is found") {
    // The mean falls with the square of the amplitude, the swing rises and then falls: every range has two drives.
    ContinuousModel made;
    made.degree = 4;
    made.border = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};
    made.terms.resize(17);
    for (std::size_t k = 0; k < made.terms.size(); ++k)
        made.terms[k].resize(modelTerms(4, static_cast<int>(k)).size());
    const auto term = [&](int k, int i, int j) -> std::complex<double>& {
        const auto list = modelTerms(4, k);
        const auto it = std::ranges::find_if(list, [&](ModelTerm t) { return t.i == i && t.j == j; });
        return made.terms[static_cast<std::size_t>(k)][static_cast<std::size_t>(it - list.begin())];
    };
    term(0, 1, 0) = 3.0;
    term(1, 0, 1) = 2.0;
    term(1, 0, 3) = -1.5;  // swing 2 a - 1.5 a^3: largest at a = 2/3
    for (const double a : {0.1, 0.3, 0.5, 0.6}) {
        const double swing = 2.0 * a - 1.5 * a * a * a;
        const auto found = inverted(made, 0.2 - swing, 0.2 + swing, 0.0);
        REQUIRE(found);
        CHECK(found->drive.amplitude == doctest::Approx(a));
    }
}

TEST_CASE("continuous model: beyond the records nothing is found, and the largest high is where that begins") {
    for (const double low : {-1.5, -1.0, 0.0, 0.7, 1.5, 3.0}) {
        for (const double shift : {-0.2, 0.0, 0.33}) {
            const double largest = largestHigh(model(), low, shift);
            CAPTURE(low);
            CAPTURE(largest);
            REQUIRE(largest > low + 0.5);
            CHECK(inverted(model(), low, largest - 1e-3, shift));
            CHECK_FALSE(inverted(model(), low, largest + 1e-3, shift));
        }
    }
    CHECK(largestHigh(model(), -40.0, 0.0) == -40.0);
    CHECK_FALSE(inverted(model(), -40.0, 1.0, 0.0));
    CHECK_FALSE(inverted(model(), 1.0, 0.0, 0.0));
    CHECK_FALSE(inverted(model(), std::numeric_limits<double>::quiet_NaN(), 1.0, 0.0));
}

TEST_CASE("continuous model: a still lens is a drive without amplitude") {
    const auto found = inverted(model(), 1.25, 1.25, 0.1);
    REQUIRE(found);
    CHECK(found->drive.amplitude == 0.0);
    CHECK(found->power.mean() == doctest::Approx(1.25));
}

TEST_CASE("continuous model: the map can be made anew from the polynomials") {
    ContinuousModel bare = model();
    bare.map.clear();
    const auto a = inverted(model(), 0.0, 2.2, 0.0), b = inverted(bare, 0.0, 2.2, 0.0);
    REQUIRE(a);
    REQUIRE(b);
    CHECK(a->drive.offset == b->drive.offset);
    CHECK(a->drive.amplitude == b->drive.amplitude);
}

TEST_CASE("continuous model: more records let the polynomials have more terms, never the other way") {
    const auto few = fitted(someRecords(10, 0.007)), more = fitted(someRecords(40, 0.007));
    REQUIRE(few);
    REQUIRE(more);
    CHECK(few->degree <= more->degree);
}

TEST_CASE("continuous model: a sine that was recorded from elsewhere in its period is the same sine") {
    auto records = someRecords(20, 0.0);
    const ContinuousModel straight = *fitted(records);
    for (LensRecord& record : records) {
        const double delay = 0.1 * static_cast<double>(record.id % 7);
        const auto turned = harmonicsOf(record.power_D, 40).delayed(delay);
        record.power_D = samplesOf(turned, 250);
        record.drive = record.drive.delayed(delay);
    }
    const auto found = fitted(records);
    REQUIRE(found);
    CHECK(found->largestFit_D < straight.largestFit_D + 1e-6);
    CHECK(found->power(0.01, 0.01).at(0.3) == doctest::Approx(straight.power(0.01, 0.01).at(0.3)));
}

TEST_CASE("continuous model: records of a lens that stands still tell nothing of how it sweeps") {
    auto records = someRecords(20, 0.0);
    const ContinuousModel without = *fitted(records);
    for (int i = 0; i < 8; ++i) {
        records.push_back(SyntheticLens{}.record(100 + i, 0.004 * i, 0.0, 60.0_Hz));
        for (double& p : records.back().power_D)
            p += i % 2 == 0 ? 0.25 : -0.25;  // a loop's memory
    }
    const auto with = fitted(records);
    REQUIRE(with);
    CHECK(with->power(0.01, 0.002).mean() == without.power(0.01, 0.002).mean());
    CHECK(fitted(std::span(records).last(16)).error().fault == Fault::notFound);
}

TEST_CASE("continuous model: of a whole database the waves that glasses sweep through are fitted") {
    const SyntheticLens lens;
    const auto all = allWaves(lens, 31, 0.06, 60.0_Hz);
    std::vector<LensRecord> near;
    for (const LensRecord& record : all) {
        const auto [low, high] = std::ranges::minmax(record.power_D);
        if (low >= -5.0 && high <= 9.0) near.push_back(record);
    }
    REQUIRE(near.size() >= 100);
    REQUIRE(near.size() < all.size());
    const auto fromAll = fitted(all), fromNear = fitted(near);
    REQUIRE(fromAll);
    REQUIRE(fromNear);
    CHECK(fromAll->driveHigh == fromNear->driveHigh);
    CHECK(largestHigh(*fromAll, 0.0, 0.0) == doctest::Approx(largestHigh(*fromNear, 0.0, 0.0)));
}

TEST_CASE("continuous model: drives to record lie in the range, touch its borders and are all different") {
    law("drives", [] {
        const auto count = static_cast<std::size_t>(*rc::gen::inRange(9, 80));
        const double low = -0.001 * *rc::gen::inRange(0, 70), high = 0.001 * *rc::gen::inRange(1, 70);
        const auto drives = drivesToRecord(low, high, count);
        RC_ASSERT(drives.size() == count);
        double least = high, most = low;
        for (std::size_t i = 0; i < count; ++i) {
            RC_ASSERT(drives[i].amplitude >= 0.0);
            RC_ASSERT(drives[i].offset - drives[i].amplitude >= low - 1e-12);
            RC_ASSERT(drives[i].offset + drives[i].amplitude <= high + 1e-12);
            least = std::min(least, drives[i].offset - drives[i].amplitude);
            most = std::max(most, drives[i].offset + drives[i].amplitude);
            for (std::size_t j = 0; j < i; ++j) {
                RC_ASSERT(std::hypot(drives[i].offset - drives[j].offset, drives[i].amplitude - drives[j].amplitude) >
                          1e-3 * (high - low));
            }
        }
        RC_ASSERT(least < low + 1e-12);
        RC_ASSERT(most > high - 1e-12);
    });
}

TEST_CASE("continuous model: too few or too similar records are refused with a sentence") {
    const auto few = fitted(someRecords(9, 0.0));
    CHECK(few);
    auto records = someRecords(40, 0.0);
    CHECK(fitted(std::span(records).first(8)).error().what ==
          "A lens model needs at least 9 recorded waves, not 8: record some more, 40 are usual.");
    CHECK_FALSE(fitted({}));
    std::vector<LensRecord> same(20, records[7]);
    CHECK(fitted(same).error().fault == Fault::badFile);
    std::vector<LensRecord> oneAmplitude;
    for (int i = 0; i < 20; ++i)
        oneAmplitude.push_back(SyntheticLens{}.record(i, 0.001 * i, 0.01, 60.0_Hz));
    CHECK(fitted(oneAmplitude).error().fault == Fault::badFile);
    records[5].unit = DriveUnit::ampere;
    CHECK_FALSE(fitted(records));
    records[5].unit = DriveUnit::volt;
    records[5].power_D[3] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(fitted(records));
}
