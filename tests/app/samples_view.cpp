// The samples seen by the engine and by brute force: the promise of the main job, >= 40 dB between them.
#include <doctest/doctest.h>

#include <string>

#include "app/headless/prepare.h"
#include "core/perceived/perceived.h"

using namespace ilf;

TEST_CASE("samples: the perceived view agrees with rays through the pupil to 40 dB") {
    for (const std::string name :
         {"museum-guide", "study-desk", "tutorial-recording", "four-objects", "scanned-desk"}) {
        INFO(name);
        const auto project = app::prepared(std::string(ILF_SOURCE_DIR) + "/projects/samples/" + name + ".ilfd");
        REQUIRE_MESSAGE(project.has_value(), (project ? std::string() : project.error().what));
        const Compiled& compiled = project->compiled;
        REQUIRE(compiled.plan.sweeps());
        for (const Eye eye : {Eye::left, Eye::right}) {
            ViewRequest request;
            request.eye = eye;
            request.scale = 0.25;
            const auto seen = perceived(compiled.document, compiled.plan, compiled.program, request);
            const auto rays = perceivedReference(compiled.document, compiled.plan, compiled.program, request, 128, 7);
            REQUIRE(seen);
            REQUIRE(rays);
            const double dB = psnr(*seen, *rays);
            MESSAGE(std::string(name), (eye == Eye::left ? std::string(" left: ") : std::string(" right: ")), dB,
                    " dB");
            CHECK(dB >= 40.0);
            // The comparison means something: the plain view is far from both.
            CHECK(psnr(plainView(compiled.document, request.scale), *rays) < dB - 6.0);
        }
    }
}
