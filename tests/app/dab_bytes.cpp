// What a dab costs on its way from the studio to the output core, beside a whole program: bytes as they travel.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>

#include "app/headless/prepare.h"
#include "core/document/edit.h"
#include "devices/link/codec.h"
#include "devices/link/program_update.h"

using namespace ilf;

namespace {

constexpr double kDabDiameter_px = 40.0, kFeather_px = 8.0;

std::size_t bytes(const Program& program, const Program* base) {
    const auto hash = contentHash(program);
    const auto update = base != nullptr ? devices::difference(program, hash, base, contentHash(*base))
                                        : devices::difference(program, hash);
    return devices::encoded({1, update}).size();
}

/// The sample with a feather of 8 px across surfaces at the distance of `region`.
Document feathered(Document document, const Region& region) {
    const auto range = distanceRange(document, region);
    REQUIRE(range);
    document.seam.feather = kFeather_px / document.scene.scale.focalPixels * range->nearest;
    return document;
}

}  // namespace

TEST_CASE("dab: 40 px at a feather of 8 px sends at most 5 % of the bytes of the whole program, on either rig") {
    for (const std::string rig : {"simulated", "emulated"}) {
        auto project = app::prepared(std::string(ILF_SOURCE_DIR) + "/projects/samples/museum-guide.ilfd", {.rig = rig});
        if (!project) FAIL(project.error().what);
        Document document = project->compiled.document;
        const auto painted = std::ranges::find_if(document.regions, [](const Box<Region>& region) {
            return region->visible && region->look == Look::blur && !region->mask.blank();
        });
        REQUIRE(painted != document.regions.end());
        const RegionId id = (*painted)->id;
        document = feathered(document, **painted);
        const auto before = compile(document, project->compiled.plan);
        REQUIRE(before);
        const std::size_t whole = bytes(before->program, nullptr);

        std::mt19937 random(1);
        std::size_t most = 0, sum = 0, dabs = 0;
        for (int tried = 0; tried < 40; ++tried) {
            const Size size = document.scene.size();
            const Point<CameraFrame> at{double(random() % static_cast<unsigned>(size.width)),
                                        double(random() % static_cast<unsigned>(size.height))};
            const auto mode = tried % 2 == 0 ? PaintMode::add : PaintMode::erase;
            const auto after = edited(document, Paint{id, {{at, {0.5 * kDabDiameter_px, 0.8, 1.0}}}, mode});
            REQUIRE(after);
            const auto compiled = compile(*after, before->plan, &*before);
            REQUIRE(compiled);
            if (compiled->program == before->program) continue;  // painted where it was painted already
            ++dabs;
            const std::size_t cost = bytes(compiled->program, &before->program);
            most = std::max(most, cost);
            sum += cost;
        }
        REQUIRE(dabs > 10);
        const Size raster = before->program.projector;
        const double light = double(raster.width) * raster.height * double(before->program.images.size());
        MESSAGE(rig, " rig: ", before->program.images.size(), " images of ", light, " bytes in all, sent as ", whole,
                "; a dab ", sum / dabs, " on average (", 100.0 * double(sum) / double(dabs * whole), " %), at most ",
                most, " (", 100.0 * double(most) / double(whole), " %, ", 100.0 * double(most) / light, " % of all)");
        // Even tiles travel as one byte, so a program that is mostly even is small as it travels; these samples are.
        CHECK(double(most) <= 0.05 * double(whole));
    }
}
