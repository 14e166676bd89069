// Depth as it was measured and where the wearer stands: what is typed or read is checked, and the distances follow.
#include <algorithm>
#include <cmath>

#include "core/document/edit_parts.h"
#include "core/document/wearer_distances.h"

namespace ilf {

namespace {

constexpr Metre kFarthestViewer = 100.0_m;

std::string spoken(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

bool anyDistance(const DepthMap& depth) {
    return std::ranges::any_of(depth.metres.pixels(), [](float metres) { return metres > 0.0F; });
}

bool isRotation(const std::array<double, 9>& r) {
    double worst = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double product = r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2];
            worst = std::max(worst, std::abs(product - (i == j ? 1.0 : 0.0)));
        }
    }
    const double determinant =
        r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) + r[2] * (r[3] * r[7] - r[4] * r[6]);
    return worst < 1e-6 && determinant > 0.0;  // false for NaN, too
}

Result<void> checkedDepth(const MeasuredDepth& measured, Size picture) {
    if (measured.metres.size() != picture || measured.metres.channels() != 1) {
        return fail(Fault::outOfRange, "The depth map has " + spoken(measured.metres.size()) +
                                           " pixels and the picture " + spoken(picture) + ": they must agree.");
    }
    if (!measured.sigma.empty() && measured.sigma.size() != picture) {
        return fail(Fault::outOfRange, "The uncertainty of the depth map has " + spoken(measured.sigma.size()) +
                                           " pixels and the picture " + spoken(picture) + ": they must agree.");
    }
    const Pinhole& camera = measured.camera;
    const bool sane = std::isfinite(camera.fx) && std::isfinite(camera.fy) && camera.fx > 0.0 && camera.fy > 0.0 &&
                      std::isfinite(camera.cx) && std::isfinite(camera.cy) &&
                      std::ranges::all_of(camera.distortion, [](double d) { return std::isfinite(d); });
    if (!sane || camera.size != picture) {
        return fail(Fault::outOfRange, "The camera of the depth map needs focal lengths of more than 0 px and a "
                                       "picture of " +
                                           spoken(picture) + " pixels: give its intrinsics again.");
    }
    const auto possible = [](float v) { return std::isfinite(v) && v >= 0.0F; };
    if (!std::ranges::all_of(measured.metres.pixels(), possible) ||
        !std::ranges::all_of(measured.sigma.pixels(), possible)) {
        return fail(Fault::outOfRange, "The depth map holds values that are no distances (negative or not finite): "
                                       "holes are 0.");
    }
    if (!isFinite(measured.step) || measured.step < 0.0_m || measured.step > 1.0_m) {
        return fail(Fault::outOfRange,
                    "One unit of the depth map must be at most 1 m, not " + spokenNumber(measured.step.si()) + " m.");
    }
    return {};
}

}  // namespace

Result<void> checked(const ViewerPose& viewer) {
    const auto& t = viewer.viewerFromCamera.translation;
    const bool near = std::ranges::all_of(t, [](double v) { return std::abs(v) <= kFarthestViewer.si(); });
    if (!near || !isRotation(viewer.viewerFromCamera.rotation)) {
        return fail(Fault::outOfRange, "The wearer's place must be within 100 m of the camera, and their view a "
                                       "direction: type both again.");
    }
    return inRange("the uncertainty of the wearer's place", viewer.sigma.si(), 0.0, 1.0, "m");
}

Result<DepthMap> distancesFrom(const MeasuredDepth& measured, const ViewerPose& viewer, const Wearer& wearer) {
    DepthMap depth = wearerDistances(measured, viewer, wearer);
    if (anyDistance(depth)) return depth;
    if (std::ranges::none_of(measured.metres.pixels(), [](float metres) { return metres > 0.0F; })) {
        return fail(Fault::outOfRange, "The depth map holds only holes: choose another file, or scan again.");
    }
    return fail(Fault::outOfRange, "Nothing of the depth map is in front of the wearer's lens there: move them away "
                                   "from what was measured, or turn them towards it.");
}

Result<Document> withMeasured(Document document, const SetMeasuredDepth& e) {
    if (!e.measured) {
        std::vector<const Region*> all{document.background ? &*document.background : nullptr};
        for (const Box<Region>& region : document.regions)
            all.push_back(&*region);
        for (const Region* region : all) {
            if (region == nullptr || !std::holds_alternative<FromDepthMap>(region->distance)) continue;
            return fail(Fault::outOfRange, "\"" + region->name +
                                               "\" reads its distance from the depth map: give it "
                                               "another distance before the map goes.");
        }
        document.scene.measured = {};
        document.scene.depth = {};
        return document;
    }
    if (auto ok = checkedDepth(*e.measured, document.scene.size()); !ok) return tl::unexpected(ok.error());
    auto depth = distancesFrom(*e.measured, document.scene.viewer, document.wearer);
    if (!depth) return tl::unexpected(depth.error());
    document.scene.measured = e.measured;
    document.scene.depth = Box(*std::move(depth));
    return document;
}

