// Projector, display and lenses that do what they are told, write it down, and fail when asked to.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "devices/rig/lightcrafter_stage.h"
#include "devices/rig/memory_video_output.h"
#include "tests/devices/programs.h"

namespace ilf::test {

/// What the room sees, and every call. Survives the devices' objects.
struct ScriptedRoom {
    /// Asked before each call of a device, by its name ("video: white", "board: start", "lens: play").
    std::function<bool(const std::string&)> failsAt;
    bool failsAfterEffect = false;  ///< the order got through and its answer is lost
    bool boardGone = false, lensGone = false;
    bool locks = true;
    std::optional<double> temperature_C = 30.0;
    std::optional<Error> boardRefusal;  ///< why it cannot be opened
    Second phaseError, jitter;
    std::int64_t missing = 0;
    std::vector<std::string> troubles;

    std::chrono::nanoseconds now{std::chrono::seconds(10)};
    std::vector<std::string> log;
    std::vector<std::string> violations;  ///< of the promises of light and lens
    bool patterns = false;                ///< else plain video, or the board's own white
    bool ownWhite = false;
    bool seesVideo = true;  ///< the board does, while its cable is in
    bool whiteShown = false, frameShown = false;
    bool whiteFailed = false, plainFailed = false;  ///< the last of each
    std::optional<Waveform> wave;                   ///< none: the lens rests

    bool slotted() const { return patterns && frameShown && !whiteShown; }
    /// Steady white everywhere, as far as anybody can see.
    bool lit() const { return ownWhite || (whiteShown && (patterns || seesVideo)); }
    bool called(const std::string& call) {
        log.push_back(call);
        return failsAt && failsAt(call);
    }
    void slottedNever(const std::string& at) {
        const bool unreachable = whiteFailed && plainFailed;
        if (slotted() && !unreachable) violations.push_back("slotted light at " + at);
    }
    void judged(const std::string& at) {
        if (!wave) slottedNever(at + ", lens at rest");
    }
    devices::Clock clock() {
        return {[this] { return now; }, [this](std::chrono::nanoseconds time) { now += time; }};
    }
};

inline tl::unexpected<Error> scriptedFailure(const std::string& call) {
    return fail(Fault::device, "It failed (" + call + ").");
}

class ScriptedVideo : public devices::MemoryVideoOutput {
public:
    explicit ScriptedVideo(ScriptedRoom& room)
        : MemoryVideoOutput({{8, 4}, 60.0_Hz}, room.clock(), {"HDMI-2", "TI", "LCR4500", "7"}), room_(room) {}

    Result<devices::ScannedOut> show(const devices::VideoFrame& frame) override {
        const bool white = frame == devices::uniformFrame(frame.size(), 255);
        const std::string call = white ? "video: white" : "video: frame";
        const bool failing = room_.called(call);
        auto out = failing && !room_.failsAfterEffect ? scriptedFailure(call) : MemoryVideoOutput::show(frame);
        if (white) room_.whiteFailed = failing || !out;
        if (out) {
            room_.frameShown = true;
            room_.whiteShown = white;
        }
        room_.judged(call);
        return failing ? scriptedFailure(call) : out;
    }
    Result<devices::VideoMode> mode() override {
        if (room_.failsAt && room_.failsAt("video: mode")) return scriptedFailure("video: mode");
        return MemoryVideoOutput::mode();
    }

private:
    ScriptedRoom& room_;
};

class ScriptedBoard : public devices::StageProjector {
public:
    explicit ScriptedBoard(ScriptedRoom& room) : room_(room) {}

