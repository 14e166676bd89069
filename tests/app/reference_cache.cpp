// What was traced once is read the next time, and whatever is wrong with a kept file only costs time.
#include "app/reference_cache.h"

#include <fstream>

#include "tests/core/perceived/reference_cases.h"
#include "tests/projects/folder.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;
namespace fs = std::filesystem;

namespace {

fs::path kept(const Folder& folder) { return folder / "rays"; }
std::vector<fs::path> files(const Folder& folder) {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(kept(folder)))
        all.push_back(entry.path());
    return all;
}

Reference traced(double power = 2.0) {
    const Played scene = through(lookingAt(texture(kSmall, 7), 0.5, 0.5), power);
    return *Reference::of(scene.document, scene.plan, scene.program, lookingHere());
}
const std::vector<ViewPixel> kPixels{{40, 30}, {80, 60}, {100, 70}};

}  // namespace

TEST_CASE("reference cache: a result comes back to the last bit, and is read, not traced") {
    const Folder folder;
    const ReferencePixels first = *app::ReferenceCache(kept(folder)).pixels(traced(), kPixels, {64, 1});
    CHECK(first == *traced().pixels(kPixels, {64, 1}));
    const auto before = files(folder);
    REQUIRE(before.size() == 1);
    const auto written = fs::file_size(before[0]);
    CHECK(*app::ReferenceCache(kept(folder)).pixels(traced(), kPixels, {64, 1}) == first);

    const ReferencePicture picture = *app::ReferenceCache(kept(folder)).picture(traced(), {2, 1});
    const ReferencePicture again = *app::ReferenceCache(kept(folder)).picture(traced(), {2, 1});
    CHECK(again.radiance == picture.radiance);
    CHECK(again.noiseFloor_dB == picture.noiseFloor_dB);
    CHECK(files(folder).size() == 2);

    // A file that says something else, but is whole, is believed: that is how one sees that it is read.
    const ReferencePixels other = *app::ReferenceCache(kept(folder)).pixels(traced(1.0), kPixels, {64, 1});
    CHECK(other.radiance != first.radiance);
    for (const fs::path& path : files(folder)) {
        if (path != before[0] && fs::file_size(path) == written)
            fs::copy_file(path, before[0], fs::copy_options::overwrite_existing);
    }
    CHECK(*app::ReferenceCache(kept(folder)).pixels(traced(), kPixels, {64, 1}) == other);
}

TEST_CASE("reference cache: a damaged, cut or foreign file is traced again and put right") {
    const Folder folder;
    const app::ReferenceCache cache(kept(folder));
    const ReferencePixels right = *cache.pixels(traced(), kPixels, {64, 1});
    const fs::path file = files(folder).at(0);
    const auto size = fs::file_size(file);
    for (std::uintmax_t at = 0; at < size; at += 7) {
        {
            std::fstream flip(file, std::ios::in | std::ios::out | std::ios::binary);
            flip.seekg(static_cast<std::streamoff>(at));
            const int was = flip.get();
            flip.seekp(static_cast<std::streamoff>(at));
            flip.put(static_cast<char>(was ^ 16));
        }
        CHECK(*cache.pixels(traced(), kPixels, {64, 1}) == right);
    }
    for (const std::uintmax_t length : {std::uintmax_t{0}, std::uintmax_t{20}, size - 1}) {
        fs::resize_file(file, length);
        CHECK(*cache.pixels(traced(), kPixels, {64, 1}) == right);
        CHECK(fs::file_size(file) == size);
    }
}

TEST_CASE("reference cache: a folder that cannot be written to, and a request that is refused") {
    const Folder folder;
    std::ofstream(kept(folder)) << "a file where the folder should be";
    CHECK(app::ReferenceCache(kept(folder)).pixels(traced(), kPixels, {64, 1}));
    fs::remove(kept(folder));
    CHECK_FALSE(app::ReferenceCache(kept(folder)).picture(traced(), {1, 1}));
    CHECK_FALSE(fs::exists(kept(folder)));
}

TEST_CASE("reference cache: what was used least recently goes first") {
    const Folder folder;
    const app::ReferenceCache cache(kept(folder));
    CHECK(cache.pixels(traced(), kPixels, {2, 1}));
    const auto one = fs::file_size(files(folder).at(0));
    const fs::path oldest = files(folder).at(0);
    CHECK(cache.pixels(traced(), kPixels, {2, 2}));
    fs::last_write_time(oldest, fs::file_time_type::clock::now() - std::chrono::hours(1));
    CHECK(app::ReferenceCache(kept(folder), 2 * one).pixels(traced(), kPixels, {2, 3}));
    CHECK(files(folder).size() == 2);
    CHECK_FALSE(fs::exists(oldest));
}
