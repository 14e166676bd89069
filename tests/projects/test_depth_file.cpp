#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "projects/depth_file.h"
#include "projects/picture_exr.h"
#include "projects/pictures.h"
#include "tests/projects/folder.h"
#include "tests/support/law.h"
#include "tests/support/test_data.h"

namespace ilf::projects {

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

Image<float> someDepth(Size size = {5, 3}) {
    std::vector<float> metres;
    for (int i = 0; i < size.width * size.height; ++i)
        metres.push_back(i == 4 ? 0.0F : 0.25F + 0.125F * static_cast<float>(i));
    return {size, 1, std::move(metres)};
}

DepthReading reading(Size picture) {
    DepthReading r;
    r.picture = picture;
    r.focalPixels = 500.0;
    return r;
}

std::string refusal(std::string_view bytes, const DepthReading& how) {
    const auto read = decodeDepth(bytes, "d", how);
    return read ? std::string() : read.error().what;
}

/// A PFM as another program writes it, most significant byte first.
std::string bigEndian(std::string pfm) {
    const std::size_t at = pfm.find("-1.0");
    pfm.replace(at, 4, "1.0");
    for (std::size_t i = at + 4; i + 3 < pfm.size(); i += 4)
        std::reverse(pfm.begin() + static_cast<std::ptrdiff_t>(i), pfm.begin() + static_cast<std::ptrdiff_t>(i) + 4);
    return pfm;
}

float medianOf(const Image<float>& metres) {
    std::vector<float> known;
    std::ranges::copy_if(metres.pixels(), std::back_inserter(known), [](float v) { return v > 0.0F; });
    std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2), known.end());
    return known[known.size() / 2];
}

}  // namespace

TEST_CASE("depth file: PFM is read in both byte orders, bottom row first") {
    const Image<float> depth = someDepth();
    const std::string pfm = encodeDepthPfm(depth);
    CHECK(pfm.starts_with("Pf\n5 3\n-1.0\n"));
    // The first float of the file is the lower left pixel.
    float first = 0.0F;
    std::memcpy(&first, pfm.data() + 12, sizeof first);
    CHECK(first == depth.at(0, 2));
    for (const std::string& bytes : {pfm, bigEndian(pfm)}) {
        const auto read = decodeDepth(bytes, "d.pfm", reading({5, 3}));
        REQUIRE_MESSAGE(read.has_value(), (read ? std::string() : read.error().what));
        CHECK(read->measured.metres == depth);
        CHECK(read->measured.camera == plainPinhole({5, 3}, 500.0));
        CHECK(read->note.empty());
        CHECK(read->measured.step == 0.0_m);
    }
}

TEST_CASE("depth file: EXR keeps metres and uncertainty exactly, and others' only channel is taken for depth") {
    const Image<float> depth = someDepth(), sigma({5, 3}, 1, std::vector<float>(15, 0.001F));
    const auto both = encodeDepthExr(depth, sigma);
    REQUIRE(both);
    const auto read = decodeDepth(*both, "d.exr", reading({5, 3}));
    REQUIRE_MESSAGE(read.has_value(), (read ? std::string() : read.error().what));
    CHECK(read->measured.metres == depth);
    CHECK(read->measured.sigma == sigma);
    const auto alone = decodeDepth(*encodeDepthExr(depth, {}), "d.exr", reading({5, 3}));
    CHECK(alone->measured.metres == depth);
    CHECK(alone->measured.sigma.empty());
    const auto grey = decodeDepth(*encodeExr(depth, {}, ExrDepth::single), "grey.exr", reading({5, 3}));
    CHECK(grey->measured.metres == depth);
    const Radiance colours({5, 3}, 3, std::vector<float>(45, 1.0F));
    CHECK(refusal(*encodeExr(colours, {}, ExrDepth::single), reading({5, 3})).find("no channel of depth") !=
          std::string::npos);
}

