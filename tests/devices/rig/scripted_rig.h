// Projector, display and lenses that do what they are told, write it down, and fail when asked to.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/rig/lightcrafter_stage.h"
#include "devices/rig/memory_video_output.h"
#include "tests/devices/rig/scripted_lens.h"

namespace ilf::test {

/// What the room sees, and every call.
struct ScriptedRoom : LensRoom {
    bool boardGone = false;
    std::optional<Error> boardRefusal;  ///< why it cannot be opened
    std::vector<std::string> troubles;

    std::chrono::nanoseconds now{std::chrono::seconds(10)};
    bool patterns = false;  ///< else plain video, or the board's own white
    bool ownWhite = false;
    bool seesVideo = true;  ///< the board does, while its cable is in
    bool whiteShown = false, frameShown = false;
    bool whiteFailed = false, plainFailed = false;  ///< the last of each

    bool slotted() const override { return patterns && frameShown && !whiteShown; }
    bool triggersCome() const override { return patterns; }
    /// Steady white everywhere, as far as anybody can see.
    bool lit() const { return ownWhite || (whiteShown && (patterns || seesVideo)); }
    void slottedNever(const std::string& at) override {
        const bool unreachable = whiteFailed && plainFailed;
        if (slotted() && !unreachable) violations.push_back("slotted light at " + at);
    }
    void judged(const std::string& at) override {
        if (!wave) slottedNever(at + ", lens at rest");
    }
    devices::Clock clock() {
        return {[this] { return now; }, [this](std::chrono::nanoseconds time) { now += time; }};
    }
};

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
        gone_.called(room_, room_.boardGone, call, call == "board: video" || call == "board: own white");
        if (room_.boardGone || (failing && !room_.failsAfterEffect)) return scriptedFailure(call);
        effect();
        room_.judged(call);
        if (failing) return scriptedFailure(call);
        return {};
    }

    ScriptedRoom& room_;
    GoneDevice gone_{"a board that is"};
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
        rig.openLens = [this](Dioptre rest) { return ScriptedLens::opened(room, rest); };
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
    LensRoom& lensRoom() { return room; }
    bool lit() const { return room.lit(); }
    void pass(std::chrono::nanoseconds time) { room.now += time; }
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
