// What `run --rig emulated` makes of what was received: compared with the intention, and seen by the wearer. Without a
// rig: tests/app/emulated/run_emulated.cpp is the whole of it.
#include <doctest/doctest.h>

#include <utility>

#include "app/headless/received_view.h"
#include "app/headless/run_report.h"
#include "core/perceived/perceived.h"

using namespace ilf;
using namespace ilf::app;

namespace {

Prepared sample(const RigChoice& choice) {
    auto project = prepared(std::string(ILF_SOURCE_DIR) + "/projects/samples/four-objects.ilfd", choice);
    if (!project) FAIL(project.error().what);
    return *std::move(project);
}

/// A sweep as a rig without fault receives it.
ReceivedSweep asSent(const Program& program, const Rig& rig) {
    ReceivedSweep sweep;
    sweep.received.sweep = 1.0 / program.waveform.rate;
    sweep.received.raster = program.projector;
    for (const auto& slot : intendedSlots(program, rig)) {
        const int number = static_cast<int>(sweep.light.size());
        sweep.received.exposures.push_back({slot.start, slot.length});
        const auto pixels = slot.light.pixels();
        sweep.light.push_back({number, slot.light.size(), {pixels.begin(), pixels.end()}});
    }
    constexpr int kSamples = 800;
    for (int i = 0; i < kSamples; ++i) {
        const Second t = double(i) / kSamples * sweep.received.sweep - program.projectorDelay;
        sweep.received.left.push_back(program.waveform.powerAt(t));
        sweep.received.right.push_back(program.waveform.powerAt(t) + 0.1_D);
    }
    return sweep;
}

/// How near the view of what was received comes to the view intended.
double seen_dB(const Compiled& compiled, const ReceivedSweep& sweep, Eye eye = Eye::left) {
    ViewRequest request;
    request.eye = eye;
    request.scale = 0.25;
    const auto show = receivedShow(compiled, sweep, eye);
    if (!show) FAIL(show.error().what);
    const auto intended = perceived(compiled.document, compiled.plan, compiled.program, request);
    const auto received = perceived(compiled.document, show->plan, show->program, request);
    REQUIRE(intended);
    REQUIRE(received);
    return psnr(*intended, *received);
}

}  // namespace

TEST_CASE("received: sent through 8 bits without fault nothing differs, and the wearer sees what was intended") {
    const Prepared project = sample({});
    const Rig& rig = project.compiled.document.rig;
    const ReceivedSweep sweep = asSent(project.compiled.program, rig);
    const Outcome outcome = outcomeOf(sweep, project.compiled.program, rig);
    CHECK(asIntended(outcome));
    CHECK(outcome.light.differingPixels == 0);
    CHECK(abs(outcome.light.offset) < 0.001_us);  // the projector's delay is no lateness
    CHECK(outcome.quantisation.largest == 0.0);
    CHECK(outcome.lenses[0].worst < Dioptre::fromSi(1e-9));
    CHECK(outcome.lenses[1].rms.si() == doctest::Approx(0.1).epsilon(1e-6));
    CHECK(outcome.lenses[1].rmsInSlots.si() == doctest::Approx(0.1).epsilon(0.05));
    CHECK(seen_dB(project.compiled, sweep) > 55.0);
    CHECK(seen_dB(project.compiled, sweep, Eye::right) < seen_dB(project.compiled, sweep) - 3.0);
}

TEST_CASE("received: the emulated rig's bits are stated and no difference; exchanged slots are one, and are seen") {
    const Prepared project = sample({.rig = "emulated"});
    const Program& program = project.compiled.program;
    const Rig& rig = project.compiled.document.rig;
    ReceivedSweep sweep = asSent(program, rig);
    const Outcome good = outcomeOf(sweep, program, rig);
    CHECK(asIntended(good));
    CHECK(good.quantisation.bits == 4);
    CHECK(good.quantisation.largest > 0.0);
    CHECK(good.quantisation.largest <= good.quantisation.step);
    CHECK(std::abs(good.quantisation.shift) < 0.005);
    const double before_dB = seen_dB(project.compiled, sweep);
    CHECK(before_dB > 30.0);

    std::size_t first = 0, second = 1;
    while (second + 1 < sweep.light.size() && sweep.light[second].light == sweep.light[first].light)
        ++second;
    std::swap(sweep.light[first].light, sweep.light[second].light);
    const Outcome wrong = outcomeOf(sweep, program, rig);
    CHECK_FALSE(asIntended(wrong));
    CHECK(wrong.light.differingPixels > 0);
    CHECK(wrong.light.slots[first].differingPixels == wrong.light.slots[second].differingPixels);
    CHECK(seen_dB(project.compiled, sweep) < before_dB - 3.0);
}

TEST_CASE("received: an LED current written is not as intended, whatever the light") {
    const Prepared project = sample({.rig = "emulated"});
    const Rig& rig = project.compiled.document.rig;
    ReceivedSweep sweep = asSent(project.compiled.program, rig);
    sweep.received.ledCurrentWrites = 1;
    CHECK_FALSE(asIntended(outcomeOf(sweep, project.compiled.program, rig)));
    CHECK(verdict(outcomeOf(sweep, project.compiled.program, rig)).find("LED CURRENTS") != std::string::npos);
}

TEST_CASE("received: a show has ended safely when all pixels are full all the time and both lenses rest") {
    ReceivedSweep sweep;
    sweep.received.sweep = 16.7_ms;
    sweep.received.exposures = {{0.0_s, 16.7_ms, 8, 7, true}};
    sweep.light = {{0, {4, 2}, std::vector<std::uint8_t>(8, 255)}};
    sweep.received.left = sweep.received.right = {0.55_D, 0.5_D};
    CHECK(endedAs(sweep, 0.5_D).steadyWhite);
    CHECK(endedAs(sweep, 0.5_D).atRest);
    CHECK(endedAs(sweep, 0.5_D).light == doctest::Approx(1.0));

    auto dark = sweep;
    dark.light[0].light[3] = 254;
    CHECK_FALSE(endedAs(dark, 0.5_D).steadyWhite);
    auto gap = sweep;
    gap.received.exposures[0].length = 16.0_ms;
    CHECK_FALSE(endedAs(gap, 0.5_D).steadyWhite);
    auto red = sweep;
    red.received.exposures[0].colours = 1;
    CHECK_FALSE(endedAs(red, 0.5_D).steadyWhite);
    auto sweeping = sweep;
    sweeping.received.right.push_back(2.0_D);
    CHECK_FALSE(endedAs(sweeping, 0.5_D).atRest);
    CHECK(endedAs(sweeping, 0.5_D).farthest == 1.5_D);
    sweeping.received.right.clear();
    CHECK_FALSE(endedAs(sweeping, 0.5_D).atRest);
}

TEST_CASE("received: nothing received is refused in words") {
    const Prepared project = sample({.rig = "emulated"});
    const auto none = receivedShow(project.compiled, {}, Eye::left);
    REQUIRE_FALSE(none);
    CHECK(none.error().fault == Fault::device);
    auto other = asSent(project.compiled.program, project.compiled.document.rig);
    other.light[0].light.pop_back();
    CHECK_FALSE(receivedShow(project.compiled, other, Eye::left));
    CHECK(outcomeOf(other, project.compiled.program, project.compiled.document.rig).light.differingPixels > 0);
}
