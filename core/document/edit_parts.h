// What the edits are made of: checks, sentences and masks shared by the .cpp files behind edit.h.
#pragma once

#include <string>

#include "core/document/edit.h"

namespace ilf {

/// Four digits, without trailing zeros: "0.25".
std::string spokenNumber(double value);
std::string capitalised(std::string sentence);

/// Refuses NaN, infinity and what is outside low..high: "The pupil must be from 1 to 9 mm, not 12." + reason, if any.
Result<void> inRange(const std::string& spoken, double value, double low, double high, const std::string& unit,
                     const std::string& reason = {});

/// The name without spaces around it; refuses empty ones, more than 200 bytes and control characters.
Result<std::string> checkedName(const std::string& name);

/// Places, voltages, currents and points that devices of this kind can have.
Result<void> checked(const RigDevices& devices);

/// d_Ee P < 1 for every power the rig can reach: beyond, the lens has its focus in front of the pupil.
Result<void> checkedTogether(const Wearer& wearer, const Rig& rig);

/// The edits that change a mask. `region` is neither locked nor the background; the mask has the picture's size.
Result<Mask> withPaint(const Document& document, const Region& region, const Paint& paint);
Result<Mask> withShape(const Document& document, const Region& region, const FillShape& fill);
Result<void> checked(const Outline& outline);

/// Measured depth, the viewer's pose, and what `scene.depth` is made of: each refuses without having changed anything.
Result<Document> withMeasured(Document document, const SetMeasuredDepth& edit);
Result<Document> withViewer(Document document, const SetViewerPose& edit);
Result<Document> withPixelScale(Document document, const SetPixelScale& edit);
Result<Document> withDepthScale(Document document, const SetDepthScale& edit);
/// `scene.depth` from what was measured, where something was; else the document as it is.
Result<Document> withDistancesAnew(Document document);
Result<void> checked(const ViewerPose& viewer);
/// The depth, measured depth and viewer of a scene that comes as a whole.
Result<void> checkedDepth(const Scene& scene);

/// Another picture beneath the regions: masks, outlines and anchors go along when its size is another.
Result<Document> withScene(Document document, Scene scene);
Result<void> checked(const PixelScale& scale, Size picture);

}  // namespace ilf
