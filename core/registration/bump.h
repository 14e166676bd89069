// The bump alarm: whether the camera still stands where it stood when it was registered.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/image.h"
#include "core/base/result.h"
#include "core/registration/registration.h"

namespace ilf {

/// What became of the reference features.
struct BumpReport {
    int features = 0;       ///< of the reference
    double found = 0.0;     ///< share of them that are seen again, where they were or moved with most others
    double stayed = 0.0;    ///< share of those found that are where they were
    double moved_px = 0.0;  ///< median way of those found, camera pixels
    bool blind = false;     ///< too few found to tell: dark, covered, another scene
    bool bumped = false;    ///< most of what is found has moved together
    /// Where the old picture's points are in the new one; only when bumped. Exact when the camera only turned, or for a
    /// flat scene; else the best there is until the next scan.
    std::optional<Homography<CameraFrame, CameraFrame>> newFromOld;
};

/// Corners of a reference picture, to look for in later ones. A hand takes some away, light changes all of them alike,
/// a bump moves them together. Features are compared by the order of their brightnesses (ORB), so that neither gain nor
/// offset of the light matters.
class BumpAlarm {
public:
    /// Refused when the picture has too few features to tell anything. Grey, 8 bits; at least 64 x 64.
    static Result<BumpAlarm> of(const Image<std::uint8_t>& reference);
    /// Refused when the picture has another size.
    Result<BumpReport> compared(const Image<std::uint8_t>& picture) const;

private:
    struct Features;
    explicit BumpAlarm(std::shared_ptr<const Features> reference) : reference_(std::move(reference)) {}
    std::shared_ptr<const Features> reference_;
};

/// The registration as it would be after that bump: for the operator to accept or not. Its residuals grow by what a
/// homography cannot tell, which nobody knows: method, points and date stay those of the old one.
Registration afterBump(const Registration& registration, const Homography<CameraFrame, CameraFrame>& newFromOld);

}  // namespace ilf
