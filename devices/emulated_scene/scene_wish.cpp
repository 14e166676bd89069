#include "devices/emulated_scene/scene_wish.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <functional>
#include <map>
#include <system_error>

#include "core/base/as_text.h"
#include "devices/emulated_scene/built_in.h"
#include "devices/emulated_scene/moving_marker.h"

namespace ilf::devices {
namespace {

constexpr const char* kWords =
    "scene, scale, board, binning, roi, ambient, delay, bump, turn, hand, marker, lap, cover, saturated, dark, "
    "wrong-screen, frozen, after, quiet and seed";

bool number(std::string_view text, double low, double high, double& out) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high)) return false;
    out = value;
    return true;
}

bool whole(std::string_view text, int low, int high, int& out) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < low || value > high) return false;
    out = value;
    return true;
}

/// X:Y:WIDTH:HEIGHT inside the sensor.
bool region(std::string_view text, SceneWish& wish) {
    const Size sensor = scene::builtInCamera().size;
    int* const parts[] = {&wish.roiX, &wish.roiY, &wish.roi.width, &wish.roi.height};
    for (int i = 0; i < 4; ++i) {
        const auto colon = text.find(':');
        if ((colon == std::string_view::npos) != (i == 3)) return false;
        if (!whole(text.substr(0, colon), i < 2 ? 0 : 64, 10000, *parts[i])) return false;
        text.remove_prefix(i == 3 ? text.size() : colon + 1);
    }
    return wish.roiX + wish.roi.width <= sensor.width && wish.roiY + wish.roi.height <= sensor.height;
}

/// As it is, or in double quotes. One line holds a whole wish, and a quote ends a name.
bool fileName(std::string_view text, std::string& name) {
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    if (text.empty() || text.find_first_of("\"\n") != std::string_view::npos) return false;
    name = text;
    return true;
}

/// Takes the first word off; commas between double quotes separate nothing.
std::string_view nextWord(std::string_view& words) {
    bool quoted = false;
    std::size_t end = 0;
    for (; end < words.size() && (quoted || words[end] != ','); ++end)
        quoted = quoted != (words[end] == '"');
    const auto word = words.substr(0, end);
    words.remove_prefix(std::min(words.size(), end + 1));
    return word;
}

bool took(SceneWish& wish, std::string_view name, std::string_view value) {
    const std::map<std::string_view, bool*> flags{{"hand", &wish.hand},     {"saturated", &wish.saturated},
                                                  {"dark", &wish.dark},     {"wrong-screen", &wish.wrongScreen},
                                                  {"frozen", &wish.frozen}, {"quiet", &wish.quiet}};
    if (const auto flag = flags.find(name); flag != flags.end()) return *flag->second = value.empty();
    if (name == "scene") return fileName(value, wish.scene);
    if (name == "scale") return number(value, 1e-6, 1e6, wish.scale);
    if (name == "board") return whole(value, 0, scene::kBoardPoses, wish.board);
    if (name == "binning") return whole(value, 1, 8, wish.binning);
    if (name == "roi") return region(value, wish);
    if (name == "ambient") return number(value, 0.0, 100000.0, wish.ambientLux);
    if (name == "marker") return whole(value, 0, scene::kMarkers - 1, wish.marker);
    if (name == "lap") return number(value, 0.0, 3600.0, wish.lap_s);
    if (name == "cover") {
        const auto colon = value.find(':');
        return colon != std::string_view::npos && number(value.substr(0, colon), 0.0, 1e6, wish.coveredFrom_s) &&
               number(value.substr(colon + 1), wish.coveredFrom_s, 1e6, wish.coveredTo_s);
    }
    if (name == "delay") return whole(value, 0, 30, wish.delay);
    if (name == "bump") return number(value, -1000.0, 1000.0, wish.bump_mm);
    if (name == "turn") return number(value, -90.0, 90.0, wish.turn_deg);
    if (name == "after") return whole(value, 0, 1000000, wish.after);
    if (name == "seed") return whole(value, 0, 1000000000, wish.seed);
    return false;
}

}  // namespace