    Result<void> start(const devices::dlpc350::PatternSequence& sequence) override {
        return told("board: start " + std::to_string(sequence.entries.size()), [&] {
            room_.slottedNever("a change of the slot rate");
            room_.patterns = true;
            room_.ownWhite = false;
        });
    }
    Result<void> showVideo(devices::Waiting) override {
        auto done = told("board: video", [&] { room_.patterns = room_.ownWhite = false; });
        room_.plainFailed = !done;
        return done;
    }
    Result<void> showOwnWhite(devices::Waiting) override {
        auto done = told("board: own white", [&] {
            room_.patterns = false;
            room_.ownWhite = true;
        });
        room_.plainFailed = !done;
        return done;
    }
    Result<bool> seesVideo() override {
        auto asked = told("board: sees video", [] {});
        room_.plainFailed = !asked;
        if (!asked) return tl::unexpected(asked.error());
        return room_.seesVideo;
    }
    Result<devices::dlpc350::Watched> watch() override {
        auto asked = told("board: watch", [] {});
        if (!asked) return tl::unexpected(asked.error());
        devices::dlpc350::Watched seen;
        seen.display = room_.patterns ? devices::dlpc350::Display::pattern : devices::dlpc350::Display::video;
        seen.run = room_.patterns ? devices::dlpc350::PatternRun::running : devices::dlpc350::PatternRun::stopped;
        if (room_.ownWhite) seen.source = devices::dlpc350::Source::testPattern;
        seen.seesVideo = room_.patterns || room_.ownWhite || room_.seesVideo;
        seen.troubles = room_.troubles;
        seen.playing = room_.patterns && seen.troubles.empty();
        return seen;
    }
    std::string name() const override { return "board"; }

private:
    template <class Effect>
    Result<void> told(const std::string& call, Effect effect) {
        const bool failing = room_.called(call);
        callsWhileGone_ += room_.boardGone ? 1 : 0;
        if (callsWhileGone_ > 2 || (callsWhileGone_ == 2 && call != "board: video" && call != "board: own white"))
            room_.violations.push_back(call + " on a board that is gone");
        if (room_.boardGone || (failing && !room_.failsAfterEffect)) return scriptedFailure(call);
        effect();
        room_.judged(call);
        if (failing) return scriptedFailure(call);
        return {};
    }

    ScriptedRoom& room_;
    int callsWhileGone_ = 0;
};

class ScriptedLens : public devices::StageLens {
public:
    ScriptedLens(ScriptedRoom& room, Dioptre rest) : room_(room), rest_(rest) {}

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
        if (!room_.patterns) return fail(Fault::device, "The projector's trigger is lost.");
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

private:
    template <class Effect>
    Result<void> told(const std::string& call, Effect effect) {
        const bool failing = room_.called(call);
        callsWhileGone_ += room_.lensGone ? 1 : 0;
        if (callsWhileGone_ > 2 || (callsWhileGone_ == 2 && call != "lens: safe"))
            room_.violations.push_back(call + " on lenses that are gone");
        if (room_.lensGone || (failing && !room_.failsAfterEffect)) return scriptedFailure(call);
        effect();
        room_.judged(call);
        if (failing) return scriptedFailure(call);
        return {};
    }

    ScriptedRoom& room_;
    Dioptre rest_;
    int callsWhileGone_ = 0, follows_ = 0;
};

/// A stage in a room, both with a clock that jumps.
struct ScriptedRig {
    ScriptedRoom room;
    std::shared_ptr<ScriptedVideo> video = std::make_shared<ScriptedVideo>(room);
    devices::LightCrafterStage stage{made()};

    devices::LightCrafterRig made() {
        devices::LightCrafterRig rig;
        rig.openProjector = [this]() -> Result<std::unique_ptr<devices::StageProjector>> {
            if (room.boardGone) return fail(Fault::notFound, "There is no board.");
            if (room.boardRefusal) return tl::unexpected(*room.boardRefusal);
            return std::make_unique<ScriptedBoard>(room);
        };
        rig.openLens = [this](Dioptre rest) -> Result<std::unique_ptr<devices::StageLens>> {
            if (room.lensGone) return fail(Fault::notFound, "There are no lenses.");
            room.log.push_back("lens: opened at " + std::to_string(rest.si()).substr(0, 3));
            room.wave.reset();  // opening stops what ran
            return std::make_unique<ScriptedLens>(room, rest);
        };
        rig.video = video;
        rig.packed = [](const Program& program) -> Result<devices::PatternFrame> {
            const auto value = static_cast<std::uint8_t>(1 + contentHash(program) % 250);
            return devices::PatternFrame{
                devices::uniformFrame({8, 4}, value),
                devices::dlpc350::evenSequence(static_cast<int>(program.imageOfSlot.size()), 1, 694.0_us)};
        };
        rig.clock = room.clock();
        return rig;
    }

    Result<void> played(const Program& program) {
        return stage.load(program).and_then([&] { return stage.swap(); });
    }
    /// The calls since the last time, without those that only ask.
    std::vector<std::string> orders() {
        std::vector<std::string> told;
        for (const auto& call : room.log)
            if (call != "board: watch" && call != "board: sees video" && call != "lens: heartbeat" &&
                call != "lens: follow")
                told.push_back(call);
        room.log.clear();
        return told;
    }
};

}  // namespace ilf::test
