// What a registration is still worth: after its camera's mode changed, and as time goes by.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/registration/pinhole.h"
#include "core/registration/registration.h"

namespace ilf {

/// Where a point of the sensor lies in the picture of the mode `before`, by where it lies in that of the mode `now`: a
/// scale and a shift. The identity where the modes do not differ, or one of them says no size. Refused, with the bare
/// reason, where it cannot be predicted: another device or sensor, another size of a sensor that is not known, a part
/// that does not fit on it.
Result<Homography<CameraFrame, CameraFrame>> oldFromNew(const CameraMode& before, const CameraMode& now);

/// The registration for another mode of its camera, where that can be predicted: another part of the same sensor,
/// another binning, another picture size that follows from them. Refused in words: another device or sensor, a sensor
/// that is not known, a part that does not fit on it, and for a scanned map pixels that were not scanned. A
/// registration of no mode in particular fits every one.
Result<Registration> convertedTo(const Registration& registration, const CameraMode& now);
/// The same for the camera as a pinhole. Precondition: `oldFromNew` only scales and shifts.
Pinhole convertedBy(const Pinhole& camera, const Homography<CameraFrame, CameraFrame>& oldFromNew, Size picture);

/// The map of another picture of the same scene, whose points are the old picture's by `oldFromNew`. A scanned map is
/// resampled for `picture` pixels; where they show what was not scanned its confidence is 0.
PixelMap remapped(const PixelMap& map, const Homography<CameraFrame, CameraFrame>& oldFromNew, Size picture);

/// How old it is, in words: "just now", "3 hours ago", "12 days ago"; "at an unknown time" where it does not say, and
/// "in the future" where clocks disagree.
std::string agedText(const Registration& registration, std::chrono::system_clock::time_point now);

/// One line for the operator: "Scanned 3 days ago with Camera 1: 0.21 px rms, 1.4 px at worst, 801234 points
/// (emulated)".
std::string caption(const Registration& registration, std::chrono::system_clock::time_point now);

/// The moment an ISO 8601 text in UTC says ("2026-02-03T04:05:06Z"), or nothing.
std::optional<std::chrono::system_clock::time_point> momentOf(const std::string& utc);

}  // namespace ilf
