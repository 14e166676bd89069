#include <doctest/doctest.h>

#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/srgb.h"
#include "projects/pictures.h"
#include "tests/projects/folder.h"
#include "tests/support/law.h"
#include "tests/support/test_data.h"

using namespace ilf;
using namespace ilf::projects;

namespace {

std::string encoded(const std::string& extension, const cv::Mat& mat) {
    std::vector<std::uint8_t> bytes;
    REQUIRE(cv::imencode(extension, mat, bytes));
    return {bytes.begin(), bytes.end()};
}

cv::Mat colours(int type) {
    cv::Mat mat(24, 32, type);
    cv::randu(mat, 0, mat.depth() == CV_8U ? 256 : 65536);
    return mat;
}

std::string sentence(const std::filesystem::path& file) {
    const auto read = readPicture(file);
    REQUIRE_FALSE(read);
    return read.error().what;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("pictures: 8 and 16 bits, grey and colour, in PNG, TIFF, JPEG and WebP") {
    Folder folder;
    for (const char* extension : {".png", ".tiff"}) {
        for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
            CAPTURE(extension);
            CAPTURE(type);
            const cv::Mat mat = colours(type);
            const auto file = readPicture(folder.put(std::string("a") + extension, encoded(extension, mat)));
            REQUIRE(file);
            CHECK(file->picture.size() == Size{32, 24});
            CHECK(file->picture.channels() == 3);
            CHECK(file->extension == extension);
            CHECK(file->note.empty());
            CHECK_FALSE(file->focalPixels);
            const int red = mat.channels() == 3 ? 2 : 0;  // OpenCV keeps blue first
            const double stored = mat.depth() == CV_8U ? 257.0 * mat.ptr<std::uint8_t>(7)[5 * mat.channels() + red]
                                                       : mat.ptr<std::uint16_t>(7)[5 * mat.channels() + red];
            CHECK(file->picture.at(5, 7, 0) == stored);
        }
    }
    for (const char* extension : {".jpg", ".webp"}) {
        cv::Mat mat(24, 32, CV_8UC3, cv::Scalar(30, 120, 220));
        const auto file = readPicture(folder.put(std::string("a") + extension, encoded(extension, mat)));
        REQUIRE(file);
        CHECK(file->extension == extension);
        CHECK(file->picture.at(5, 7, 0) / 257 == doctest::Approx(220).epsilon(0.03));
        CHECK(file->picture.at(5, 7, 2) / 257 == doctest::Approx(30).epsilon(0.2));
    }
}

TEST_CASE("pictures: transparency is laid over black, and said") {
    Folder folder;
    cv::Mat mat(4, 4, CV_8UC4, cv::Scalar(200, 100, 50, 255));
    CHECK(readPicture(folder.put("opaque.png", encoded(".png", mat)))->note.empty());
    mat.at<cv::Vec4b>(1, 2) = {200, 100, 50, 51};
    const auto file = readPicture(folder.put("glass.png", encoded(".png", mat)));
    REQUIRE(file);
    CHECK(file->note == "Its transparency was laid over black.");
    CHECK(file->picture.at(2, 1, 0) == 10 * 257);
    CHECK(file->picture.at(0, 0, 0) == 50 * 257);
}

TEST_CASE("pictures: what is no picture gets a sentence") {
    Folder folder;
    CHECK(contains(sentence(folder / "none.png"), "none.png\" does not exist"));
    CHECK(contains(sentence(folder.path()), "is a folder; choose a file"));
    CHECK(contains(sentence(folder.put("empty.png", "")), "empty.png\" is empty: 0 bytes."));
    CHECK(contains(sentence(folder.put("text.png", "To whom it may concern")), "Use PNG, JPEG, TIFF or WebP."));
    CHECK(contains(sentence("/dev/null"), "not a file but a device"));

    const cv::Mat mat = colours(CV_8UC3);
    for (const char* extension : {".png", ".jpg", ".tiff", ".webp"}) {
        const std::string whole = encoded(extension, mat);
        for (std::size_t length = 1; length + 1 < whole.size(); length += 1 + length / 4) {
            CAPTURE(extension);
            CAPTURE(length);
            const auto cut = readPicture(folder.put("cut", whole.substr(0, length)));
            REQUIRE_FALSE(cut);
            CHECK((contains(cut.error().what, "cut short") || contains(cut.error().what, "Use PNG")));
        }
    }
}

TEST_CASE("pictures: a header that claims more than 100 megapixels is refused before anything is decoded") {
    Folder folder;
    // 20000 x 20000 grey pixels in a PNG of 69 bytes.
    std::string png = encoded(".png", cv::Mat(1, 1, CV_8UC1, cv::Scalar(0)));
    png.replace(16, 8, std::string("\0\0\x4E\x20\0\0\x4E\x20", 8));
    CHECK(contains(sentence(folder.put("bomb.png", png)), "more than 100 megapixels. Scale it down"));
    std::string jpg = encoded(".jpg", cv::Mat(8, 8, CV_8UC1, cv::Scalar(0)));
    const std::size_t frame = jpg.find("\xFF\xC0");
    REQUIRE(frame != std::string::npos);
    jpg.replace(frame + 5, 4, "\xFF\xFF\xFF\xFF");
    CHECK(contains(sentence(folder.put("bomb.jpg", jpg)), "more than 100 megapixels"));
}

TEST_CASE("pictures: damaged bytes never do more than refuse") {
    std::vector<std::string> seeds;
    for (const char* extension : {".png", ".jpg", ".tiff", ".webp"}) {
        seeds.push_back(encoded(extension, colours(CV_8UC3)));
    }
    law("a picture with bytes changed is read or refused", [&](std::uint32_t pick) {
        std::string bytes = seeds[pick % seeds.size()];
        for (int i = 0; i < 8; ++i) {
            bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] = *rc::gen::arbitrary<char>();
        }
        const auto file = decodePicture(Box<std::string>(bytes), "it");
        return file ? file->picture.channels() == 3 : !file.error().what.empty();
    });
}

