// Another picture beneath the regions: what was drawn on the old one goes along.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/document/edit_parts.h"
#include "core/document/picture_change.h"

namespace ilf {

namespace {

constexpr double kMostPixels = 100e6;

using Change = Homography<CameraFrame, CameraFrame>;

/// The part of the new picture that shows what `patch` did in the old one.
PixelRect<CameraFrame> alongWith(const PixelRect<CameraFrame>& patch, const Change& newFromOld, Size picture) {
    const auto first = newFromOld(Point<CameraFrame>{1.0 * patch.x0, 1.0 * patch.y0});
    const auto last = newFromOld(Point<CameraFrame>{1.0 * patch.x1, 1.0 * patch.y1});
    const auto whole = [](double v) { return static_cast<int>(std::lround(v)); };
    return PixelRect<CameraFrame>{whole(first.x), whole(first.y), whole(last.x), whole(last.y)}.clipped(picture);
}

/// The region where its things are in a picture of `to` pixels.
Result<Region> goneAlong(Region region, const Change& oldFromNew, Size to) {
    const Change newFromOld = oldFromNew.inverted();
    if (auto* plane = std::get_if<PlaneDistance>(&region.distance)) {
        for (DistanceAnchor& anchor : plane->anchors)
            anchor.at = newFromOld(anchor.at);
    }
    if (region.outline) {
        for (Point<CameraFrame>& p : region.outline->vertices)
            p = newFromOld(p);
    }
    if (region.follow) {
        if (auto* flat = std::get_if<PlanarTarget>(&region.follow->target)) {
            flat->patch = alongWith(flat->patch, newFromOld, to);
            if (!checked(*region.follow, to)) {
                return fail(Fault::outOfRange, "What \"" + region.name +
                                                   "\" follows is not in this picture, or too small in it: let it "
                                                   "follow nothing first, or take a picture that shows it.");
            }
        }
    }
    if (region.id == kBackgroundId) return region;
    region.mask = region.outline ? rasterised(*region.outline, to) : resampled(region.mask, oldFromNew, to);
    return region;
}

}  // namespace

Result<void> checked(const PixelScale& scale, Size picture) {
    constexpr double kNarrowest = 0.5, kWidest = 175.0;  // degrees
    const double across = fieldOfView(picture.width, scale.focalPixels);
    if (std::isfinite(scale.focalPixels) && scale.focalPixels > 0.0 && across >= kNarrowest && across <= kWidest) {
        return {};
    }
    return fail(Fault::outOfRange, "The picture must span from 0.5 to 175 degrees across, and a focal length of " +
                                       spokenNumber(scale.focalPixels) + " px does not: type the field of view.");
}

Result<Document> withScene(Document document, Scene scene) {
    const Size size = scene.size();
    if (size.width <= 0 || size.height <= 0) {
        return fail(Fault::outOfRange, "The picture is empty: choose another file or camera.");
    }
    if (static_cast<double>(size.width) * size.height > kMostPixels) {
        return fail(Fault::outOfRange, "The picture has " + std::to_string(size.width) + " x " +
                                           std::to_string(size.height) +
                                           " pixels, more than 100 megapixels: scale it down first.");
    }
    if (auto ok = checkedDepth(scene); !ok) return tl::unexpected(ok.error());
    if (scene.scale.focalPixels == 0.0) {
        scene.scale = {focalPixels(size.width, kDefaultFieldOfView), PixelScale::Source::assumed};
    }
    if (auto ok = checked(scene.scale, size); !ok) return tl::unexpected(ok.error());

    const Size before = document.scene.size();
    const auto change = oldFromNew(document, scene);
    if (!change) return tl::unexpected(change.error());
    document.scene = std::move(scene);
    if (auto anew = withDistancesAnew(document)) {
        document = *std::move(anew);
    } else {
        return tl::unexpected(anew.error());
    }
    if (before == size && *change == Change{}) return document;
    std::vector<Box<Region>*> boxes;
    for (Box<Region>& region : document.regions)
        boxes.push_back(&region);
    if (document.background) boxes.push_back(&document.background);
    for (Box<Region>* box : boxes) {
        auto region = goneAlong(**box, *change, size);
        if (!region) return tl::unexpected(region.error());
        *box = Box<Region>(*std::move(region));
    }
    return document;
}

}  // namespace ilf
