// What tests of an emulated rig's faults share: a show, a fault, and how light and lenses are seen to end.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <thread>

#include "core/lens/waveform.h"
#include "tests/devices/emulated_rig/running_rig.h"
#include "tests/devices/endtoend/bench.h"

namespace ilf::devices::test {

/// How often something is tried where a machine that is busy with other things loses a show by itself.
inline constexpr int kTries = 3;

inline Program shownOnRig(std::uint32_t seed = 80) {
    Program program = sweepOf(6, seed);
    program.waveform = idealSine(0.5_D, -2.0_D, 3.0_D, 60.0_Hz, 0.0_s);
    program.waveform.unit = DriveUnit::ampere;
    program.waveform.drive.c = {0.0, 0.1};
    program.projectorDelay = {};
    return program;
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Generous: it is what is waited for that is the verdict, not how long a busy machine takes.
template <class Holds>
bool soon(Holds holds) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < until) {
        if (holds()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
}

/// Every picture of the newest sweep is full light.
inline bool whiteInEverySlot(DeviceClient& client) {
    Received received;
    const auto sweep = receivedSweep(client, received);
    return !sweep.empty() && std::ranges::all_of(sweep, [](const SlotLight& slot) {
        return std::ranges::all_of(slot.light.pixels(), [](std::uint8_t value) { return value == 255; });
    });
}

/// One picture for all of a sweep, full light, as video.
inline bool steadyWhite(DeviceClient& client) {
    Received received;
    const auto sweep = receivedSweep(client, received);
    return !received.patterns && sweep.size() == 1 && received.exposures[0].video && whiteInEverySlot(client);
}

/// Both lenses stand still.
inline bool still(const Received& received) {
    return std::ranges::all_of(std::array{&received.left, &received.right}, [](const auto* powers) {
        const auto [low, high] = std::ranges::minmax(*powers);
        return high - low < 0.02_D;
    });
}

/// At 0 D, where these rigs rest: without current.
inline bool atRest(DeviceClient& client) {
    const auto received = client.readReceived();
    return received && still(*received) && received->most_mA[0] < 1.0 && received->most_mA[1] < 1.0;
}

inline DeviceLine lineOf(const Stage& stage, const std::string& what) {
    for (const auto& line : stage.report().devices)
        if (line.what == what) return line;
    return {};
}

/// Loads and swaps, as often as a busy machine needs.
inline Result<void> played(Stage& stage, const Program& program) {
    for (int tries = 1;; ++tries) {
        auto swapped = stage.load(program).and_then([&] { return stage.swap(); });
        if (swapped || tries == kTries) return swapped;
        MESSAGE("taken again: ", swapped.error().what);
    }
}

/// What is read when something befalls a show. With other words than `words` something else befell it, as on a machine
/// that is busy, and it is tried again; what is read at last is told.
inline std::string readAt(RunningRig& rig, LightCrafterStage& stage, const RigMishap& mishap,
                          const std::string& words) {
    std::optional<std::string> read;
    std::chrono::duration<double> took{};
    for (int tries = 0; tries < kTries && !(read && contains(*read, words)); ++tries) {
        if (read) {
            MESSAGE("tried again: ", *read);
            rig.befalls(mishap.device, "none");
        }
        const auto shown = played(stage, shownOnRig());
        if (!shown) FAIL(shown.error().what);
        REQUIRE(rig.befalls(mishap.device, mishap.kind, mishap.after, mishap.times, mishap.amount));
        const auto begun = std::chrono::steady_clock::now();
        read = playedFor(stage, std::chrono::seconds(10)).value_or("nothing");
        took = std::chrono::steady_clock::now() - begun;
    }
    MESSAGE(mishap.device, ", ", mishap.kind, ", safe light and read after ", took.count(), " s: ", *read);
    return *read;
}

}  // namespace ilf::devices::test
