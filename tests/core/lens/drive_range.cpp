#include "core/lens/drive_range.h"

#include <cmath>

#include "tests/core/lens/synthetic_lens.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

DriveLimits limits() {
    DriveLimits out;
    out.peak = 0.12;
    out.rms = 0.085;
    return out;
}

RecordLens recording(const SyntheticLens& lens, int* count = nullptr) {
    return [lens, count](const Harmonics& drive, Hertz rate) -> Result<LensRecord> {
        if (count != nullptr) ++*count;
        return lens.record(1, drive.mean(), drive.c.size() > 1 ? std::abs(drive.c[1]) : 0.0, rate, 0.005);
    };
}

}  // namespace

TEST_CASE("drive range: it reaches the powers asked for with a few records, on weak and strong lenses") {
    for (const double gain : {40.0, 165.0, 600.0}) {
        SyntheticLens lens;
        lens.gain_D_per_V = gain;
        int count = 0;
        const auto range = driveRange(recording(lens, &count), 60.0_Hz, -2.0, 6.0, limits());
        REQUIRE(range);
        CHECK(count <= 20);
        CAPTURE(gain);
        const auto reached = [&](double wanted, double drive) {
            const bool limited = std::abs(drive) > 0.0849;
            CHECK((limited || std::abs(lens.power(drive, 0.0, 60.0_Hz).mean() - wanted) < 0.1));
        };
        reached(-2.0, range->low);
        reached(6.0, range->high);
        const Extremes e = extremes(lens.power(0.5 * (range->low + range->high), range->largestAmplitude, 60.0_Hz));
        CHECK((gain < 100.0 || std::abs(e.high - e.low - 8.0) < 0.2));
    }
}

TEST_CASE("drive range: nothing is asked of the lens that its limits forbid") {
    law("limits", [] {
        SyntheticLens lens;
        lens.gain_D_per_V = *rc::gen::inRange(5, 300);
        DriveLimits allowed;
        allowed.peak = 0.001 * *rc::gen::inRange(5, 120);
        allowed.rms = 0.001 * *rc::gen::inRange(5, 100);
        bool kept = true;
        const RecordLens record = [&](const Harmonics& drive, Hertz rate) {
            const Extremes e = extremes(drive);
            kept = kept && std::max(-e.low, e.high) <= allowed.peak * (1.0 + 1e-9) &&
                   drive.rms() <= allowed.rms * (1.0 + 1e-9);
            return recording(lens)(drive, rate);
        };
        const auto range = driveRange(record, 60.0_Hz, -2.0, 6.0, allowed);
        if (range) (void)recordedRange(record, 60.0_Hz, *range);
        RC_ASSERT(kept);
    });
}

TEST_CASE("drive range: a lens that does not answer, a record that fails and a range that is none are refused") {
    SyntheticLens dead;
    dead.gain_D_per_V = dead.curved_D_per_V2 = 0.0;
    CHECK(driveRange(recording(dead), 60.0_Hz, -2.0, 6.0, limits()).error().fault == Fault::device);
    SyntheticLens reversed;
    reversed.gain_D_per_V = -100.0;
    CHECK(driveRange(recording(reversed), 60.0_Hz, -2.0, 6.0, limits()).error().fault == Fault::device);
    CHECK(driveRange(recording({}), 60.0_Hz, 6.0, -2.0, limits()).error().fault == Fault::outOfRange);
    CHECK(driveRange(recording({}), 60.0_Hz, -2.0, 6.0, {}).error().fault == Fault::outOfRange);
    const RecordLens failing = [](const Harmonics&, Hertz) -> Result<LensRecord> {
        return fail(Fault::device, "the photodiode is dark");
    };
    CHECK(driveRange(failing, 60.0_Hz, -2.0, 6.0, limits()).error().what == "the photodiode is dark");
    CHECK(recordedRange(failing, 60.0_Hz, {-0.01, 0.03, 0.02}).error().what == "the photodiode is dark");
}
