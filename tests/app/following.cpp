// What is on show goes on following while edits wait for TAKE: the worker makes both programs of the same moves.
#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "app/studio/worker.h"
#include "core/document/edit.h"
#include "core/track/predict.h"
#include "tests/core/document/scenes.h"

using namespace ilf;
using namespace ilf::app;

namespace {

Document followingDocument() {
    Document document = twoRegions();
    document = *edited(document, FillShape{"a", Rectangle{{40, 50}, {120, 130}}});
    document = *edited(document, FillShape{"b", Rectangle{{200, 40}, {280, 120}}});
    return *edited(document, SetFollow{"a", Follow{StreamTarget{}}});
}

Quad squareAt(double x, double y) { return {{{x, y}, {x + 40, y}, {x + 40, y + 40}, {x, y + 40}}}; }

std::vector<RegionMove> movedTo(double x) { return {{"a", squareAt(60, 70), squareAt(x, 70), {}, 0.0}}; }

Done answered(Worker& worker, Job job) {
    const auto serial = job.serial;
    worker.post(std::move(job));
    for (int i = 0; i < 2000; ++i) {
        if (auto done = worker.tryTake(); done && done->serial == serial) return *std::move(done);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL("the worker does not answer");
    return {};
}

Program alone(const Document& painted, const std::vector<RegionMove>& moves, const Plan& plan) {
    const auto made = compile(moved(painted, motionsAt(moves, meanLight(plan))), plan);
    REQUIRE(made);
    return made->program;
}

}  // namespace

TEST_CASE("following behind: what is on show moves along while an edit waits, and shows nothing of the edit") {
    Worker worker(devices::kUsualLens);
    const Document onShow = followingDocument();
    const Document waiting = *edited(onShow, FillShape{"b", Rectangle{{150, 150}, {300, 190}}});
    std::uint64_t serial = 0;
    std::vector<std::uint64_t> hashes;
    for (const double x : {60.0, 90.0, 130.0}) {
        Job job;
        job.serial = ++serial;
        job.document = waiting;
        job.onShow = onShow;
        job.moves = movedTo(x);
        const Done done = answered(worker, std::move(job));
        REQUIRE(done.compiled);
        REQUIRE(done.onShow);
        CHECK(done.onShow->document.regions[1]->mask == onShow.regions[1]->mask);
        CHECK(done.onShow->document.regions[0]->mask ==
              moved(onShow.regions[0]->mask, motionAt(movedTo(x)[0], 0.0_s).motion));
        CHECK(done.onShow->program == alone(onShow, movedTo(x), done.onShow->plan));
        CHECK_FALSE(done.onShow->program == done.compiled->program);
        hashes.push_back(done.onShowHash);
    }
    CHECK(hashes[0] != hashes[1]);
    CHECK(hashes[1] != hashes[2]);
}

TEST_CASE("following behind: an edit that cannot be planned stops nothing that is on show") {
    Worker worker(devices::kUsualLens);
    const Document onShow = followingDocument();
    Document impossible = onShow;
    Rig rig;
    rig.projector = {};
    impossible.rig = rig;
    Job job;
    job.serial = 1;
    job.document = impossible;
    job.onShow = onShow;
    job.moves = movedTo(90);
    const Done done = answered(worker, std::move(job));
    CHECK(done.refusal);
    REQUIRE(done.onShow);
    CHECK(done.onShow->program == alone(onShow, movedTo(90), done.onShow->plan));
}
