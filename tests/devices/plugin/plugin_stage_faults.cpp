#include <doctest/doctest.h>

#include "tests/devices/plugin/loopback_rig.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;
using test::kSmall;
using test::LoopbackRig;
using Calls = std::vector<std::string>;

Program program(std::uint32_t seed, Dioptre high = 2.27_D) { return test::program(seed, high, kSmall); }

Program slower(std::uint32_t seed) {
    auto slow = program(seed);
    slow.slotRate = 480.0_Hz;
    slow.imageOfSlot.resize(8);
    return slow;
}

Result<void> evening(LoopbackRig& rig) {
    return test::eveningOf(rig, {program(1), program(4), program(2, 4.27_D), slower(3)});
}

}  // namespace

TEST_CASE("plugin stage: whichever call fails, at whichever time, the scene is lit and the lens rests") {
    test::eachCallFails<LoopbackRig>(evening, program(5), 100);
}

TEST_CASE("plugin stage: what fails for good from any call on is left, and the other is made safe") {
    for (const std::string gone : {"projector", "lens"}) {
        bool untouched = false;
        for (int failing = 1; !untouched; ++failing) {
            REQUIRE(failing < 500);
            CAPTURE(gone);
            CAPTURE(failing);
            LoopbackRig rig;
            int calls = 0;
            bool failed = false;
            rig.failsAt = [&](const std::string& call) {
                if (!call.starts_with(gone) || ++calls < failing) return false;
                failed = true;
                rig.projectorGone = gone == "projector";
                rig.lensGone = gone == "lens";
                return true;
            };
            (void)evening(rig);
            untouched = !failed;
            if (!untouched) {
                rig.stage.safeLight();
                for (int beat = 0; beat < 30; ++beat) {
                    rig.loopback.pass(100ms);
                    CHECK_FALSE(rig.stage.heartbeat());
                    rig.stage.safeLight();
                }
                CHECK_FALSE(rig.slotted());
                if (gone != "lens") CHECK_FALSE(rig.wave);
                CHECK_FALSE(rig.stage.report().well);
                CHECK(rig.violations == Calls{});
            }
            rig.failsAt = nullptr;
        }
    }
}

TEST_CASE("plugin stage: whatever is asked and whatever fails, slots never meet a resting lens or a rate's change") {
    law("light and lens", [] {
        const auto failRate = *rc::gen::element(0, 5, 20);
        const auto afterEffect = *rc::gen::arbitrary<bool>();
        const auto chances = *rc::gen::container<std::vector<int>>(64, rc::gen::inRange(0, 100));
        const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 13));
        LoopbackRig rig;
        rig.failsAfterEffect = afterEffect;
        rig.failsAt = [chances, failRate, asked = std::size_t{0}](const std::string&) mutable {
            return chances[asked++ % chances.size()] < failRate;
        };
        bool faulted = false;
        for (const int step : steps) {
            switch (step) {
            case 0:
            case 1:
            case 2:
            case 3: {
                const auto one = step < 2   ? program(static_cast<std::uint32_t>(step) + 1)
                                 : step < 3 ? program(2, 4.0_D)
                                            : slower(3);
                faulted = !rig.played(one);
                break;
            }
            case 4:
                rig.stage.safeLight();
                faulted = true;  // as a fault: slots need a new swap
                break;
            case 5:
                rig.projectorGone = !rig.projectorGone;
                break;
            case 6:
                rig.phaseError = rig.phaseError > 0.0_s ? 0.0_s : 300.0_us;
                break;
            case 7:
                rig.loopback.faults("drop=500");
                break;
            case 8:
                rig.loopback.faults("");
                break;
            default:
                rig.loopback.pass(std::chrono::milliseconds(step * 300));
                if (!rig.stage.heartbeat()) {
                    rig.stage.safeLight();
                    faulted = true;
                }
            }
            rig.judged("the end of a step");
            RC_ASSERT(rig.violations.empty());
            RC_ASSERT(!faulted || !rig.slotted() || rig.whiteFailed);
        }
    });
}

}  // namespace ilf::devices
