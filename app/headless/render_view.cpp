#include "app/headless/render_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/headless/render_error.h"
#include "app/pictures_of.h"
#include "app/reference_cache.h"
#include "core/base/srgb.h"
#include "core/perceived/reference.h"
#include "ilf/version.h"

namespace ilf::app {
namespace {

/// Of the reference's rays: the same every time.
constexpr unsigned kSeed = 1;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string sized(Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

projects::PictureFacts factsOf(const Compiled& compiled, const Shot& shot, const char* provenance) {
    return {{"shows", shot.view},
            {"provenance", provenance},
            {"project", compiled.document.name},
            {"software", std::string("illuminatedfocus ") + kVersion}};
}

/// What a view depends on besides the project.
void tell(projects::PictureFacts& facts, const Compiled& compiled, const ViewRequest& request,
          const RenderOptions& options) {
    facts.emplace_back("eye", request.eye == Eye::left ? "left" : "right");
    facts.emplace_back("gaze", options.gaze);
    if (request.attending) facts.emplace_back("attending", findRegion(compiled.document, *request.attending)->name);
    facts.emplace_back("chromatic", request.chromatic ? "yes" : "no");
    facts.emplace_back("lensField", request.lensField ? "yes" : "no");
    facts.emplace_back("scale", number(request.scale));
}

std::string spokenNoise(double floor_dB, int samples) {
    if (std::isinf(floor_dB)) return "nothing in the reference is drawn by chance";
    return "the reference's own noise is " + number(floor_dB) + " dB at " + std::to_string(samples) + " rays a pixel";
}

std::string spokenEye(const ViewRequest& request) { return request.eye == Eye::left ? "left eye" : "right eye"; }

Result<ReferencePicture> byRays(const Compiled& compiled, const ViewRequest& request, int samples) {
    return Reference::of(compiled.document, compiled.plan, compiled.program, request)
        .and_then([&](const Reference& reference) { return ReferenceCache().picture(reference, {samples, kSeed}); });
}

Result<Rendered> seen(const Compiled& compiled, const Shot& shot, const ViewRequest& request,
                      const RenderOptions& options) {
    Rendered result;
    result.facts = factsOf(compiled, shot, "simulated");
    tell(result.facts, compiled, request, options);
    result.spoken = "perceived, " + spokenEye(request) + ", ";
    if (options.reference) {
        auto rays = byRays(compiled, request, options.samples);
        if (!rays) return tl::unexpected(rays.error());
        result.spoken += "simulated by brute force";
        result.figures = spokenNoise(rays->noiseFloor_dB, options.samples);
        result.facts.emplace_back("samples", std::to_string(options.samples));
        result.facts.emplace_back("noiseFloor_dB", number(rays->noiseFloor_dB));
        result.pixels = projects::LightPicture{std::move(rays->radiance)};
        return result;
    }
    auto view = perceived(compiled.document, compiled.plan, compiled.program, request);
    if (!view) return tl::unexpected(view.error());
    result.facts.emplace_back("rung", options.rung);
    result.spoken += std::string(word(request.rung)) + ", simulated";
    result.pixels = projects::LightPicture{*std::move(view)};
    return result;
}

Result<Rendered> error(const Compiled& compiled, const Shot& shot, const ViewRequest& request,
                       const RenderOptions& options) {
    const auto view = perceived(compiled.document, compiled.plan, compiled.program, request);
    if (!view) return tl::unexpected(view.error());
    const auto rays = byRays(compiled, request, options.samples);
    if (!rays) return tl::unexpected(rays.error());
    const int reach = bandReach(compiled, request);
    ErrorMap map = errorMap(*view, rays->radiance, bordersOf(compiled, view->size(), reach));
    const ErrorFigures& figures = map.figures;
    const double white = options.white > 0.0 ? options.white : whiteFor(figures.worst);

    Rendered result;
    result.facts = factsOf(compiled, shot, "simulated");
    tell(result.facts, compiled, request, options);
    result.facts.emplace_back("rung", options.rung);
    result.facts.emplace_back("samples", std::to_string(options.samples));
    result.facts.emplace_back("white", number(white));
    result.facts.emplace_back("psnr_dB", number(figures.psnr_dB));
    result.facts.emplace_back("bandPsnr_dB", number(figures.bandPsnr_dB));
    result.facts.emplace_back("noiseFloor_dB", number(rays->noiseFloor_dB));
    result.spoken = "error, " + spokenEye(request) + ", " + std::string(word(request.rung)) + ", white is " +
                    number(white) + " of the brightest";
    result.figures = "PSNR " + spokenPsnr(figures.psnr_dB, rays->noiseFloor_dB) + "; " +
                     spokenPsnr(figures.bandPsnr_dB, rays->noiseFloor_dB) + " within " + std::to_string(reach) +
                     " pixels of a border; worst pixel " + number(figures.worst) + " at " +
                     std::to_string(figures.worstX) + "," + std::to_string(figures.worstY) + "; " +
                     spokenNoise(rays->noiseFloor_dB, options.samples);
    result.pixels = projects::DifferencePicture{std::move(map.difference), white};
    return result;
}

Result<Rendered> ofAnEye(const Compiled& compiled, const Shot& shot, const RenderOptions& options) {
    const auto request = requestOf(options, compiled.document, *shot.eye);
    if (!request) return tl::unexpected(request.error());
    return shot.view == "error" ? error(compiled, shot, *request, options) : seen(compiled, shot, *request, options);
}

}  // namespace

Result<Rendered> rendered(const Compiled& compiled, const Shot& shot, const RenderOptions& options) {
    const Document& document = compiled.document;
    Result<Rendered> result;
    if (shot.eye) {
        result = ofAnEye(compiled, shot, options);
    } else if (shot.slot) {
        result = Rendered{projects::CodePicture{toPicture(slotPicture(compiled.program, *shot.slot)), false},
                          factsOf(compiled, shot, "planned light"), "light of slot " + std::to_string(*shot.slot), ""};
        result->facts.emplace_back("slot", std::to_string(*shot.slot));
    } else if (shot.view == "plain") {
        result = Rendered{projects::LightPicture{plainView(document, options.scale)},
                          factsOf(compiled, shot, "simulated"), "plain view in steady light, simulated", ""};
    } else if (shot.view == "overlay") {
        result = Rendered{projects::CodePicture{toPicture(overlayPicture(document)), true},
                          factsOf(compiled, shot, "picture with marks"), "picture with the regions' marks", ""};
    } else {
        result = Rendered{projects::CodePicture{*document.scene.picture, true}, factsOf(compiled, shot, "picture"),
                          "picture", ""};
    }
    if (!result) return result;
    result->spoken += ", " + sized(projects::sizeOf(result->pixels));
    return result;
}

}  // namespace ilf::app
