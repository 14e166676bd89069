// Another picture beneath the regions: where its pixels lie in the one before, and what of the scene goes along.
#pragma once

#include "core/base/result.h"
#include "core/document/document.h"

namespace ilf {

/// The mode of the camera that gave the scene's picture: as the scene says, or as the rig's registration does where it
/// was made with the same camera at the picture's size. Without a size where nobody says it.
CameraMode pictureMode(const Document& document);

/// Where a point of the picture of `next` lies in the document's: a scale and a shift.
/// - The camera's mode changed, and is known: the same point of the sensor, as for a registration (convert.h).
/// - Else, of one size: the identity.
/// - Else, of another size and from no camera: stretched, each side by itself.
/// Refused, in words: a camera's picture of another size that nobody can tell how it lies in the old one, while
/// something is painted or a plane laid there.
Result<Homography<CameraFrame, CameraFrame>> oldFromNew(const Document& document, const Scene& next);

/// `next` with what the document's scene knows of the room: the wearer's place; depth and pixel scale, where a change
/// of the camera's mode tells where they lie now or the sizes are the same. A scale of its own that was not only
/// assumed stays. Depth that the new picture shows nothing of is left behind.
Scene carriedOver(const Document& document, Scene next);

/// `mask` for `picture` pixels: averaged where it shrinks, bilinear where it grows, 0 beyond the old picture.
/// Precondition: `oldFromNew` only scales and shifts, scales above 0.
Mask resampled(const Mask& mask, const Homography<CameraFrame, CameraFrame>& oldFromNew, Size picture);
/// Metres, or their deviations, of which 0 is a hole. Only pixels of the surface under the new pixel's middle (within 2
/// % of it by `surface`, which may be `metres` itself) are averaged, so that nothing floats between near and far.
Image<float> resampled(const Image<float>& metres, const Image<float>& surface,
                       const Homography<CameraFrame, CameraFrame>& oldFromNew, Size picture);

}  // namespace ilf
