// The main job on real pictures: paint, save, and run headless on a simulated core.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/open.h"
#include "core/document/edit.h"
#include "projects/pictures.h"
#include "projects/project_file.h"
#include "tests/support/run_program.h"
#include "tests/support/test_data.h"

using namespace ilf;
using nlohmann::json;

namespace {

/// A stroke of `dabs` dabs across the picture at `share` of its height.
Paint stroke(const Document& document, const RegionId& region, double share) {
    const Size size = document.scene.size();
    Paint paint{region, {}, PaintMode::add, false};
    constexpr int kDabs = 24;
    for (int i = 0; i < kDabs; ++i) {
        paint.dabs.push_back(
            {{size.width * (0.15 + 0.7 * i / kDabs), size.height * share}, Brush{0.08 * size.height, 0.8, 1.0}});
    }
    return paint;
}

Document after(Document document, const Edit& edit) {
    auto next = edited(std::move(document), edit);
    REQUIRE_MESSAGE(next.has_value(), (next ? std::string() : next.error().what));
    return *std::move(next);
}

/// Paints a sharp and a blurred region, saves, runs, and checks what the devices received.
void paintAndRun(app::OpenedFile opened, const Distance& sharp, const Distance& soft) {
    Document document = std::move(opened.document);
    struct Painted {
        const char* id;
        Look look;
        double share;
        const Distance& distance;
    };
    for (const auto& [id, look, share, distance] :
         {Painted{"sharp", Look::focus, 0.3, sharp}, Painted{"soft", Look::blur, 0.7, soft}}) {
        Region region;
        region.id = id;
        region.name = id;
        region.look = look;
        region.distance = distance;
        document = after(std::move(document), AddRegion{region, 0});
        document = after(document, stroke(document, id, share));
    }
    const TemporaryDirectory directory;
    const std::string project = directory / "real.ilfd";
    const auto saved = projects::saveProject(project, document, opened.extras);
    REQUIRE_MESSAGE(saved.has_value(), (saved ? std::string() : saved.error().what));

    const auto ran =
        runProgram(ILF_STUDIO_PATH, "run '" + project + "' --seconds 0.2 --report '" + (directory / "r.json") +
                                        "' --pictures '" + (directory / "out") + "' 2>&1");
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    std::ifstream file(directory / "r.json");
    const json report = json::parse(file);
    CHECK(report["played"]["light"] == "slotted");
    CHECK(report["plan"]["driving_region"] == "soft");
    REQUIRE(report["received"].size() == 16);
    for (const auto& slot : report["received"])
        CHECK(slot["differing_pixels"] == 0);

    // The wearer sees the blurred stroke softer than the plain picture, and the sharp one as it is.
    const auto plain = projects::readPicture(directory / "out/camera.png");
    const auto seen = projects::readPicture(directory / "out/perceived-left.png");
    REQUIRE(plain);
    REQUIRE(seen);
    const auto detail = [](const Picture& picture, double share) {
        const int y = static_cast<int>(picture.height() * share);
        double sum = 0.0;
        for (int x = picture.width() / 4; x < picture.width() * 3 / 4; ++x) {
            for (int dy = -4; dy <= 4; ++dy)
                sum += std::abs(picture.at(x, y + dy, 1) - picture.at(x - 1, y + dy, 1));
        }
        return sum;
    };
    CHECK(detail(seen->picture, 0.7) < 0.85 * detail(plain->picture, 0.7));
    CHECK(detail(seen->picture, 0.3) > 0.7 * detail(plain->picture, 0.3));
}

}  // namespace

TEST_CASE("real input: a text page is painted and played") {
    const auto path = testData("06_textures/opencv/imageTextN.png");
    if (!path) return;
    auto opened = app::openAny(path->string());
    REQUIRE_MESSAGE(opened.has_value(), (opened ? std::string() : opened.error().what));
    paintAndRun(*std::move(opened), ConstantDistance{0.5_m, 0.01_m}, ConstantDistance{0.5_m, 0.01_m});
}

TEST_CASE("real input: a painting is painted and played") {
    const auto path = testData("06_textures/wuffs/harvesters.jpeg");
    if (!path) return;
    auto opened = app::openAny(path->string());
    REQUIRE_MESSAGE(opened.has_value(), (opened ? std::string() : opened.error().what));
    paintAndRun(*std::move(opened), ConstantDistance{0.8_m, 0.02_m}, ConstantDistance{0.8_m, 0.02_m});
}

TEST_CASE("real input: an RGB-D desk is painted and played with its own depth") {
    const auto colour = testData("02_depth/tum/TUM_color.png");
    const auto depth = testData("02_depth/tum/TUM_depth.png");
    if (!colour || !depth) return;
    auto opened = app::openAny(colour->string());
    REQUIRE_MESSAGE(opened.has_value(), (opened ? std::string() : opened.error().what));
    auto raw = projects::readDepth16(*depth);
    REQUIRE(raw);
    Scene scene = opened->document.scene;
    scene.depth = Box(depthOf(*raw, Metre::fromSi(1.0 / 5000.0)));
    scene.scale = {525.0, PixelScale::Source::calibrated};
    opened->document = after(std::move(opened->document), SetScene{scene});
    paintAndRun(*std::move(opened), ConstantDistance{1.8_m, 0.1_m}, FromDepthMap{});
}

TEST_CASE("real input: a clip's first frame is painted and played") {
    const auto path = testData("04_tracking/tree.avi");
    if (!path) return;
    auto opened = app::openAny(path->string());
    REQUIRE_MESSAGE(opened.has_value(), (opened ? std::string() : opened.error().what));
    CHECK(opened->videoPath == path->string());
    paintAndRun(*std::move(opened), ConstantDistance{0.6_m, 0.01_m}, ConstantDistance{0.6_m, 0.01_m});
}
