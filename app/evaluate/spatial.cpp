// Four objects at three distances (paper, section 5.4) and seams (5.5), seen by rays through the pupil.
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/evaluate/evaluate.h"
#include "app/evaluate/observers.h"
#include "app/evaluate/scenes.h"
#include "core/base/srgb.h"
#include "core/perceived/perceived.h"

namespace ilf::app {
namespace {

constexpr unsigned kSeed = 1;

struct Placed {
    const char* name;
    Metre distance;
};
/// The paper's, side by side.
constexpr Placed kObjects[] = {{"A", 250.0_mm}, {"B", 500.0_mm}, {"C", 500.0_mm}, {"D", 1300.0_mm}};
constexpr int kObjectWidth = 80;

Result<FourObjects> condition(const char* words, bool onlyBBlurred, const EvaluateOptions& options) {
    const Size size{4 * kObjectWidth, options.quick ? 48 : 120};
    std::vector<Region> regions;
    for (std::size_t i = 0; i < std::size(kObjects); ++i) {
        const bool isB = i == 1;
        const double x = kObjectWidth * static_cast<double>(i);
        regions.push_back(strip(kObjects[i].name, size, x, x + kObjectWidth,
                                isB == onlyBBlurred ? Look::blur : Look::focus, kObjects[i].distance));
    }
    // A pixel is 1.1 arcmin; letters have strokes of two.
    Document document = scene(printedPage(size, 2, 11), 3000.0, std::move(regions), Look::neutral, 1500.0_mm);
    // One lens on the axis of the camera that stands in for the participant.
    document.wearer.axes = {LensAxis{}, LensAxis{}};
    const auto compiled = played(document);
    if (!compiled) return tl::unexpected(compiled.error());

    const Radiance plain = plainView(document, 1.0);
    FourObjects out{words, 0.0, compiled->plan.waveform.high.si(), {}, {}};
    if (compiled->plan.pS) out.pS_D = compiled->plan.pS->si();
    for (std::size_t i = 0; i < std::size(kObjects); ++i) {
        const auto seen = perceivedReference(document, compiled->plan, compiled->program,
                                             {Eye::left, kObjects[i].name, 1.0}, options.quick ? 24 : 64, kSeed);
        if (!seen) return tl::unexpected(seen.error());
        // The middle of the object: blurred and magnified neighbours reach over its borders.
        const int x = kObjectWidth * static_cast<int>(i), margin = 20;
        const double detail =
            detailLeft(*seen, plain, x + margin, margin / 2, x + kObjectWidth - margin, size.height - margin / 2);
        const bool toBlur = (i == 1) == onlyBBlurred;
        out.objects.push_back({kObjects[i].name, kObjects[i].distance.in(1.0_mm), toBlur, detail, detail < 0.5});
        if (!toBlur && out.picture.empty()) out.picture = toSrgb8(*seen);
    }
    return out;
}

/// Pixels for a millimetre of the surface at half a metre.
constexpr double kDotsPerMm = 4.0;
constexpr Metre kSurfaceAt = 500.0_mm;
/// From the optical centre to the border, as in the reference tables.
constexpr Metre kBorderFromCentre = 50.0_mm;

/// The paper's captures: a camera with the pupil of an eye behind one lens. It blurs the side it is told to, with light
/// at exactly `power`.
Result<Document> seamScene(const Picture& picture, bool blurredInside, Dioptre power, Blending blending) {
    const Size size = picture.size();
    const double middle = 0.5 * size.width;
    Document document = scene(picture, 0.0, {}, Look::focus, kSurfaceAt);
    // The optical centre lies to the left, so the left half is the inner one.
    document.regions.push_back(Box<Region>(strip("blurred", size, blurredInside ? 0.0 : middle,
                                                 blurredInside ? middle : size.width, Look::blur, kSurfaceAt)));
    document.wearer.camera = CameraObserver{16.0_mm, 4.0, kSurfaceAt, 8.4_um};
    document.wearer.axes = {LensAxis{-kBorderFromCentre, 0.0_m}, LensAxis{-kBorderFromCentre, 0.0_m}};
    document.scene.scale.focalPixels = 1e3 * kDotsPerMm * (kSurfaceAt + document.wearer.lensToPupil).si();
    document.seam.blending = blending;
    const auto least = minimumBlurPower(eyeOptics(document.wearer), kSurfaceAt);
    if (!least) return tl::unexpected(least.error());
    document.alpha = power - *least;
    return document;
}

struct SeamSeen {
    double weber = 0.0;
    Image<std::uint8_t> picture;
};

Result<SeamSeen> seamSeen(const Picture& picture, bool blurredInside, Dioptre power, Blending blending, int rays) {
    const auto document = seamScene(picture, blurredInside, power, blending);
    if (!document) return tl::unexpected(document.error());
    const auto compiled = played(*document);
    if (!compiled) return tl::unexpected(compiled.error());
    const auto seen =
        perceivedReference(*document, compiled->plan, compiled->program, {Eye::left, {}, 1.0}, rays, kSeed);
    if (!seen) return tl::unexpected(seen.error());
    constexpr int kWindow = 5;  // half a letter
    const auto profile = lightAcross(*seen, plainView(*document, 1.0), kWindow);
    const int border = picture.width() / 2, reach = static_cast<int>(10.0 * kDotsPerMm);
    return SeamSeen{weberAt(profile, border, reach), toSrgb8(*seen)};
}

}  // namespace

Result<std::vector<FourObjects>> fourObjects(const EvaluateOptions& options) {
    std::vector<FourObjects> out;
    for (const bool onlyBBlurred : {true, false}) {
        auto one = condition(onlyBBlurred ? "only B blurred" : "only B focused", onlyBBlurred, options);
        if (!one) return tl::unexpected(one.error());
        out.push_back(*std::move(one));
    }
    return out;
}

Result<std::vector<SeamCase>> seams(const EvaluateOptions& options) {
    const Size size{360, options.quick ? 80 : 240};
    const int rays = options.quick ? 32 : 96;
    std::vector<SeamCase> out;
    const std::pair<const char*, Picture> textures[] = {
        {"document", printedPage(size, 2, 5)}, {"picture", painting(size, 3)}, {"white sheet", whiteSheet(size)}};
    for (const auto& [texture, picture] : textures) {
        for (const bool inside : {true, false}) {
            for (const double power : {1.0, 2.0}) {
                SeamCase one{texture, inside, power, 0.0, 0.0, 0.0, {}, {}, {}};
                const auto look = [&](Blending blending) {
                    return seamSeen(picture, inside, Dioptre::fromSi(power), blending, rays);
                };
                auto before = look(Blending::none), paper = look(Blending::linearObject),
                     after = look(Blending::closedForm);
                for (const auto* seen : {&before, &paper, &after}) {
                    if (!*seen) return tl::unexpected(seen->error());
                }
                one.before = before->weber;
                one.paper = paper->weber;
                one.after = after->weber;
                one.beforePicture = std::move(before->picture);
                one.paperPicture = std::move(paper->picture);
                one.afterPicture = std::move(after->picture);
                out.push_back(std::move(one));
            }
        }
    }
    return out;
}

}  // namespace ilf::app