Result<SceneWish> sceneWishFrom(std::string_view words) {
    SceneWish wish;
    while (!words.empty()) {
        const std::string_view word = nextWord(words);
        const auto equals = word.find('=');
        const auto value = equals == std::string_view::npos ? std::string_view() : word.substr(equals + 1);
        if (!took(wish, word.substr(0, equals), value)) {
            return fail(Fault::outOfRange, "The emulated scene does not know \"" + std::string(word) +
                                               "\", or not this number. Its words are " + kWords + ".");
        }
    }
    return wish;
}

std::string wordsOf(const SceneWish& wish) {
    const SceneWish usual;
    std::string words;
    const auto add = [&](const std::string& word) { words += (words.empty() ? "" : ",") + word; };
    const auto addNumber = [&](const char* name, double value, double usually) {
        if (value != usually) add(name + asText("=%.17g", value));
    };
    if (!wish.scene.empty()) {
        const bool plain = wish.scene.find(',') == std::string::npos;
        add("scene=" + (plain ? wish.scene : '"' + wish.scene + '"'));
    }
    addNumber("scale", wish.scale, usual.scale);
    addNumber("board", wish.board, usual.board);
    addNumber("binning", wish.binning, usual.binning);
    if (wish.roi != Size{})
        add("roi=" + std::to_string(wish.roiX) + ":" + std::to_string(wish.roiY) + ":" +
            std::to_string(wish.roi.width) + ":" + std::to_string(wish.roi.height));
    addNumber("ambient", wish.ambientLux, usual.ambientLux);
    addNumber("delay", wish.delay, usual.delay);
    addNumber("bump", wish.bump_mm, usual.bump_mm);
    addNumber("turn", wish.turn_deg, usual.turn_deg);
    if (wish.hand) add("hand");
    addNumber("marker", wish.marker, usual.marker);
    addNumber("lap", wish.lap_s, usual.lap_s);
    if (wish.coveredTo_s > wish.coveredFrom_s)
        add("cover=" + asText("%.17g", wish.coveredFrom_s) + ":" + asText("%.17g", wish.coveredTo_s));
    if (wish.saturated) add("saturated");
    if (wish.dark) add("dark");
    if (wish.wrongScreen) add("wrong-screen");
    if (wish.frozen) add("frozen");
    addNumber("after", wish.after, usual.after);
    if (wish.quiet) add("quiet");
    addNumber("seed", wish.seed, usual.seed);
    return words;
}

std::filesystem::path sceneWishFile(const std::filesystem::path& runtimeDirectory) {
    return runtimeDirectory / "emulated-camera";
}

Result<void> saveSceneWish(const std::filesystem::path& runtimeDirectory, const SceneWish& wish) {
    const auto wanted = sceneWishFile(runtimeDirectory);
    auto beside = wanted;
    beside += ".new";
    std::ofstream file(beside, std::ios::trunc);
    SceneWish wished = wish;  // who reads it may have been started in another folder
    if (!wish.scene.empty()) wished.scene = std::filesystem::absolute(wish.scene).string();
    file << wordsOf(wished) << '\n';
    file.close();
    std::error_code error;
    if (file) std::filesystem::rename(beside, wanted, error);
    if (!file || error)
        return fail(Fault::cannotWrite, "What the emulated camera shall see could not be written to " +
                                            wanted.string() + "; does the directory exist?");
    return {};
}

Result<std::optional<SceneWish>> savedSceneWish(const std::filesystem::path& runtimeDirectory) {
    std::ifstream file(sceneWishFile(runtimeDirectory));
    if (!file) return std::nullopt;
    std::string words;
    std::getline(file, words);
    return sceneWishFrom(words).map([](const SceneWish& wish) { return std::optional(wish); });
}

}  // namespace ilf::devices