Result<Document> withViewer(Document document, const SetViewerPose& e) {
    if (auto ok = checked(e.viewer); !ok) return tl::unexpected(ok.error());
    if (document.scene.viewer == e.viewer) return document;
    document.scene.viewer = e.viewer;
    return withDistancesAnew(std::move(document));
}

Result<Document> withDistancesAnew(Document document) {
    if (!document.scene.measured) return document;
    auto depth = distancesFrom(*document.scene.measured, document.scene.viewer, document.wearer);
    if (!depth) return tl::unexpected(depth.error());
    document.scene.depth = Box(*std::move(depth));
    return document;
}

Result<Document> withPixelScale(Document document, const SetPixelScale& e) {
    const Size size = document.scene.size();
    if (auto ok = checked(e.scale, size); !ok) return tl::unexpected(ok.error());
    const double before = document.scene.scale.focalPixels;
    document.scene.scale = e.scale;
    if (!document.scene.measured) return document;
    MeasuredDepth measured = *document.scene.measured;
    // A camera that was only guessed from the field of view follows it; of a part of a sensor its axis may lie aside.
    const Pinhole guess{size, before, before, measured.camera.cx, measured.camera.cy, {}};
    if (measured.camera != guess) return document;
    measured.camera.fx = measured.camera.fy = e.scale.focalPixels;
    document.scene.measured = Box(std::move(measured));
    return withDistancesAnew(std::move(document));
}

Result<Document> withDepthScale(Document document, const SetDepthScale& e) {
    Scene& scene = document.scene;
    if (!scene.depth) {
        return fail(Fault::notFound, "The scene has no depth map: load one before setting its scale.");
    }
    if (!isFinite(e.metresPerUnit) || e.metresPerUnit < 1.0_um || e.metresPerUnit > 1.0_m) {
        return fail(Fault::outOfRange, "A step of the depth map must be 1 \u00b5m to 1 m.");
    }
    const Metre step = scene.measured ? scene.measured->step : scene.depth->step;
    if (!(step > 0.0_m)) {
        return fail(Fault::outOfRange, "This depth map is in metres already: it has no steps to give a length.");
    }
    if (step == e.metresPerUnit) return document;
    const double factor = e.metresPerUnit / step;
    const auto scaled = [&](const Image<float>& from) {
        if (from.empty()) return from;
        std::vector<float> to;
        to.reserve(from.pixels().size());
        for (const float metres : from.pixels()) {
            // By way of the whole number, so that going there and back changes nothing.
            const double steps = static_cast<double>(metres) / step.si(), whole = std::round(steps);
            to.push_back(std::abs(steps - whole) < 1e-3 ? static_cast<float>(whole * e.metresPerUnit.si())
                                                        : static_cast<float>(static_cast<double>(metres) * factor));
        }
        return Image<float>(from.size(), 1, std::move(to));
    };
    if (!scene.measured) {
        scene.depth = Box(DepthMap{scaled(scene.depth->metres), scaled(scene.depth->sigma), e.metresPerUnit});
        return document;
    }
    MeasuredDepth measured = *scene.measured;
    measured.metres = scaled(measured.metres);
    measured.sigma = scaled(measured.sigma);
    measured.step = e.metresPerUnit;
    return withMeasured(std::move(document), {Box(std::move(measured))});
}

Result<void> checkedDepth(const Scene& scene) {
    if (auto ok = checked(scene.viewer); !ok) return ok;
    if (scene.measured) {
        if (auto ok = checkedDepth(*scene.measured, scene.size()); !ok) return ok;
    }
    if (!scene.depth) return {};
    if (scene.depth->metres.size() != scene.size() || scene.depth->metres.channels() != 1) {
        return fail(Fault::outOfRange, "The depth map has " + spoken(scene.depth->metres.size()) +
                                           " pixels and the picture " + spoken(scene.size()) + ": they must agree.");
    }
    const Metre step = scene.depth->step;
    if (!isFinite(step) || step < 0.0_m || step > 1.0_m) {
        return fail(Fault::outOfRange, "One unit of the depth map must be more than 0 and at most 1 m, not " +
                                           spokenNumber(step.si()) + " m.");
    }
    return {};
}

}  // namespace ilf
