#include <doctest/doctest.h>

#include <filesystem>
#include <string>

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
