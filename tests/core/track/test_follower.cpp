// What happens when the target is hidden, comes back, or seems to jump.
#include "core/track/follower.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/support/law.h"

namespace ilf {

namespace {

constexpr Second kFrame = 40.0_ms;
const Quad kPlace{{{100, 100}, {160, 100}, {160, 160}, {100, 160}}};

Motion shifted(double x, double y) { return {{1, 0, x, 0, 1, y, 0, 0, 1}}; }

/// Frames at 25 Hz.
struct Run {
    Follow follow;
    Follower follower;
    Second now = 1.0_s;

    Run() {
        follow.hold = 200.0_ms;
        follow.fade = 400.0_ms;
    }
    void frame(std::optional<Motion> motion, double confidence = 0.9) {
        now += kFrame;
        std::optional<Observation> seen;
        if (motion) seen = Observation{now, *motion, confidence};
        follower = followed(follower, follow, kPlace, seen, now);
    }
    void frames(int count, std::optional<Motion> motion, double confidence = 0.9) {
        for (int i = 0; i < count; ++i)
            frame(motion, confidence);
    }
};

}  // namespace

TEST_CASE("hidden, a region holds, fades, is lost; seen again it comes back") {
    Run run;
    run.frames(3, shifted(5, 0));
    CHECK(run.follower.state == FollowState::following);
    CHECK(run.follower.motion == shifted(5, 0));
    CHECK(run.follower.confidence == doctest::Approx(0.9));

    run.frames(5, std::nullopt);  // 200 ms
    CHECK(run.follower.state == FollowState::holding);
    CHECK(run.follower.fade == 0.0);
    CHECK(run.follower.motion == shifted(5, 0));
    CHECK(run.follower.confidence == 0.0);

    run.frames(5, std::nullopt);  // 200 ms of 400
    CHECK(run.follower.state == FollowState::fading);
    CHECK(run.follower.fade == doctest::Approx(0.5));
    run.frames(5, std::nullopt);
    CHECK(run.follower.state == FollowState::lost);
    CHECK(run.follower.fade == 1.0);
    run.frames(50, std::nullopt);
    CHECK(run.follower.state == FollowState::lost);

    run.frame(shifted(80, 0));  // one sighting is not believed yet
    CHECK(run.follower.state == FollowState::lost);
    run.frame(shifted(81, 0));
    CHECK(run.follower.state == FollowState::following);
    CHECK(run.follower.motion == shifted(81, 0));
    CHECK(run.follower.fade == doctest::Approx(0.8));  // 40 of 200 ms
    run.frames(4, shifted(81, 0));
    CHECK(run.follower.fade == doctest::Approx(0.0));
}

TEST_CASE("what was never seen ends in its safe look too") {
    Run run;
    run.frames(40, std::nullopt);
    CHECK(run.follower.state == FollowState::lost);
    CHECK(run.follower.motion == Motion{});
}

TEST_CASE("confidence has hysteresis: doubt keeps following but does not begin it") {
    Run run;
    run.frames(3, shifted(5, 0), 0.5);
    CHECK(run.follower.state == FollowState::holding);
    run.frames(2, shifted(5, 0), 0.7);
    CHECK(run.follower.state == FollowState::following);
    run.frames(10, shifted(6, 0), 0.4);
    CHECK(run.follower.state == FollowState::following);
    CHECK(run.follower.motion == shifted(6, 0));
    run.frame(shifted(7, 0), 0.2);
    CHECK(run.follower.state == FollowState::holding);
    CHECK(run.follower.motion == shifted(6, 0));
}

TEST_CASE("a jump is followed only when it is confirmed") {
    Run run;
    run.frames(3, shifted(5, 0));
    run.frame(shifted(305, 0));
    CHECK(run.follower.motion == shifted(5, 0));
    CHECK(run.follower.state == FollowState::holding);
    run.frame(shifted(5, 0));  // it was a mistake: one more look, then on as before
    run.frame(shifted(5, 0));
    CHECK(run.follower.state == FollowState::following);
    CHECK(run.follower.motion == shifted(5, 0));
    run.frames(2, shifted(305, 0));
    CHECK(run.follower.motion == shifted(305, 0));
    CHECK(run.follower.state == FollowState::following);
}

TEST_CASE("alternating jumps are never followed") {
    Run run;
    run.frames(3, shifted(5, 0));
    for (int i = 0; i < 30; ++i)
        run.frame(shifted(i % 2 == 0 ? 300 : -300, 0));
    CHECK(run.follower.motion == shifted(5, 0));
    CHECK(run.follower.state == FollowState::lost);
}

TEST_CASE("no fade time: the safe look at the end of the hold") {
    Run run;
    run.follow.fade = 0.0_s;
    run.frames(3, shifted(5, 0));
    run.frames(5, std::nullopt);
    CHECK(run.follower.fade == 0.0);
    run.frame(std::nullopt);
    CHECK(run.follower.fade == 1.0);
    CHECK(run.follower.state == FollowState::lost);
}

TEST_CASE("whatever comes, the fade never jumps and nothing doubtful moves a region") {
    law("steady", [] {
        Run run;
        const int frames = *rc::gen::inRange(1, 60);
        for (int i = 0; i < frames; ++i) {
            const Follower before = run.follower;
            const double confidence = *rc::gen::inRange(0, 101) / 100.0;
            const bool seen = *rc::gen::arbitrary<bool>();
            const Motion motion = shifted(*rc::gen::inRange(-200, 200), 0);
            run.now = run.now + Second::fromSi(*rc::gen::inRange(-20, 200) / 1000.0);
            const Second from = before.since.value_or(run.now + kFrame);
            run.frame(seen ? std::optional(motion) : std::nullopt, confidence);
            const double step = std::max(0.0, (run.now - from).si());
            RC_ASSERT(std::abs(run.follower.fade - before.fade) <= step / 0.2 + 1e-12);
            RC_ASSERT(run.follower.fade >= 0.0);
            RC_ASSERT(run.follower.fade <= 1.0);
            if (!seen || confidence < 0.3) RC_ASSERT(run.follower.motion == before.motion);
            if (run.follower.state == FollowState::following) RC_ASSERT(run.follower.motion == motion);
        }
    });
}

}  // namespace ilf
