// Another picture beneath the regions: what was drawn on the old one goes along.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/document/edit_parts.h"

namespace ilf {

namespace {

constexpr double kMostPixels = 100e6;

/// `mask` stretched over a picture of another size: averaged where it shrinks, bilinear where it grows.
Mask stretched(const Mask& mask, Size size) {
    if (mask.empty() || mask.blank()) return Mask(size);
    const Image<std::uint8_t> from = toImage(mask);
    // OpenCV asks for a writable pointer; the source of a resize is only read.
    const cv::Mat1b source(from.height(), from.width(), const_cast<std::uint8_t*>(from.pixels().data()));
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    cv::Mat1b target(size.height, size.width, pixels.data());
    const bool shrinks = size.width <= from.width() && size.height <= from.height();
    cv::resize(source, target, target.size(), 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
    return toTiles({size, 1, std::move(pixels)});
}

void stretch(Region& region, Size from, Size to) {
    const double sx = static_cast<double>(to.width) / std::max(1, from.width);
    const double sy = static_cast<double>(to.height) / std::max(1, from.height);
    const auto moved = [&](Point<CameraFrame> p) { return Point<CameraFrame>{p.x * sx, p.y * sy}; };
    if (auto* plane = std::get_if<PlaneDistance>(&region.distance)) {
        for (DistanceAnchor& anchor : plane->anchors)
            anchor.at = moved(anchor.at);
    }
    if (region.outline) {
        for (Point<CameraFrame>& p : region.outline->vertices)
            p = moved(p);
    }
    if (region.id == kBackgroundId) return;
    region.mask = region.outline ? rasterised(*region.outline, to) : stretched(region.mask, to);
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
    document.scene = std::move(scene);
    if (auto anew = withDistancesAnew(document)) {
        document = *std::move(anew);
    } else {
        return tl::unexpected(anew.error());
    }
    if (before == size) return document;
    try {
        const auto moved = [&](const Box<Region>& box) {
            Region region = *box;
            stretch(region, before, size);
            return Box<Region>(std::move(region));
        };
        for (Box<Region>& region : document.regions)
            region = moved(region);
        if (document.background) document.background = moved(document.background);
    } catch (const cv::Exception& e) {
        return fail(Fault::outOfRange, std::string("The regions could not be fitted to the new picture: ") + e.what());
    }
    return document;
}

}  // namespace ilf
