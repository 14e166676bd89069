// `render` as operators call it: the real program, its files, words and exit codes.
#include <doctest/doctest.h>

#include <sstream>

#include "app/headless/render_progress.h"
#include "projects/pictures.h"
#include "tests/projects/folder.h"
#include "tests/support/run_program.h"

using namespace ilf;

namespace {

const std::string kSamples = std::string(ILF_SOURCE_DIR) + "/projects/samples/";

/// Both streams together.
Ran render(const std::string& arguments) { return readAsCalled(ILF_STUDIO_PATH, "render " + arguments); }

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string inQuotes(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

const std::string kDesk = "'" + kSamples + "study-desk.ilfd'", kObjects = "'" + kSamples + "four-objects.ilfd'";

}  // namespace

TEST_CASE("render: usage is refused with exit code 2, a sentence, and no file") {
    const Folder folder;
    const std::string out = " -o " + inQuotes(folder / "a.png");
    for (const std::string& wrong : {
             kDesk,
             kDesk + " -o " + inQuotes(folder / "a.jpg"),
             kDesk + " -o " + inQuotes(folder / "a"),
             kDesk + " --view depth" + out,
             kDesk + " --view slot:99" + out,
             kDesk + " --eye third" + out,
             kDesk + " --rung quick" + out,
             kDesk + " --gaze 1" + out,
             kDesk + " --attend Nobody" + out,
             kDesk + " --scale 2" + out,
             kDesk + " --samples 1 --reference" + out,
             kDesk + " " + kObjects + out,
             kDesk + " --format exr" + out,
             kDesk + " --format bmp --out-dir " + inQuotes(folder / "d"),
             kDesk + out + " --out-dir " + inQuotes(folder / "d"),
         }) {
        const Ran ran = render(wrong);
        CHECK_MESSAGE(ran.code == 2, wrong);
        CHECK_MESSAGE(ran.out.size() > 20, ran.out);
    }
    CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("render: both eyes and the picture with marks, each in the format its name asks for") {
    const Folder folder;
    const Ran ran =
        render(kObjects + " --views perceived,overlay --eye both --scale 0.2 -o " + inQuotes(folder / "o.tif"));
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    CHECK(contains(ran.out, "o-perceived-left.tif: perceived, left eye, at rest, simulated, 256x160"));
    CHECK(contains(ran.out, "3 pictures written."));
    const auto left = projects::readPicture(folder / "o-perceived-left.tif");
    const auto right = projects::readPicture(folder / "o-perceived-right.tif");
    REQUIRE(left);
    REQUIRE(right);
    CHECK(left->extension == ".tiff");
    CHECK(left->picture.size() == Size{256, 160});
    CHECK_FALSE(left->picture == right->picture);
    CHECK(projects::readPicture(folder / "o-overlay.tif").has_value());
    CHECK(render(kObjects + " --scale 0.2 -o " + inQuotes(folder / "o.exr")).code == 0);
    CHECK(contentOf(folder / "o.exr").starts_with("\x76\x2f\x31\x01"));
}

TEST_CASE("render: an error map says its white, its figures and the noise it is measured with") {
    const Folder folder;
    const Ran ran = render(kObjects + " --view error --scale 0.1 --samples 32 -o " + inQuotes(folder / "e.png"));
    REQUIRE_MESSAGE(ran.code == 0, ran.out);
    for (const char* part : {"error, left eye, at rest, white is ", "PSNR ", " of a border", "worst pixel ",
                             "own noise is ", "32 rays a pixel"})
        CHECK_MESSAGE(contains(ran.out, part), ran.out);
    const auto map = projects::readPicture(folder / "e.png");
    REQUIRE(map);
    CHECK(map->picture.size() == Size{128, 80});
}

TEST_CASE("render: a batch goes on after a project that cannot be opened, and its exit code tells") {
    const Folder folder;
    folder.put("bad.ilfd/project.json", "{");
    const Ran ran = render(kObjects + " " + inQuotes(folder / "bad.ilfd") + " " + kDesk +
                           " --views plain,camera --format png,exr --scale 0.1 --out-dir " + inQuotes(folder / "out"));
    CHECK_MESSAGE(ran.code == 1, ran.out);
    CHECK(contains(ran.out, "bad.ilfd"));
    CHECK(contains(ran.out, "8 pictures written to " + (folder / "out").string() + ", 1 failed."));
    CHECK_FALSE(contains(ran.out, "\r"));  // no bar where there is no terminal
    for (const char* name :
         {"four-objects-plain.png", "four-objects-camera.exr", "study-desk-plain.exr", "study-desk-camera.png"})
        CHECK_MESSAGE(std::filesystem::exists(folder / ("out/" + std::string(name))), name);
}

TEST_CASE("render: two projects of one name do not write over each other") {
    const Folder folder;
    std::filesystem::create_directory_symlink(kSamples + "study-desk.ilfd", folder / "four-objects.ilfd");
    const Ran ran = render(kObjects + " " + inQuotes(folder / "four-objects.ilfd/") + " --view overlay --out-dir " +
                           inQuotes(folder / "out"));
    CHECK_MESSAGE(ran.code == 0, ran.out);
    const auto one = projects::readPicture(folder / "out/four-objects-overlay.png");
    const auto two = projects::readPicture(folder / "out/four-objects-2-overlay.png");
    REQUIRE(one);
    REQUIRE(two);
    CHECK_FALSE(one->picture == two->picture);
}

TEST_CASE("render: a folder that cannot be made or written fails with exit code 1 and its name") {
    const Folder folder;
    folder.put("file", "in the way");
    const Ran blocked = render(kObjects + " --view plain --out-dir " + inQuotes(folder / "file/out"));
    CHECK(blocked.code == 1);
    CHECK(contains(blocked.out, "file"));
    const Ran nowhere = render(kObjects + " --view plain -o " + inQuotes(folder / "none/a.exr"));
    CHECK(nowhere.code == 1);
    CHECK(contains(nowhere.out, "none"));
}

TEST_CASE("progress: drawn over its own line, cut to the terminal, and silent without one") {
    std::ostringstream terminal, file;
    {
        app::RenderProgress bar(terminal, 40);
        bar.show(0.5, std::string(100, 'x'));
        CHECK(terminal.str().starts_with("\r\x1b[K[############............] 50 %"));
        CHECK(terminal.str().size() == 4 + 39);
        bar.cleared();
        CHECK(terminal.str().ends_with("\r\x1b[K"));
    }
    CHECK(terminal.str().size() == 4 + 39 + 4);  // cleared once
    app::RenderProgress silent(file, 0);
    silent.show(0.5, "something");
    silent.cleared();
    CHECK(file.str().empty());
}
