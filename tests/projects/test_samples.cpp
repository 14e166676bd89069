#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "core/perceived/seam_errors.h"
#include "core/plan/plan.h"
#include "projects/project_file.h"

using namespace ilf;

namespace {

Document sample(const std::string& name) {
    const auto opened =
        projects::openProject(std::filesystem::path(ILF_SOURCE_DIR) / "projects/samples" / (name + ".ilfd"));
    REQUIRE_MESSAGE(opened, (opened ? std::string() : opened.error().what));
    return opened->document;
}

const char* const kSamples[] = {"museum-guide", "study-desk", "tutorial-recording", "four-objects"};

}  // namespace

TEST_CASE("samples: each opens, and all its regions can be seen as they were asked for") {
    for (const std::string name : kSamples) {
        CAPTURE(name);
        Document document = sample(name);
        document.rig.waves = WaveMode::idealSine;  // a lens's own waves are the planner's test
        CHECK(document.scene.size() == Size{1280, 800});
        CHECK(document.regions.size() >= 4);
        for (const auto& region : document.regions)
            CHECK_FALSE(region->mask.blank());
        const auto planned = plan(planInput(document));
        REQUIRE_MESSAGE(planned, (planned ? std::string() : planned.error().what));
        CHECK(planned->sweeps());
        CHECK(planned->warnings.empty());
        for (const RegionPlan& region : planned->regions)
            CHECK_MESSAGE(region.problem.empty(), region.problem);
    }
}

TEST_CASE("samples: the true depth of a region agrees with the distance it was given") {
    for (const std::string name : kSamples) {
        const Document document = sample(name);
        const DepthMap& depth = *document.scene.depth;
        for (const auto& region : document.regions) {
            CAPTURE(name);
            CAPTURE(region->name);
            double off = 0.0, pixels = 0.0;
            for (int y = 0; y < document.scene.size().height; y += 3)
                for (int x = 0; x < document.scene.size().width; x += 3) {
                    bool above = false;  // another region's pixel, though this one's mask lies under it
                    for (const auto& other : document.regions) {
                        if (other->id == region->id) break;
                        above = above || other->mask.at(x, y) > 0;
                    }
                    if (region->mask.at(x, y) < 255 || above) continue;
                    const auto stated = distanceAt(document, *region, {x + 0.5, y + 0.5});
                    REQUIRE(stated);
                    // The four objects are typed as the paper has them; their toys are some centimetres deep.
                    double allowed = name == "four-objects" ? 0.12 * stated->si() : 0.003;
                    if (const auto* constant = std::get_if<ConstantDistance>(&region->distance))
                        allowed += constant->tolerance.si();
                    const double seen = static_cast<double>(depth.metres.at(x, y));
                    off += std::abs(seen - stated->si()) > allowed ? 1.0 : 0.0;
                    pixels += 1.0;
                }
            REQUIRE(pixels > 0.0);
            CHECK(off / pixels < 0.02);  // the tolerance leaves out one pixel in two hundred at either end
        }
    }
}

TEST_CASE("samples: the four objects are the paper's, with its sweep") {
    Document document = sample("four-objects");
    document.wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    const auto planned = plan(planInput(document));
    REQUIRE(planned);
    REQUIRE(planned->pS);
    CHECK(planned->pS->si() == doctest::Approx(4.07261643584172).epsilon(1e-12));
    CHECK(planned->waveform.high.si() == doctest::Approx(4.27261643584172).epsilon(1e-12));
    REQUIRE(planned->driver);
    CHECK(findRegion(document, *planned->driver)->name == "A");
}

TEST_CASE("samples: the scanned desk's depth is the study desk's true one, within what its scan says of itself") {
    const Document scanned = sample("scanned-desk"), drawn = sample("study-desk");
    REQUIRE(scanned.scene.measured);
    CHECK(scanned.scene.measured->provenance == "simulated");
    const DepthMap& depth = *scanned.scene.depth;
    REQUIRE(depth.sigma.size() == scanned.scene.size());
    const Image<float>& truth = drawn.scene.depth->metres;
    int near = 0, all = 0, holes = 0;
    for (int y = 0; y < depth.metres.height(); ++y) {
        for (int x = 0; x < depth.metres.width(); ++x) {
            const float metres = depth.metres.at(x, y);
            holes += metres == 0.0F ? 1 : 0;
            // The drawing has four pixels to one of the scan's: where they are one surface.
            const float a = truth.at(2 * x, 2 * y), b = truth.at(2 * x + 1, 2 * y + 1);
            if (metres == 0.0F || std::abs(a - b) > 0.004F) continue;
            ++all;
            near += std::abs(metres - 0.5F * (a + b)) <= 3.0F * depth.sigma.at(x, y) ? 1 : 0;
        }
    }
    MESSAGE(near << " of " << all << " depths within three sigma, " << holes << " holes");
    CHECK(all > 0.6 * 640 * 400);
    CHECK(near > 0.95 * all);
}

TEST_CASE("samples: what the scanned desk's depth and map leave open reaches P_min, P_s and the width of seams") {
    Document document = sample("scanned-desk");
    document.rig.waves = WaveMode::idealSine;
    const Registration& registration = *document.rig.registration;
    CHECK(registration.method == Registration::Method::scan);
    REQUIRE(registration.map.dense());
    CHECK(registration.map.dense()->projector() == document.rig.projector);
    CHECK(registration.rms_px > 0.0);
    CHECK(registration.rms_px < 0.5);
    CHECK(registration.worst_px >= registration.rms_px);
    REQUIRE(document.rig.calibration);

    const auto planned = plan(planInput(document));
    REQUIRE_MESSAGE(planned, (planned ? std::string() : planned.error().what));
    CHECK(planned->sweeps());
    for (const RegionPlan& region : planned->regions)
        CHECK_MESSAGE(region.problem.empty(), region.problem);
    Document certain = document;
    DepthMap exact = *document.scene.depth;
    exact.sigma = {};
    certain.scene.depth = Box(exact);
    const auto without = plan(planInput(certain));
    REQUIRE(without);
    for (std::size_t i = 0; i < planned->regions.size(); ++i) {
        if (planned->regions[i].look != Look::blur) continue;
        CHECK(planned->regions[i].sigma > 0.0_m);
        CHECK(*planned->regions[i].pMin > *without->regions[i].pMin);
    }
    CHECK(*planned->pS > *without->pS);

    // The feather that hides seams follows from the map's residual, in place of the assumed one.
    const SeamErrors known = knownErrors(document, *planned);
    CHECK(known.registration != SeamErrors{}.registration);
    const auto width = [](const SeamErrors& errors) {
        return hidingWidth(0.0_m, errors.registration, 0.1_mm, 1.0_m).width;
    };
    certain.rig.registration = registered(registration.map.nearest());
    CHECK(width(known) != width(knownErrors(certain, *without)));
    Registration worse = registration;
    worse.rms_px *= 2.0;
    document.rig.registration = Box(worse);
    CHECK(width(knownErrors(document, *planned)) > width(known));
}