TEST_CASE("depth file: zero, negative, infinite and NaN values are holes") {
    const Image<float> depth({6, 1}, 1, {0.0F, -1.0F, kInfinite, -kInfinite, NAN, 1.5F});
    const Image<float> expected({6, 1}, 1, {0, 0, 0, 0, 0, 1.5F});
    CHECK(decodeDepth(encodeDepthPfm(depth), "d", reading({6, 1}))->measured.metres == expected);
    CHECK(decodeDepth(*encodeDepthExr(depth, {}), "d", reading({6, 1}))->measured.metres == expected);
    const Image<float> holes({2, 1}, 1, {0.0F, NAN});
    CHECK(refusal(encodeDepthPfm(holes), reading({2, 1})) == "d holds only holes: no pixel has a distance.");
}

TEST_CASE("depth file: any depth comes back from each format it can be written in") {
    law("any size, any values", [] {
        const Size size{*rc::gen::inRange(1, 20), *rc::gen::inRange(1, 20)};
        std::vector<float> metres{1.0F};
        while (metres.size() < static_cast<std::size_t>(size.width * size.height))
            metres.push_back(static_cast<float>(*rc::gen::inRange(0, 6000)) * 1e-3F);
        const Image<float> depth(size, 1, std::move(metres));
        RC_ASSERT(decodeDepth(encodeDepthPfm(depth), "d", reading(size))->measured.metres == depth);
        RC_ASSERT(decodeDepth(*encodeDepthExr(depth, {}), "d", reading(size))->measured.metres == depth);
        DepthReading inSteps = reading(size);
        inSteps.step = 1.0_mm;
        const auto png = decodeDepth(*encodeDepthPng(depth, 1.0_mm), "d", inSteps);
        for (std::size_t i = 0; i < depth.pixels().size(); ++i)
            RC_ASSERT(std::abs(png->measured.metres.pixels()[i] - depth.pixels()[i]) < 1e-6F);
    });
}

TEST_CASE("depth file: another resolution of the same view is resampled when the intrinsics say so, else refused") {
    const Image<float> depth = someDepth({4, 2});
    CHECK(refusal(encodeDepthPfm(depth), reading({8, 4})) ==
          "d has 4 x 2 pixels and the picture 8 x 4: they must agree, or the camera's intrinsics must be given with "
          "it.");
    DepthReading with = reading({8, 4});
    with.intrinsics = Pinhole{{4, 2}, 3.0, 3.0, 2.25, 1.0, {}};
    const auto read = decodeDepth(encodeDepthPfm(depth), "d", with);
    REQUIRE(read);
    CHECK(read->note == "It was resampled from 4 x 2 to 8 x 4 pixels.");
    CHECK(read->measured.camera == Pinhole{{8, 4}, 6.0, 6.0, 4.5, 2.0, {}});
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x)
            CHECK(read->measured.metres.at(x, y) == depth.at(x / 2, y / 2));
    }
    with.picture = {8, 8};
    CHECK(refusal(encodeDepthPfm(depth), with).find("in another proportion") != std::string::npos);
    with.picture = {4, 2};
    with.intrinsics->size = {4, 4};
    CHECK(refusal(encodeDepthPfm(depth), with).find("another camera or mode") != std::string::npos);
}

TEST_CASE("depth file: what is no depth is refused with a sentence, at whatever byte it ends") {
    const std::string pfm = encodeDepthPfm(someDepth());
    for (std::size_t length = 0; length < pfm.size(); ++length)
        CHECK_FALSE(decodeDepth(pfm.substr(0, length), "d", reading({5, 3})));
    const std::string exr = *encodeDepthExr(someDepth(), {});
    for (std::size_t length = 0; length < exr.size(); length += 7)
        CHECK_FALSE(decodeDepth(exr.substr(0, length), "d", reading({5, 3})));
    CHECK(refusal("PF\n1 1\n-1.0\n" + std::string(12, 'a'), reading({1, 1})).find("three colours") !=
          std::string::npos);
    CHECK(refusal("Pf\n99999 99999\n-1.0\n", reading({1, 1})).find("100 megapixels") != std::string::npos);
    CHECK(refusal("Pf\n-1 5\n-1.0\n", reading({1, 1})).find("no size") != std::string::npos);
    CHECK(refusal("Pf\n1 1\n0\nabcd", reading({1, 1})).find("size or scale") != std::string::npos);
    CHECK(refusal(*encodePng(Image<std::uint8_t>({1, 1}, 1, {7})), reading({1, 1})).find("16 bits") !=
          std::string::npos);
    DepthReading nothing = reading({1, 1});
    nothing.step = 0.0_m;
    CHECK_FALSE(decodeDepth(*encodePng16(Image<std::uint16_t>({1, 1}, 1, {7})), "d", nothing));
    CHECK(readDepth("/nowhere/d.exr", reading({1, 1})).error().what.find("does not exist") != std::string::npos);
}

