#include "app/headless/render_shots.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/words.h"

namespace ilf::app {
namespace {

constexpr std::string_view kSlot = "slot:";

std::string word(Eye eye) { return eye == Eye::left ? "left" : "right"; }

std::string twoDigits(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

bool ofAnEye(const std::string& view) { return view == "perceived" || view == "error"; }

/// What tells a shot from others of the same view.
std::string part(const Shot& shot) {
    return shot.eye ? word(*shot.eye) : shot.slot ? twoDigits(*shot.slot) : std::string();
}

Result<RegionId> regionOf(const Document& document, const std::string& asked) {
    std::vector<const Region*> all;
    for (const auto& region : document.regions)
        all.push_back(&*region);
    all.push_back(&*document.background);
    for (const Region* region : all) {
        if (region->id == asked) return region->id;
    }
    std::erase_if(all, [&](const Region* region) { return region->name != asked; });
    if (all.size() == 1) return all.front()->id;
    if (all.size() > 1) {
        return fail(Fault::outOfRange, "there are " + std::to_string(all.size()) + " regions called \"" + asked +
                                           "\": name the one to attend by its id, as in project.json.");
    }
    std::string names;
    for (const auto& region : document.regions)
        names += "\"" + region->name + "\", ";
    return fail(Fault::outOfRange, "there is no region \"" + asked + "\" to attend: use " + names + "or \"" +
                                       document.background->name + "\".");
}

Result<void> look(ViewRequest& request, const std::string& gaze, Size picture) {
    if (gaze == "ahead") return {};
    if (gaze == "follows") {
        request.gaze = Gaze::follows;
        return {};
    }
    const auto comma = gaze.find(',');
    const auto x = wholeNumber(gaze.substr(0, comma));
    const auto y = comma == std::string::npos ? std::nullopt : wholeNumber(gaze.substr(comma + 1));
    if (x && y && *x >= 0.0 && *y >= 0.0 && *x <= picture.width && *y <= picture.height) {
        request.gaze = Gaze::fixed;
        request.gazeAt = {*x, *y};
        return {};
    }
    return fail(Fault::outOfRange, "--gaze \"" + gaze +
                                       "\" is no gaze: use ahead, follows, or a point of the picture "
                                       "such as " +
                                       std::to_string(picture.width / 2) + "," + std::to_string(picture.height / 2) +
                                       " (it has " + std::to_string(picture.width) + "x" +
                                       std::to_string(picture.height) + " pixels).");
}

}  // namespace

Result<void> checkedViews(const std::vector<std::string>& views) {
    const std::vector<std::string> known{"perceived", "error", "plain", "camera", "overlay", "slots"};
    for (const std::string& view : views) {
        if (std::find(known.begin(), known.end(), view) != known.end() || view.starts_with(kSlot)) continue;
        return fail(Fault::outOfRange, "\"" + view +
                                           "\" is no view: use perceived, error, plain, camera, overlay, "
                                           "slots or slot:N.");
    }
    return {};
}

Result<std::vector<Shot>> shotsOf(const RenderOptions& options, int slots) {
    std::vector<Shot> shots;
    for (const std::string& view : options.views) {
        if (ofAnEye(view)) {
            if (options.eye != "right") shots.push_back({view, Eye::left, {}});
            if (options.eye != "left") shots.push_back({view, Eye::right, {}});
        } else if (view == "slots") {
            for (int slot = 0; slot < slots; ++slot)
                shots.push_back({"slot", {}, slot});
        } else if (view.starts_with(kSlot)) {
            const auto number = wholeNumber(view.substr(kSlot.size()));
            if (!number || !(*number >= 0.0 && *number < slots) || *number != std::floor(*number)) {
                return fail(Fault::outOfRange, "there is no \"" + view + "\": the sweep has slots 0 to " +
                                                   std::to_string(slots - 1) + ".");
            }
            shots.push_back({"slot", {}, static_cast<int>(*number)});
        } else {
            shots.push_back({view, {}, {}});
        }
    }
    std::vector<Shot> once;  // a view asked for twice is one picture
    for (const Shot& shot : shots) {
        if (std::find(once.begin(), once.end(), shot) == once.end()) once.push_back(shot);
    }
    return once;
}

std::string nameOf(const Shot& shot) {
    const std::string rest = part(shot);
    return rest.empty() ? shot.view : shot.view + "-" + rest;
}

std::vector<std::string> filesFor(const std::string& out, const std::vector<Shot>& shots) {
    if (shots.size() == 1) return {out};
    const bool oneView =
        std::all_of(shots.begin(), shots.end(), [&](const Shot& s) { return s.view == shots[0].view; });
    const std::filesystem::path path(out);
    std::vector<std::string> files;
    for (const Shot& shot : shots) {
        const std::string name =
            path.stem().string() + "-" + (oneView ? part(shot) : nameOf(shot)) + path.extension().string();
        files.push_back((path.parent_path() / name).string());
    }
    return files;
}

Result<ViewRequest> requestOf(const RenderOptions& options, const Document& document, Eye eye) {
    ViewRequest request;
    request.eye = eye;
    request.rung = options.rung == "dragging" ? Rung::dragging : options.rung == "idle" ? Rung::idle : Rung::rest;
    request.scale = options.scale;
    request.chromatic = options.chromatic;
    request.lensField = options.lensField;
    if (!options.attend.empty()) {
        const auto region = regionOf(document, options.attend);
        if (!region) return tl::unexpected(region.error());
        request.attending = *region;
    }
    if (auto looked = look(request, options.gaze, document.scene.size()); !looked) {
        return tl::unexpected(looked.error());
    }
    return request;
}

}  // namespace ilf::app
