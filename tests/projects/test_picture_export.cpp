// Pictures for others: read back with the libraries' own readers.
#include "projects/picture_export.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <doctest/doctest.h>
#include <half.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <opencv2/imgcodecs.hpp>

#include "core/base/srgb.h"
#include "projects/picture_icc.h"
#include "projects/pictures.h"
#include "projects/safe_file.h"
#include "tests/projects/folder.h"
#include "tests/projects/some_document.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::projects;

namespace {

/// Values such as light has, and such as it should not have.
Radiance someLight(Size size, int channels, std::uint32_t seed) {
    std::vector<float> values(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) *
                              static_cast<std::size_t>(channels));
    for (float& v : values) {
        seed = seed * 1664525U + 1013904223U;
        v = static_cast<float>(seed >> 8) / static_cast<float>(1U << 23) - 0.25F;  // -0.25 .. 1.75
    }
    return Radiance(size, channels, std::move(values));
}

const PictureFacts kFacts{{"shows", "perceived"}, {"provenance", "simulated"}, {"eye", "left"}, {"rung", "rest"}};

struct Exr {
    std::vector<std::string> channels;
    std::vector<float> values;  ///< of channels R, G, B or Y, interleaved
    Imf::PixelType type = Imf::UINT;
    std::string shows, provenance, eye, rung, encoding;
    bool chromaticities = false;
    float redX = 0.0F, whiteY = 0.0F;
};

Exr exrAt(const fs::path& path) {
    Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    Exr exr;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        exr.channels.emplace_back(c.name());
        exr.type = c.channel().type;
    }
    const auto box = header.dataWindow();
    const auto width = static_cast<std::size_t>(box.max.x - box.min.x + 1);
    const auto height = static_cast<std::size_t>(box.max.y - box.min.y + 1);
    const std::vector<std::string> order =
        exr.channels.size() == 3 ? std::vector<std::string>{"R", "G", "B"} : exr.channels;
    exr.values.resize(width * height * order.size());
    Imf::FrameBuffer frame;
    const std::size_t pixel = sizeof(float) * order.size();
    for (std::size_t c = 0; c < order.size(); ++c) {
        frame.insert(order[c],
                     Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(exr.values.data() + c), pixel, pixel * width));
    }
    file.setFrameBuffer(frame);
    file.readPixels(box.min.y, box.max.y);
    const auto word = [&](const char* key) {
        const auto* found = header.findTypedAttribute<Imf::StringAttribute>(key);
        return found != nullptr ? found->value() : std::string();
    };
    exr.shows = word("shows");
    exr.provenance = word("provenance");
    exr.eye = word("eye");
    exr.rung = word("rung");
    exr.encoding = word("encoding");
    exr.chromaticities = Imf::hasChromaticities(header);
    if (exr.chromaticities) {
        exr.redX = Imf::chromaticities(header).red.x;
        exr.whiteY = Imf::chromaticities(header).white.y;
    }
    return exr;
}

struct Tiff {
    std::uint16_t bits = 0, channels = 0, photometric = 0;
    std::string description, profile;
    std::vector<std::uint16_t> codes;
};