TEST_CASE("pictures: EXIF says which way is up and the focal length") {
    // A JPEG whose EXIF data (little endian) holds orientation 6 and, in its EXIF directory, 28 mm as 35 mm equivalent.
    cv::Mat mat(16, 32, CV_8UC3, cv::Scalar(0, 0, 0));
    mat(cv::Rect(0, 0, 16, 16)).setTo(cv::Scalar(255, 255, 255));
    std::string jpg = encoded(".jpg", mat);
    const std::string tiff("II*\0\x08\0\0\0"
                           "\x02\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\x69\x87\x04\0\x01\0\0\0\x26\0\0\0\0\0\0\0"
                           "\x01\0\x05\xA4\x03\0\x01\0\0\0\x1C\0\0\0\0\0\0\0",
                           56);
    const std::string body = std::string("Exif\0\0", 6) + tiff;
    jpg.insert(2, std::string("\xFF\xE1\0", 3) + static_cast<char>(body.size() + 2) + body);
    const auto file = decodePicture(Box<std::string>(jpg), "it");
    REQUIRE(file);
    CHECK(file->picture.size() == Size{16, 32});  // turned by a quarter, clockwise:
    CHECK(file->picture.at(8, 4, 0) > 60000);     // what was left is on top
    CHECK(file->picture.at(8, 28, 0) < 5000);
    REQUIRE(file->focalPixels);
    CHECK(*file->focalPixels == doctest::Approx(28.0 * std::hypot(16, 32) / 43.2666));
}

TEST_CASE("pictures: what is written is read again, exactly") {
    Folder folder;
    law("8 and 16 bits", [&](std::uint8_t width, std::uint8_t height) {
        const Size size{1 + width % 40, 1 + height % 40};
        const auto count = static_cast<std::size_t>(size.width * size.height);
        const Image<std::uint8_t> mask(
            size, 1, *rc::gen::container<std::vector<std::uint8_t>>(count, rc::gen::arbitrary<std::uint8_t>()));
        RC_ASSERT(writePng(folder / "mask.png", mask).has_value());
        RC_ASSERT(*readMask(folder / "mask.png") == mask);
        const Image<std::uint16_t> depth(
            size, 1, *rc::gen::container<std::vector<std::uint16_t>>(count, rc::gen::arbitrary<std::uint16_t>()));
        RC_ASSERT(writePng16(folder / "depth.png", depth).has_value());
        RC_ASSERT(*readDepth16(folder / "depth.png") == depth);
        const Picture picture(
            size, 3, *rc::gen::container<std::vector<std::uint16_t>>(3 * count, rc::gen::arbitrary<std::uint16_t>()));
        const auto again = decodePicture(Box<std::string>(*encodePicture(picture)), "it");
        RC_ASSERT(again->picture == picture);
        RC_ASSERT(decodePicture(Box<std::string>(*encodePicture(toPicture(toBytes(picture)))), "it")->picture ==
                  toPicture(toBytes(picture)));
    });
    CHECK_FALSE(readDepth16(folder.put("colour.png", encoded(".png", colours(CV_8UC3)))));
    CHECK(contains(writePng(folder / "no/such/a.png", Image<std::uint8_t>({1, 1}, 1, {0})).error().what,
                   "cannot be written"));
}

TEST_CASE("pictures: every real picture at hand is read") {
    int count = 0;
    for (const char* relative :
         {"06_textures/opencv/imageTextN.png", "06_textures/skimage/brick.png", "06_textures/skimage/chelsea.png",
          "06_textures/skimage/coffee.png", "06_textures/skimage/rocket.jpg", "06_textures/skimage/text.png",
          "06_textures/wuffs/harvesters.jpeg", "02_depth/tum/TUM_color.png",
          "04_tracking/box_video/resized_IMG_3875.JPG"}) {
        const auto path = testData(relative);
        if (!path) continue;
        CAPTURE(relative);
        const auto file = readPicture(*path);
        REQUIRE(file);
        CHECK(file->picture.channels() == 3);
        CHECK(file->picture.width() > 100);
        CHECK(*file->bytes == contentOf(*path));
        ++count;
    }
    if (const auto depth = testData("02_depth/tum/TUM_depth.png")) {
        const auto raw = readDepth16(*depth);
        REQUIRE(raw);
        CHECK(raw->size() == Size{640, 480});
    }
    std::printf("%d real pictures read\n", count);
}

TEST_CASE("srgb: codes go to linear light and back unchanged, and the nearest code is taken") {
    for (int code = 0; code < 256; ++code) {
        CHECK(srgb8(static_cast<float>(linearFromSrgb(code / 255.0))) == code);
    }
    law("the nearest code", [](std::uint16_t v) {
        const float linear = static_cast<float>(v) / 65535.0F;
        return srgb8(linear) == std::lround(255.0 * srgbFromLinear(static_cast<double>(linear)));
    });
    CHECK(linearFromSrgb(0.5) == doctest::Approx(0.21404114));
    CHECK(toSrgb8(Radiance({2, 1}, 1, {-1.0F, 2.0F})).at(1, 0) == 255);
}
