// What a pose message says: from the bytes of a datagram to poses, by a table of addresses.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf::devices {

/// Where something is in the camera's picture.
struct OscPose {
    std::string address;               ///< "/pose/1"
    double x = 0.0, y = 0.0;           ///< of the picture's width and height, 0..1, y down; up to one picture outside
    std::optional<double> z_m;         ///< metres from the camera; nothing if it was not sent
    double rotation_deg = 0.0;         ///< clockwise in the picture
    double confidence = 1.0;           ///< 0..1
    std::optional<double> secondsAgo;  ///< by the bundle's time tag; nothing: now
    bool operator==(const OscPose&) const = default;
};

/// The addresses (numbers as OSC int32, int64, float or double; N: 0 to 65535):
///
///     /pose/N   x y                         in the picture
///     /pose/N   x y z                       z in metres
///     /pose/N   x y z rotation              degrees
///     /pose/N   x y z rotation confidence   below 0.3 it counts as not seen (core/track/follower.h)
///
/// What a datagram says: a message, or a bundle of them (bundles inside bundles to a depth of 8). All or nothing: one
/// bad message refuses the whole datagram, since a bundle is one change.
struct OscSays {
    std::vector<OscPose> poses;
    std::vector<std::string> unknown;  ///< addresses that are not in the table
};

/// `unixNow`: seconds since 1970, for time tags. Refused, in one sentence: bytes that are no OSC 1.0, arguments that
/// are not in the table, numbers out of range or not finite. Any bytes may come.
Result<OscSays> poseMessage(std::span<const std::byte> datagram, double unixNow);

}  // namespace ilf::devices