Tiff tiffAt(const fs::path& path) {
    const std::unique_ptr<TIFF, decltype(&TIFFClose)> file(TIFFOpen(path.c_str(), "r"), TIFFClose);
    REQUIRE(file);
    Tiff tiff;
    std::uint32_t width = 0, height = 0, profileSize = 0;
    char* text = nullptr;
    void* profile = nullptr;
    TIFFGetField(file.get(), TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(file.get(), TIFFTAG_IMAGELENGTH, &height);
    TIFFGetField(file.get(), TIFFTAG_BITSPERSAMPLE, &tiff.bits);
    TIFFGetField(file.get(), TIFFTAG_SAMPLESPERPIXEL, &tiff.channels);
    TIFFGetField(file.get(), TIFFTAG_PHOTOMETRIC, &tiff.photometric);
    if (TIFFGetField(file.get(), TIFFTAG_IMAGEDESCRIPTION, &text) == 1) tiff.description = text;
    if (TIFFGetField(file.get(), TIFFTAG_ICCPROFILE, &profileSize, &profile) == 1)
        tiff.profile.assign(static_cast<const char*>(profile), profileSize);
    const std::size_t row = static_cast<std::size_t>(width) * tiff.channels;
    tiff.codes.resize(row * height);
    for (std::uint32_t y = 0; y < height; ++y)
        REQUIRE(TIFFReadScanline(file.get(), tiff.codes.data() + row * y, y) == 1);
    return tiff;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::vector<std::string> namesIn(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

TEST_CASE("export: the ending chooses the format, in any case, and other endings are refused with what would do") {
    CHECK(*pictureFormat("a/seen.png") == PictureFormat::png);
    CHECK(*pictureFormat("seen.TIF") == PictureFormat::tiff);
    CHECK(*pictureFormat("seen.tiff") == PictureFormat::tiff);
    CHECK(*pictureFormat("seen.left.Exr") == PictureFormat::exr);
    for (const char* other : {"seen", "seen.jpg", "seen.png.", ".png", "png", "seen.hdr", ""}) {
        const auto refused = pictureFormat(other);
        REQUIRE_FALSE_MESSAGE(refused, other);
        CHECK(contains(refused.error().what, ".exr"));
    }
}

TEST_CASE("export: an EXR of floats holds exactly the light that was computed, and says what it is") {
    const Folder folder;
    for (const int channels : {1, 3}) {
        const Radiance light = someLight({37, 21}, channels, 5);
        REQUIRE(writeExport(folder / "a.exr", LightPicture{light}, kFacts, PictureFormat::exr));
        const Exr exr = exrAt(folder / "a.exr");
        CHECK(exr.channels ==
              (channels == 3 ? std::vector<std::string>{"B", "G", "R"} : std::vector<std::string>{"Y"}));
        CHECK(exr.type == Imf::FLOAT);
        CHECK(std::equal(exr.values.begin(), exr.values.end(), light.pixels().begin(), light.pixels().end()));
        CHECK(exr.shows == "perceived");
        CHECK(exr.provenance == "simulated");
        CHECK(exr.eye == "left");
        CHECK(exr.rung == "rest");
        CHECK(exr.encoding == "linear");
        CHECK(exr.chromaticities == (channels == 3));
        if (channels == 3) {
            CHECK(exr.redX == 0.64F);
            CHECK(exr.whiteY == 0.329F);
        }
    }
}

TEST_CASE("export: an EXR of halves is the nearest half of the light") {
    const Folder folder;
    const Radiance light = someLight({16, 40}, 3, 9);
    REQUIRE(writeExport(folder / "a.exr", LightPicture{light}, kFacts, PictureFormat::exr, ExrDepth::half));
    const Exr exr = exrAt(folder / "a.exr");
    CHECK(exr.type == Imf::HALF);
    REQUIRE(exr.values.size() == light.pixels().size());
    for (std::size_t i = 0; i < exr.values.size(); ++i)
        REQUIRE(exr.values[i] == static_cast<float>(half(light.pixels()[i])));
}

TEST_CASE("export: a TIFF holds 16-bit sRGB codes of the light, its profile and what it shows") {
    const Folder folder;
    const Radiance light = someLight({33, 200}, 3, 2);
    REQUIRE(writeExport(folder / "a.tif", LightPicture{light}, kFacts, PictureFormat::tiff));
    const Tiff tiff = tiffAt(folder / "a.tif");
    CHECK(tiff.bits == 16);
    CHECK(tiff.channels == 3);
    CHECK(tiff.photometric == PHOTOMETRIC_RGB);
    CHECK(tiff.description == "shows: perceived; provenance: simulated; eye: left; rung: rest; encoding: sRGB");
    CHECK(tiff.profile == srgbProfile());
    REQUIRE(tiff.codes.size() == light.pixels().size());
    for (std::size_t i = 0; i < tiff.codes.size(); ++i) {
        const double expected = 65535.0 * srgbFromLinear(static_cast<double>(light.pixels()[i]));
        REQUIRE(std::abs(tiff.codes[i] - expected) <= 0.5);
    }
    // Pictures are read back as any other picture is.
    const auto read = readPicture(folder / "a.tif");
    REQUIRE(read);
    CHECK(
        std::equal(tiff.codes.begin(), tiff.codes.end(), read->picture.pixels().begin(), read->picture.pixels().end()));
}

TEST_CASE("export: codes of 16 bits go through a TIFF unchanged, grey ones too, and linear ones have no profile") {
    const Folder folder;
    law("codes in are codes out", [&] {
        const Size size{*rc::gen::inRange(1, 70), *rc::gen::inRange(1, 70)};
        const Picture codes = noisePicture(size, *rc::gen::arbitrary<std::uint32_t>(), true);
        RC_ASSERT(writeExport(folder / "a.tiff", CodePicture{codes, true}, kFacts, PictureFormat::tiff).has_value());
        const Tiff tiff = tiffAt(folder / "a.tiff");
        RC_ASSERT(std::equal(tiff.codes.begin(), tiff.codes.end(), codes.pixels().begin(), codes.pixels().end()));
    });
    const Picture levels({3, 1}, 1, {0, 257, 65535});
    REQUIRE(writeExport(folder / "a.tiff", CodePicture{levels, false}, kFacts, PictureFormat::tiff));
    const Tiff tiff = tiffAt(folder / "a.tiff");
    CHECK(tiff.codes == std::vector<std::uint16_t>{0, 257, 65535});
    CHECK(tiff.photometric == PHOTOMETRIC_MINISBLACK);
    CHECK(tiff.profile.empty());
    CHECK(contains(tiff.description, "encoding: linear"));
    REQUIRE(writeExport(folder / "a.exr", CodePicture{levels, false}, kFacts, PictureFormat::exr));
    CHECK(exrAt(folder / "a.exr").values == std::vector<float>{0.0F, 257.0F / 65535.0F, 1.0F});
}

TEST_CASE("export: a PNG is the nearest 8-bit code, says that it is sRGB, and what it shows") {
    const Folder folder;
    const Radiance light = someLight({50, 20}, 3, 3);
    PictureFacts facts = kFacts;
    facts.emplace_back("project", "Desk \xE9\xAB\x98");
    REQUIRE(writeExport(folder / "a.png", LightPicture{light}, facts, PictureFormat::png));
    const auto read = readPicture(folder / "a.png");
    REQUIRE(read);
    CHECK(toBytes(read->picture) == toSrgb8(light));
    const std::string bytes = contentOf(folder / "a.png");
    CHECK(contains(bytes, "sRGB"));
    CHECK(contains(bytes, std::string("tEXtprovenance") + '\0' + "simulated"));
    CHECK(contains(bytes, std::string("iTXtproject") + std::string(5, '\0') + "Desk \xE9\xAB\x98"));
    const Picture levels({2, 1}, 1, {0, 65535});
    REQUIRE(writeExport(folder / "b.png", CodePicture{levels, false}, kFacts, PictureFormat::png));
    CHECK_FALSE(contains(contentOf(folder / "b.png"), "sRGB"));
    CHECK(contains(contentOf(folder / "b.png"), std::string("encoding") + '\0' + "linear"));
}

TEST_CASE("export: differences keep their sign in EXR; elsewhere they are amounts, linear up to white") {
    const Folder folder;
    const Radiance difference({4, 1}, 3, {0.0F, -0.05F, 0.1F, 0.2F, -0.3F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F});
    const DifferencePicture picture{difference, 0.2};
    REQUIRE(writeExport(folder / "a.exr", picture, kFacts, PictureFormat::exr));
    CHECK(exrAt(folder / "a.exr").values == std::vector<float>(difference.pixels().begin(), difference.pixels().end()));
    REQUIRE(writeExport(folder / "a.tif", picture, kFacts, PictureFormat::tiff));
    const Tiff tiff = tiffAt(folder / "a.tif");
    CHECK(std::vector<std::uint16_t>(tiff.codes.begin(), tiff.codes.begin() + 6) ==
          std::vector<std::uint16_t>{0, 16384, 32768, 65535, 65535, 0});
    CHECK(tiff.profile.empty());
}

TEST_CASE("export: light that is no number is written as darkness, not as whatever a cast makes of it") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const Radiance light({3, 1}, 1, {nan, inf, -inf});
    const Folder folder;
    REQUIRE(writeExport(folder / "a.tif", LightPicture{light}, {}, PictureFormat::tiff));
    CHECK(tiffAt(folder / "a.tif").codes == std::vector<std::uint16_t>{0, 65535, 0});
}

TEST_CASE("export: the profile is one that a reader can follow") {
    const std::string profile = srgbProfile();
    const auto big = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8U | static_cast<unsigned char>(profile[at + i]);
        return value;
    };
    CHECK(big(0) == profile.size());
    CHECK(profile.substr(12, 12) == "mntrRGB XYZ ");
    CHECK(profile.substr(36, 4) == "acsp");
    CHECK(big(128) == 10);
    double white = 0.0;
    for (std::size_t i = 0; i < big(128); ++i) {
        const std::size_t entry = 132 + 12 * i, at = big(entry + 4), size = big(entry + 8);
        REQUIRE(at % 4 == 0);
        REQUIRE(at + size <= profile.size());
        const std::string name = profile.substr(entry, 4);
        if (name == "rXYZ" || name == "gXYZ" || name == "bXYZ") white += big(at + 12) / 65536.0;
    }
    CHECK(white == doctest::Approx(1.0).epsilon(1e-4));  // the three primaries together are white: Y = 1
}

TEST_CASE("export: pictures without pixels and folders that cannot be written are refused") {
    const Folder folder;
    CHECK_FALSE(writeExport(folder / "a.exr", LightPicture{}, kFacts, PictureFormat::exr));
    CHECK_FALSE(writeExport(folder / "a.png", CodePicture{}, kFacts, PictureFormat::png));
    const Radiance light = someLight({4, 4}, 3, 1);
    const auto nowhere = writeExport(folder / "none/a.tif", LightPicture{light}, kFacts, PictureFormat::tiff);
    REQUIRE_FALSE(nowhere);
    CHECK(nowhere.error().fault == Fault::cannotWrite);
    CHECK(contains(nowhere.error().what, "none"));
    CHECK(namesIn(folder.path()).empty());
}

TEST_CASE("export: a disk that fails at any step leaves the old picture or the new one, never half of one") {
    const Radiance old = someLight({9, 9}, 3, 1), fresh = someLight({9, 9}, 3, 2);
    for (const PictureFormat format : {PictureFormat::png, PictureFormat::tiff, PictureFormat::exr}) {
        const Folder folder;
        const fs::path path = folder / (std::string("a") + ending(format));
        REQUIRE(writeExport(path, LightPicture{old}, kFacts, format));
        const std::string before = contentOf(path), after = *encodedExport(LightPicture{fresh}, kFacts, format);
        bool reached = true;
        int refusals = 0;
        for (int step = 1; reached; ++step) {
            const FailAt failing(step, Failing::fullDisk);
            const bool written = writeExport(path, LightPicture{fresh}, kFacts, format).has_value();
            reached = failing.reached();
            if (!written) {
                ++refusals;
                const std::string now = contentOf(path);
                CHECK((now == before || now == after));
            }
            CHECK(namesIn(folder.path()) == std::vector<std::string>{path.filename().string()});
        }
        CHECK(refusals >= 3);
        CHECK(contentOf(path) == after);
    }
}
