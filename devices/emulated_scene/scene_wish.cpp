#include "devices/emulated_scene/scene_wish.h"

#include <charconv>
#include <fstream>
#include <functional>
#include <map>
#include <system_error>

#include "core/base/as_text.h"
#include "devices/emulated_scene/built_in.h"

namespace ilf::devices {
namespace {

constexpr const char* kWords = "board, binning, roi, ambient, delay, bump, turn, hand, saturated, dark, wrong-screen, "
                               "frozen, after, quiet and seed";

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

bool took(SceneWish& wish, std::string_view name, std::string_view value) {
    const std::map<std::string_view, bool*> flags{{"hand", &wish.hand},     {"saturated", &wish.saturated},
                                                  {"dark", &wish.dark},     {"wrong-screen", &wish.wrongScreen},
                                                  {"frozen", &wish.frozen}, {"quiet", &wish.quiet}};
    if (const auto flag = flags.find(name); flag != flags.end()) return *flag->second = value.empty();
    if (name == "board") return whole(value, 0, scene::kBoardPoses, wish.board);
    if (name == "binning") return whole(value, 1, 8, wish.binning);
    if (name == "roi") return region(value, wish);
    if (name == "ambient") return number(value, 0.0, 100000.0, wish.ambientLux);
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
        const auto comma = words.find(',');
        const std::string_view word = words.substr(0, comma);
        words.remove_prefix(comma == std::string_view::npos ? words.size() : comma + 1);
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
    file << wordsOf(wish) << '\n';
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
