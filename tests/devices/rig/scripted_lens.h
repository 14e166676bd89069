// Lenses that do what they are told, write it down, and fail when asked to; and evenings in which each call fails once.
#pragma once

#include <doctest/doctest.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "devices/rig/stage_lens.h"
#include "devices/stage.h"
#include "tests/devices/programs.h"

namespace ilf::test {

/// What the devices of a room share, and what a test may turn. Survives the devices' objects.
struct LensRoom {
    /// Asked before each call of a device, by its name ("video: white", "lens: play").
    std::function<bool(const std::string&)> failsAt;
    bool failsAfterEffect = false;  ///< the order got through and its answer is lost
    bool lensGone = false;
    bool locks = true;
    std::optional<double> temperature_C = 30.0;
    Second phaseError, jitter;
    std::int64_t missing = 0;
    std::vector<std::string> log;
    std::vector<std::string> violations;  ///< of the promises of light and lens
    std::optional<Waveform> wave;         ///< none: the lens rests

    virtual ~LensRoom() = default;
    /// Slots other than white are lit.
    virtual bool slotted() const = 0;
    virtual bool triggersCome() const = 0;
    /// What the room sees now must be what is promised.
    virtual void judged(const std::string& at) = 0;
    virtual void slottedNever(const std::string& at) = 0;

    bool called(const std::string& call) {
        log.push_back(call);
        return failsAt && failsAt(call);
    }
};

inline tl::unexpected<Error> scriptedFailure(const std::string& call) {
    return fail(Fault::device, "It failed (" + call + ").");
}

/// A device that is gone may be asked once more and told to be safe; nothing else.
class GoneDevice {
public:
    explicit GoneDevice(std::string what) : what_(std::move(what)) {}
    void called(LensRoom& room, bool gone, const std::string& call, bool isSafe) {
        calls_ += gone ? 1 : 0;
        if (calls_ > 2 || (calls_ == 2 && !isSafe)) room.violations.push_back(call + " on " + what_ + " gone");
    }

private:
    std::string what_;
    int calls_ = 0;
};

class ScriptedLens : public devices::StageLens {
public:
    ScriptedLens(LensRoom& room, Dioptre rest) : room_(room), rest_(rest) {}

    Result<Second> play(const Waveform& wave, Second) override {
        auto done = told("lens: play", [&] {
            room_.slottedNever("a change of the wave");
            room_.wave = wave;
            follows_ = 0;
        });
        if (!done) return tl::unexpected(done.error());
        return 60.0_ms;
    }
    Result<devices::PhaseState> follow() override {
        auto done = told("lens: follow", [] {});
        if (!done) return tl::unexpected(done.error());
        if (!room_.triggersCome()) return fail(Fault::device, "The projector's trigger is lost.");
        return devices::PhaseState{room_.locks && ++follows_ > 3, room_.phaseError, 12.0, room_.missing, room_.jitter};
    }
    Result<devices::LensCondition> heartbeat() override {
        auto done = told("lens: heartbeat", [] {});
        if (!done) return tl::unexpected(done.error());
        return devices::LensCondition{room_.wave.has_value(), room_.temperature_C};
    }
    Result<void> safe() override {
        return told("lens: safe", [&] { room_.wave.reset(); });
    }
    Dioptre rest() const override { return rest_; }
    std::string name() const override { return "scripted lenses"; }

    /// As a stage opens them.
    static Result<std::unique_ptr<StageLens>> opened(LensRoom& room, Dioptre rest) {
        if (room.lensGone) return fail(Fault::notFound, "There are no lenses.");
        room.log.push_back("lens: opened at " + std::to_string(rest.si()).substr(0, 3));
        room.wave.reset();  // opening stops what ran
        return std::make_unique<ScriptedLens>(room, rest);
    }

private:
    template <class Effect>
    Result<void> told(const std::string& call, Effect effect) {
        const bool failing = room_.called(call);
        gone_.called(room_, room_.lensGone, call, call == "lens: safe");
        if (room_.lensGone || (failing && !room_.failsAfterEffect)) return scriptedFailure(call);
        effect();
        room_.judged(call);
        if (failing) return scriptedFailure(call);
        return {};
    }

    LensRoom& room_;
    Dioptre rest_;
    GoneDevice gone_{"lenses that are"};
    int follows_ = 0;
};

/// A show from its start to its end; stops at the first failure, as a player does. A Rig has a room, a stage, `played`
/// and `pass`, which lets time go by.
template <class Rig>
Result<void> eveningOf(Rig& rig, const std::vector<Program>& programs) {
    using namespace std::chrono_literals;
    for (const auto& program : programs) {
        if (const auto shown = rig.played(program); !shown) return shown;
        rig.pass(3s);
        if (const auto well = rig.stage.heartbeat(); !well) return well;
    }
    rig.stage.safeLight();
    return rig.stage.heartbeat();
}

/// `evening` with its n-th call failing, before or after its effect, for every n until one has fewer calls, which must
/// be more than `least`. Whatever was lost is told again within seconds, nothing but `next` lights slots, and the room
/// is lit with the lens at rest. `mended` gives back what the evening itself took away, whose words are then read too.
template <class Rig>
void eachCallFails(const std::function<Result<void>(Rig&)>& evening, const Program& next, int least,
                   const std::function<void(Rig&)>& mended = {}) {
    using namespace std::chrono_literals;
    for (const bool afterEffect : {false, true})
        for (int failing = 1;; ++failing) {
            REQUIRE(failing < 500);
            CAPTURE(failing);
            CAPTURE(afterEffect);
            int calls = 0;  // before the rig, whose stage makes safe light when it goes
            std::string failed;
            Rig rig;
            LensRoom& room = rig.lensRoom();
            room.failsAfterEffect = afterEffect;
            room.failsAt = [&](const std::string& call) {
                if (++calls != failing) return false;
                failed = call;
                return true;
            };
            const auto done = evening(rig);
            if (calls < failing) {
                CHECK(done);
                CHECK(failing > least);
                break;
            }
            CAPTURE(failed);
            // A plugin's words do not say that it is the projector.
            const std::string named = failed.starts_with("projector: ") ? failed.substr(11) : failed;
            if (!done && !mended) CHECK(done.error().what.find("It failed (" + named + ").") != std::string::npos);
            if (mended) mended(rig);
            for (int beat = 0; beat < 30; ++beat) {
                rig.pass(100ms);
                if (!rig.stage.heartbeat()) rig.stage.safeLight();
                if (!done) CHECK_FALSE(room.slotted());
            }
            CHECK(rig.lit());
            CHECK_FALSE(room.slotted());
            CHECK_FALSE(room.wave);
            CHECK(rig.stage.report().well);
            CHECK(room.violations == std::vector<std::string>{});
            CHECK(rig.played(next));
            CHECK(room.slotted());
        }
}

}  // namespace ilf::test
