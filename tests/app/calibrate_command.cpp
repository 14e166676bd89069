// `calibrate`: from folders of pictures to a file, and what it refuses.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/headless/calibrate_command.h"
#include "core/registration/gray_code.h"
#include "projects/calibration_file.h"
#include "projects/scan_folder.h"
#include "tests/core/registration/procam_truth.h"
#include "tests/support/run_program.h"
#include "tests/support/test_data.h"

using namespace ilf;
using nlohmann::json;

namespace {

Ran calibrate(const std::string& arguments) { return readAsCalled(ILF_STUDIO_PATH, "calibrate " + arguments); }

/// Fewer pixels than a real rig has, so that pictures are quickly made: 640 x 512 and 256 x 192.
truth::Procam smallProcam() {
    truth::Procam p;
    for (truth::Lens* lens : {&p.camera, &p.projector}) {
        const int by = lens == &p.camera ? 2 : 4;
        lens->size = {lens->size.width / by, lens->size.height / by};
        lens->fx /= by, lens->fy /= by, lens->cx /= by, lens->cy /= by;
    }
    return p;
}

/// A board's picture under each pattern, 2 x 2 samples a pixel, whose white margin reaches beyond the picture.
Scan scanOf(const truth::Procam& procam, const truth::BoardAt& at, const Board& board) {
    constexpr int kSide = 2;
    struct Sample {
        int x, y;  ///< on the raster; -1: beside it
        double albedo;
    };
    const auto pose = truth::poseOf(at, board);
    const auto back = pose.inverted();
    const Size size = procam.camera.size;
    std::vector<Sample> samples;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            for (int k = 0; k < kSide * kSide; ++k) {
                const auto [a, b] =
                    truth::slopes(procam.camera, x + (k % kSide + 0.5) / kSide, y + (k / kSide + 0.5) / kSide);
                const auto& r = back.rotation;
                const double z = -back.translation[2] / (r[6] * a + r[7] * b + r[8]);
                const auto on = back(Point3<CameraSpace>{a * z, b * z, z});
                const auto q = procam.projectorFromCamera(Point3<CameraSpace>{a * z, b * z, z});
                const auto p = procam.projector.pixel(q.x, q.y, q.z);
                const bool lit =
                    p[0] >= 0 && p[1] >= 0 && p[0] < procam.projector.size.width && p[1] < procam.projector.size.height;
                const int column = static_cast<int>(std::floor(on.x / board.square.si())) + 1;
                const int row = static_cast<int>(std::floor(on.y / board.square.si())) + 1;
                const bool dark =
                    column >= 0 && row >= 0 && column <= board.columns && row <= board.rows && (column + row) % 2 == 0;
                samples.push_back({lit ? static_cast<int>(p[0]) : -1, static_cast<int>(p[1]), dark ? 0.12 : 0.85});
            }
        }
    }
    Scan scan;
    scan.projector = procam.projector.size;
    scan.patterns = grayCodePatterns(scan.projector);
    for (const Pattern& pattern : scan.patterns) {
        const Image<std::uint8_t> shown = patternPicture(pattern, scan.projector);
        std::vector<std::uint8_t> pixels;
        for (std::size_t i = 0; i < samples.size(); i += kSide * kSide) {
            double light = 6.0;
            for (std::size_t k = 0; k < kSide * kSide; ++k) {
                const Sample& s = samples[i + k];
                if (s.x >= 0) light += s.albedo * shown.at(s.x, s.y) / (kSide * kSide);
            }
            pixels.push_back(static_cast<std::uint8_t>(light));
        }
        scan.pictures.emplace_back(size, 1, std::move(pixels));
    }
    return scan;
}

}  // namespace

