// Fading from one look to another: light goes over evenly, at seams too, and incremental compiles are the same.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/compile/fade.h"
#include "core/plan/fade.h"
#include "tests/core/compile/received.h"

namespace {

using namespace ilf;

constexpr Size kPicture{320, 210};

/// Something blurred and something sharp besides, so that the sweep stays the same from end to end.
Document desk(Look look, Blending blending) {
    Document document = flatDocument(kPicture, Look::focus, 0.5_m);
    document.rig.projector = {256, 168};
    document.seam.blending = blending;
    document.regions = {
        regionOf("tool", look, 0.5_m, rasterised(Ellipse{{60, 30}, {190, 150}}, kPicture)),
        regionOf("label", Look::neutral, 0.52_m, rasterised(Rectangle{{20, 100}, {110, 190}}, kPicture)),
        regionOf("clutter", Look::blur, 0.5_m, rasterised(Ellipse{{160, 60}, {300, 200}}, kPicture)),
    };
    return document;
}

Document faded(Document document, std::size_t region, Look to, double share) {
    Region changed = *document.regions[region];
    changed.fade = LookFade{to, share};
    document.regions[region] = Box(changed);
    return document;
}

int farthest(const LightImage& a, const LightImage& b) {
    int most = 0;
    for (int y = 0; y < a.size().height; ++y)
        for (int x = 0; x < a.size().width; ++x)
            most = std::max(most, std::abs(a.at(x, y) - b.at(x, y)));
    return most;
}

int farthest(const Program& a, const Program& b) {
    if (a.images.size() != b.images.size() || a.imageOfSlot != b.imageOfSlot || a.waveform != b.waveform) return 255;
    int most = 0;
    for (std::size_t i = 0; i < a.images.size(); ++i)
        most = std::max(most, farthest(a.images[i], b.images[i]));
    return most;
}

/// True if no pixel goes up where it went down before, or the other way round.
bool oneWay(const std::vector<Compiled>& steps) {
    const Program &first = steps.front().program, &last = steps.back().program;
    for (std::size_t i = 0; i < first.images.size(); ++i) {
        for (int y = 0; y < first.projector.height; ++y) {
            for (int x = 0; x < first.projector.width; ++x) {
                const bool rises = last.images[i].at(x, y) > first.images[i].at(x, y);
                for (std::size_t k = 1; k < steps.size(); ++k) {
                    const int change = steps[k].program.images[i].at(x, y) - steps[k - 1].program.images[i].at(x, y);
                    if (rises ? change < 0 : change > 0) return false;
                }
            }
        }
    }
    return true;
}

}  // namespace

TEST_CASE("fade: the light of every pixel and slot goes one way, and in no step by more than that step's share") {
    constexpr int kSteps = 24;
    const auto blendings = {Blending::closedForm, Blending::linearPerceived, Blending::linearObject, Blending::none};
    const auto looks = {Look::focus, Look::blur, Look::neutral};
    for (const Blending blending : blendings) {
        for (const Look from : looks) {
            for (const Look to : looks) {
                if (from == to) continue;
                const Document document = desk(from, blending);
                std::vector<Compiled> steps;
                for (int i = 1; i < kSteps; ++i) {
                    const Document at = faded(document, 0, to, static_cast<double>(i) / kSteps);
                    const auto planned = plan(planInput(at));
                    REQUIRE(planned);
                    steps.push_back(compile(at, *planned, steps.empty() ? nullptr : &steps.back()).value());
                }
                CHECK(oneWay(steps));
                for (std::size_t i = 1; i < steps.size(); ++i)
                    CHECK(farthest(steps[i].program, steps[i - 1].program) <= 255 / kSteps + 2);
                // Its ends are the two looks, in the same sweep: nothing jumps where a fade begins or ends either.
                Document other = document;
                Region changed = *other.regions[0];
                changed.look = to;
                other.regions[0] = Box(changed);
                CHECK(farthest(compiledFrom(document).program, steps.front().program) <= 255 / kSteps + 2);
                CHECK(farthest(compiledFrom(other).program, steps.back().program) <= 255 / kSteps + 2);
            }
        }
    }
}

TEST_CASE("fade: an incremental compile is the compile from nothing, tiles that nothing reaches are shared") {
    const Document document = desk(Look::focus, Blending::closedForm);
    const Document a = faded(document, 0, Look::blur, 0.3), b = faded(document, 0, Look::blur, 0.4);
    const Plan planned = plan(planInput(a)).value();
    CHECK(plan(planInput(b)).value() == planned);  // while it fades, nothing of the plan changes
    const Compiled before = compile(a, planned).value();
    const Compiled next = compile(b, planned, &before).value();
    CHECK(next.program == compile(b, planned).value().program);
    CHECK(next.counters.computed == 0);  // no mask has changed
    CHECK(next.program.images[0].tile(3, 2).same(before.program.images[0].tile(3, 2)));
    const Compiled after = compiledFrom(document);
    CHECK(compile(document, after.plan, &next).value().program == after.program);
}

TEST_CASE("fade: several at once each have their own share") {
    Document document = desk(Look::focus, Blending::none);
    document = faded(faded(document, 0, Look::blur, 0.25), 2, Look::focus, 0.75);
    const auto parts = fadeParts(document);
    REQUIRE(parts.size() == 3);
    for (const std::size_t region : {std::size_t{0}, std::size_t{2}}) {
        double share = 0.0;
        for (const FadePart& part : parts)
            share += ilf::faded(*part.document.regions[region]) ? part.share : 0.0;
        CHECK(share == doctest::Approx(document.regions[region]->fade->share));
    }
    // Far from borders, half way between: 0.25 of the tool's light has left the focus level.
    const Plan planned = plan(planInput(document)).value();
    const Compiled compiled = compile(document, planned).value();
    REQUIRE(planned.levels.front().kind == LevelKind::focus);
    const auto at = pixelMap(document).toProjector({100, 60});
    CHECK(compiled.program.images[0].at(static_cast<int>(at.x), static_cast<int>(at.y)) ==
          doctest::Approx(0.75 * 255).epsilon(0.01));
}

TEST_CASE("fade: the plan has both looks meanwhile, and only the other one in the end") {
    const Document document = desk(Look::focus, Blending::closedForm);
    const auto ids = [](const Document& d) {
        std::string all;
        for (const PlanObject& object : planInput(d).objects)
            all += object.id + (object.look == Look::blur ? "! " : " ");
        return all;
    };
    CHECK(ids(faded(document, 0, Look::blur, 0.0)) == "tool label clutter! background ");
    CHECK(ids(faded(document, 0, Look::blur, 0.5)) == "tool tool~faded! label clutter! background ");
    CHECK(ids(faded(document, 0, Look::blur, 1.0)) == "tool~faded! label clutter! background ");
    const Document end = faded(document, 0, Look::blur, 1.0);
    Document blurred = document;
    Region changed = *document.regions[0];
    changed.look = Look::blur;
    blurred.regions[0] = Box(changed);
    CHECK(compiledFrom(end).program == compiledFrom(blurred).program);
}
