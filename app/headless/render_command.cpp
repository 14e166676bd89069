#include "app/headless/render_command.h"

#include <iostream>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/pictures_of.h"
#include "app/words.h"
#include "core/base/srgb.h"
#include "core/perceived/perceived.h"
#include "projects/pictures.h"

namespace ilf::app {
namespace {

constexpr const char* kViews = "camera, perceived, slot:N or overlay";

Result<Image<std::uint8_t>> perceivedPicture(const Compiled& compiled, const RenderOptions& options) {
    ViewRequest request;
    request.eye = options.eye == "right" ? Eye::right : Eye::left;
    constexpr unsigned kSeed = 1;
    const auto view = options.reference ? perceivedReference(compiled.document, compiled.plan, compiled.program,
                                                             request, options.samples, kSeed)
                                        : perceived(compiled.document, compiled.plan, compiled.program, request);
    if (!view) return tl::unexpected(view.error());
    return toSrgb8(*view);
}

Result<Image<std::uint8_t>> pictureOf(const Compiled& compiled, const RenderOptions& options) {
    if (options.view == "camera") return scenePicture(compiled.document);
    if (options.view == "overlay") return overlayPicture(compiled.document);
    if (options.view == "perceived") return perceivedPicture(compiled, options);
    const std::string prefix = "slot:";
    if (options.view.starts_with(prefix)) {
        const auto number = wholeNumber(options.view.substr(prefix.size()));
        const auto slots = compiled.program.imageOfSlot.size();
        if (number && *number >= 0.0 && *number < static_cast<double>(slots) && *number == std::floor(*number)) {
            return slotPicture(compiled.program, static_cast<int>(*number));
        }
        return fail(Fault::outOfRange, "there is no \"" + options.view + "\": the sweep has slots 0 to " +
                                           std::to_string(slots - 1) + ".");
    }
    return fail(Fault::outOfRange, "\"" + options.view + "\" is no view: use " + kViews + ".");
}

bool knownView(const std::string& view) {
    return view == "camera" || view == "overlay" || view == "perceived" || view.starts_with("slot:");
}

}  // namespace

int renderCommand(const RenderOptions& options) {
    if (!knownView(options.view)) {
        std::cerr << "illuminatedfocus render: \"" << options.view << "\" is no view: use " << kViews << ".\n";
        return kUsage;
    }
    const auto project = prepared(options.file, options.lens);
    if (!project) return refused("render", project.error());
    const auto picture = pictureOf(project->compiled, options);
    if (!picture) {
        const int code = refused("render", picture.error());
        return picture.error().fault == Fault::outOfRange ? kUsage : code;  // a slot that does not exist
    }
    if (const auto written = projects::writePng(options.out, *picture); !written)
        return refused("render", written.error());
    std::cout << options.out << ": " << options.view
              << (options.view == "perceived" ? ", " + options.eye + " eye, simulated" : "")
              << (options.reference && options.view == "perceived" ? " by brute force" : "") << ", " << picture->width()
              << "x" << picture->height() << '\n';
    return kDone;
}

}  // namespace ilf::app