TEST_CASE("calibrate: five folders become a file with the true numbers; one of them alone is refused with the reason") {
    const truth::Procam procam = smallProcam();
    const Board board{9, 7, 45.0_mm};  // lit as a whole in each pose
    const TemporaryDirectory folder;
    std::string folders;
    int number = 0;
    for (const truth::BoardAt& at : truth::fivePoses()) {
        const std::string name = folder / ("pose" + std::to_string(++number));
        const auto good = projects::writeScan(name, scanOf(procam, at, board));
        REQUIRE_MESSAGE(good, good.error().what);
        folders += name + " ";
    }
    const std::string file = folder / "calibration.json", how = "--board 9x7 --square 4.5cm ";
    const Ran ran = calibrate(folders + how + "--json -o " + file);
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    const json told = json::parse(ran.out);
    CHECK(told["poses"].size() == 5);
    CHECK(told["poses"][0]["used"] == true);
    CHECK(told["poses"][4]["projector_px"].get<double>() < 0.5);
    CHECK(told["camera"]["deviation"]["fx_px"].get<double>() > 0.0);
    const auto read = projects::readCalibration(file);
    REQUIRE_MESSAGE(read, read.error().what);
    const auto share = [](double found, double truth) { return std::abs(found / truth - 1.0); };
    MESSAGE("f off by " << 100.0 * share(read->camera.fx, procam.camera.fx) << " %, "
                        << 100.0 * share(read->projector.fx, procam.projector.fx) << " %; residuals "
                        << read->cameraRms_px << ", " << read->projectorRms_px << " px");
    CHECK(share(read->camera.fx, procam.camera.fx) < 0.003);
    CHECK(share(read->camera.fy, procam.camera.fy) < 0.003);
    CHECK(share(read->projector.fx, procam.projector.fx) < 0.003);
    CHECK(share(read->projector.fy, procam.projector.fy) < 0.003);
    CHECK(read->provenance == "measured");
    CHECK_FALSE(read->taken.empty());

    const Ran words = calibrate(folder / "pose2 " + folder / "pose3 " + folder / "pose4 " + how);
    CHECK(words.code == 0);
    CHECK(words.out.find("pose3: board found, 63 of 63 corners") != std::string::npos);
    CHECK(words.out.find("mm to the right of the camera") != std::string::npos);

    const std::string untouched = folder / "one.json";
    const Ran one = calibrate(folder / "pose2 " + how + "-o " + untouched);
    CHECK(one.code == 1);
    CHECK(one.out.find("One pose of the board cannot tell a camera's focal length") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(untouched));
    const Ran none = calibrate(folder / "pose2 " + folder / "pose3 --board 12x5 --square 4.5cm");
    CHECK(none.code == 1);
    CHECK(none.out.find("no chessboard of 12 x 5") != std::string::npos);
}

TEST_CASE("calibrate: what is typed wrongly is said") {
    for (const char* wrong : {"", "somewhere --board 9by6", "somewhere --square 75", "somewhere --projector 1024",
                              "--opencv somewhere", "somewhere --square -3mm", "somewhere --board 1x1"}) {
        const Ran ran = calibrate(wrong);
        INFO(wrong << ": " << ran.out);
        CHECK(ran.code == 2);
    }
    CHECK(calibrate("/nowhere/at/all").code == 1);
    CHECK(app::lengthFromWords("75mm")->si() == doctest::Approx(0.075));
    CHECK(app::lengthFromWords("2.5 cm")->si() == doctest::Approx(0.025));
    CHECK(app::sizeFromWords("1024x768") == Size{1024, 768});
    CHECK_FALSE(app::sizeFromWords("1024x768x3"));
}

TEST_CASE("calibrate: a real capture of one pose is refused, and a real rig's calibration is taken over") {
    const auto capture = testData("03_procam/kamino410/capture_0");
    const auto result = testData("03_procam/kamino410/calibration_result.xml");
    if (!capture || !result) return;
    const Ran one = calibrate(capture->string() + " --board 9x7 --square 75mm --projector 1024x768");
    CHECK(one.code == 1);
    CHECK(one.out.find("63 of 63 corners on the projector") != std::string::npos);
    CHECK(one.out.find("One pose of the board cannot tell") != std::string::npos);

    const TemporaryDirectory folder;
    const std::string file = folder / "real.json";
    const Ran taken = calibrate("--opencv " + result->string() + " --projector 1024x768 -o " + file);
    REQUIRE_MESSAGE(taken.code == 0, taken.out);
    const auto read = projects::readCalibration(file);
    REQUIRE(read);
    CHECK(read->camera.fx == doctest::Approx(3452.39).epsilon(1e-5));
}
