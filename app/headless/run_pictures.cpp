#include "app/headless/run_pictures.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/headless/received_view.h"
#include "app/pictures_of.h"
#include "core/base/srgb.h"
#include "core/perceived/view_engine.h"
#include "projects/pictures.h"

namespace ilf::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What a view took, and why the rest of it was not worked out.
json countersOf(Eye eye, const PerceivedView& view) {
    const ViewCounters& c = view.counters;
    return {{"eye", eye == Eye::left ? "left" : "right"},
            {"rung", std::string(word(view.rung))},
            {"tiles", c.tiles},
            {"computed", c.computed},
            {"skipped", {{"unchanged", c.unchanged}, {"plain", c.plain}, {"dark", c.dark}}},
            {"lights", c.lights},
            {"dark_levels", c.darkLights},
            {"surfaces", {{"blurred", c.blurred}, {"sharp", c.sharp}, {"unlit", c.unlit}, {"hidden", c.hidden}}},
            {"conflict_tiles", c.conflicts},
            {"times_ms", {{"geometry", c.geometry_ms}, {"light", c.light_ms}, {"tiles", c.tiles_ms}}}};
}

/// JSON knows no infinity.
json decibels(double psnr) { return std::isfinite(psnr) ? json(std::round(100.0 * psnr) / 100.0) : json(); }

class Pictures {
public:
    explicit Pictures(fs::path directory) : directory_(std::move(directory)) {}

    /// After the first that cannot be written, none is.
    void write(const std::string& name, const Image<std::uint8_t>& picture) {
        if (!done_) return;
        done_ = projects::writePng(directory_ / name, picture);
        if (done_) all_.names.push_back((directory_ / name).string());
    }
    Result<WrittenPictures> written() && {
        if (!done_) return tl::unexpected(done_.error());
        return std::move(all_);
    }

private:
    fs::path directory_;
    Result<void> done_;
    WrittenPictures all_;
};

Result<void> writeEye(const Compiled& compiled, const ReceivedSweep* sweep, Eye eye, Pictures& pictures, json& views) {
    ViewRequest request;
    request.eye = eye;
    const std::string side = eye == Eye::left ? "left.png" : "right.png";
    const auto view = ViewEngine().see(compiled.document, compiled.plan, compiled.program, request);
    if (!view) return tl::unexpected(view.error());
    views.push_back(countersOf(eye, *view));
    const Radiance intended = view->radiance();
    pictures.write("perceived-" + side, toSrgb8(intended));
    if (sweep == nullptr) return {};
    const auto show = receivedShow(compiled, *sweep, eye);
    if (!show) return tl::unexpected(show.error());
    const auto seen = ViewEngine().see(compiled.document, show->plan, show->program, request);
    if (!seen) return tl::unexpected(seen.error());
    json counters = countersOf(eye, *seen);
    counters["of"] = "received light and lens power";
    counters["psnr_against_intended_dB"] = decibels(psnr(intended, seen->radiance()));
    views.push_back(std::move(counters));
    pictures.write("perceived-received-" + side, toSrgb8(seen->radiance()));
    return {};
}

}  // namespace

Result<WrittenPictures> writePictures(const Compiled& compiled, const ReceivedSweep* sweep, const fs::path& directory,
                                      json& views) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error) {
        return fail(Fault::cannotWrite,
                    "The directory " + directory.string() + " can not be made: " + error.message() + ".");
    }
    Pictures pictures(directory);
    pictures.write("camera.png", scenePicture(compiled.document));
    pictures.write("overlay.png", overlayPicture(compiled.document));
    views = json::array();
    for (const Eye eye : {Eye::left, Eye::right}) {
        if (const auto done = writeEye(compiled, sweep, eye, pictures, views); !done)
            return tl::unexpected(done.error());
    }
    const auto numbered = [](std::size_t slot) {
        return "slot-" + std::string(slot < 10 ? "0" : "") + std::to_string(slot);
    };
    for (std::size_t slot = 0; slot < compiled.program.imageOfSlot.size(); ++slot)
        pictures.write(numbered(slot) + ".png", slotPicture(compiled.program, static_cast<int>(slot)));
    if (sweep != nullptr) {
        const auto slots = receivedSlots(*sweep);
        for (std::size_t slot = 0; slot < slots.size(); ++slot)
            if (!slots[slot].light.empty()) pictures.write(numbered(slot) + "-received.png", slots[slot].light);
    }
    return std::move(pictures).written();
}

}  // namespace ilf::app