TEST_CASE("depth file: written by the ending of its name") {
    const Folder folder;
    MeasuredDepth measured;
    measured.metres = someDepth();
    measured.step = 125.0_mm;
    for (const char* name : {"d.png", "d.PFM", "d.exr"}) {
        REQUIRE(writeDepth(folder / name, measured));
        DepthReading how = reading({5, 3});
        how.step = 125.0_mm;
        const auto read = readDepth(folder / name, how);
        REQUIRE_MESSAGE(read.has_value(), (read ? std::string() : read.error().what));
        CHECK(read->measured.metres == measured.metres);
    }
    CHECK(writeDepth(folder / "d.jpg", measured).error().what.find("must end in .png, .pfm or .exr") !=
          std::string::npos);
}

TEST_CASE("depth file: intrinsics are Open3D's, with our pixel centres") {
    const Folder folder;
    const Pinhole camera{{640, 480}, 525.0, 526.0, 320.0, 240.0, {-0.1, 0, 0, 0, 0}};
    CHECK(*readIntrinsics(folder.put("own.json", intrinsicsText(camera))) == camera);
    const std::string nested = "{\"extrinsic\": [], \"intrinsic\": " + intrinsicsText(camera) + "}";
    CHECK(*readIntrinsics(folder.put("pose.json", nested)) == camera);
    CHECK(readIntrinsics(folder.put("few.json", "{\"width\": 1, \"height\": 1, \"intrinsic_matrix\": [1]}"))
              .error()
              .what.find("intrinsic_matrix") != std::string::npos);
    CHECK_FALSE(readIntrinsics(folder.put("none.json", "{\"width\": 0, \"height\": 1, \"intrinsic_matrix\": "
                                                       "[1,0,0,0,1,0,0,0,1]}")));
    if (const auto given = testData("02_depth/open3d_redwood/camera_primesense.json")) {
        CHECK(*readIntrinsics(*given) == Pinhole{{640, 480}, 525.0, 525.0, 320.0, 240.0, {}});
    }
}

TEST_CASE("depth file: the step of real depth cameras is guessed right and said, and their values are the known ones") {
    const auto truth = testData("02_depth/GROUND_TRUTH.json");
    if (!truth) return;
    const auto known = nlohmann::json::parse(contentOf(*truth));
    const auto check = [&](const std::string& name, double step, const std::string& said) {
        CAPTURE(name);
        const auto read = readDepth(truth->parent_path() / name, reading({640, 480}));
        REQUIRE_MESSAGE(read.has_value(), (read ? std::string() : read.error().what));
        CHECK(read->note.find(said) != std::string::npos);
        const auto& stats = known[name]["stats"];
        const Image<float>& metres = read->measured.metres;
        const auto holes = std::ranges::count(metres.pixels(), 0.0F);
        CHECK(1.0 - static_cast<double>(holes) / (640.0 * 480.0) ==
              doctest::Approx(stats["valid"].get<double>()).epsilon(1e-4));
        CHECK(static_cast<double>(medianOf(metres)) == doctest::Approx(step * stats["median"].get<double>()));
        CHECK(static_cast<double>(std::ranges::max(metres.pixels())) ==
              doctest::Approx(step * stats["max"].get<double>()));
    };
    check("tum/TUM_depth.png", 1.0 / 5000.0, "0.2 mm");
    for (const int i : {0, 1, 2, 3, 4})
        check("open3d_redwood/RGBD/depth/0000" + std::to_string(i) + ".png", 1e-3, "1 mm");
}

}  // namespace ilf::projects
