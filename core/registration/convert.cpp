#include "core/registration/convert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/base/as_text.h"

namespace ilf {

namespace {

bool known(Size size) { return size.width > 0 && size.height > 0; }

std::string sized(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

tl::unexpected<Error> refused(const std::string& why) {
    return fail(Fault::unsupported, "The registration does not fit the camera's mode: " + why);
}

using Plane = Homography<ProjectorFrame, CameraFrame>;
using Change = Homography<CameraFrame, CameraFrame>;

Plane composed(const Plane& plane, const Change& change) {
    Plane out;
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
            out.m[3 * r + c] = 0.0;
            for (std::size_t k = 0; k < 3; ++k)
                out.m[3 * r + c] += plane.m[3 * r + k] * change.m[3 * k + c];
        }
    }
    return out;
}

std::size_t area(Size size) { return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height); }

/// The least sure pixel within the old pixels that (x, y) covers; 0 where it reaches beyond the old picture by half a
/// pixel or more.
std::uint8_t surenessOf(const Image<std::uint8_t>& confidence, const Change& oldFromNew, int x, int y) {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const double dy : {0.0, 1.0}) {
        for (const double dx : {0.0, 1.0}) {
            const auto p = oldFromNew(Point<CameraFrame>{x + dx, y + dy});
            x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
            y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
        }
    }
    const int width = confidence.width(), height = confidence.height();
    if (!(x0 > -0.5 && y0 > -0.5 && x1 < width + 0.5 && y1 < height + 0.5)) return 0;
    // A pixel that is touched along its edge alone is not covered.
    constexpr double kHair = 0.01;
    const auto within = [](double v, int length) { return std::clamp(static_cast<int>(std::floor(v)), 0, length - 1); };
    std::uint8_t least = 255;
    for (int v = within(y0 + kHair, height); v <= within(y1 - kHair, height); ++v)
        for (int u = within(x0 + kHair, width); u <= within(x1 - kHair, width); ++u)
            least = std::min(least, confidence.at(u, v));
    return least;
}

DenseMap resampled(const PixelMap& map, const Change& oldFromNew, Size picture) {
    const DenseMap& old = *map.dense();
    const Change newFromOld = oldFromNew.inverted();
    std::vector<float> forth, back;
    std::vector<std::uint8_t> sure, seen;
    forth.reserve(2 * area(picture));
    sure.reserve(area(picture));
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const auto at = map.toProjector(oldFromNew(Point<CameraFrame>{x + 0.5, y + 0.5}));
            forth.push_back(static_cast<float>(at.x));
            forth.push_back(static_cast<float>(at.y));
            sure.push_back(surenessOf(old.confidence, oldFromNew, x, y));
        }
    }
    const Size raster = old.projector();
    back.reserve(2 * area(raster));
    seen.reserve(area(raster));
    for (int y = 0; y < raster.height; ++y) {
        const float* row = old.cameraOfProjector.row(y);
        for (int x = 0; x < raster.width; ++x) {
            const auto c =
                newFromOld(Point<CameraFrame>{static_cast<double>(row[2 * x]), static_cast<double>(row[2 * x + 1])});
            back.push_back(static_cast<float>(c.x));
            back.push_back(static_cast<float>(c.y));
            const bool inside = c.x >= 0.0 && c.y >= 0.0 && c.x <= picture.width && c.y <= picture.height;
            seen.push_back(inside ? old.seen.at(x, y) : std::uint8_t{0});
        }
    }
    return {Image<float>(picture, 2, std::move(forth)), Image<std::uint8_t>(picture, 1, std::move(sure)),
            Image<float>(raster, 2, std::move(back)), Image<std::uint8_t>(raster, 1, std::move(seen)),
            composed(old.nearest, oldFromNew)};
}

/// That the part read out lies on the sensor.
Result<void> checkedMode(const CameraMode& mode, const char* whose) {
    const bool fits = mode.binning >= 1 && mode.x0 >= 0 && mode.y0 >= 0 && known(mode.picture) &&
                      mode.x0 + std::int64_t{mode.binning} * mode.picture.width <= mode.sensor.width &&
                      mode.y0 + std::int64_t{mode.binning} * mode.picture.height <= mode.sensor.height;
    if (fits) return {};
    return fail(Fault::unsupported, std::string(whose) + " picture of " + sized(mode.picture) +
                                        " pixels does not fit on the sensor of " + sized(mode.sensor) + ".");
}

}  // namespace

PixelMap remapped(const PixelMap& map, const Homography<CameraFrame, CameraFrame>& oldFromNew, Size picture) {
    if (!map.dense()) return PixelMap(composed(map.nearest(), oldFromNew));
    return PixelMap(Box<DenseMap>(resampled(map, oldFromNew, picture)));
}

Result<Change> oldFromNew(const CameraMode& before, const CameraMode& now) {
    const auto unknown = [](const std::string& why) { return fail(Fault::unsupported, why); };
    if (!before.device.empty() && !now.device.empty() && before.device != now.device)
        return unknown("the old one is of \"" + before.device + "\", and this one of \"" + now.device + "\".");
    if (!known(before.picture) || !known(now.picture)) return Change{};
    const bool sensors = known(before.sensor) && known(now.sensor);
    if (sensors && before.sensor != now.sensor) {
        return unknown("the old one is of a sensor of " + sized(before.sensor) + " pixels, and this one of " +
                       sized(now.sensor) + ".");
    }
    const bool sameCut = before.x0 == now.x0 && before.y0 == now.y0 && before.binning == now.binning;
    if (before.picture == now.picture && (sameCut || !sensors)) return Change{};
    if (!sensors) {
        return unknown("the old picture has " + sized(before.picture) + " pixels, this one " + sized(now.picture) +
                       ", and how they are cut out of the sensor is not known.");
    }
    if (auto good = checkedMode(before, "the old"); !good) return tl::unexpected(good.error());
    if (auto good = checkedMode(now, "the new"); !good) return tl::unexpected(good.error());
    const double scale = static_cast<double>(now.binning) / before.binning;
    return Change{{scale, 0.0, static_cast<double>(now.x0 - before.x0) / before.binning,  //
                   0.0, scale, static_cast<double>(now.y0 - before.y0) / before.binning,  //
                   0.0, 0.0, 1.0}};
}

Pinhole convertedBy(const Pinhole& camera, const Change& oldFromNew, Size picture) {
    const Change newFromOld = oldFromNew.inverted();
    const auto axis = newFromOld(Point<CameraFrame>{camera.cx, camera.cy});
    return {picture, camera.fx * newFromOld.m[0], camera.fy * newFromOld.m[4], axis.x, axis.y, camera.distortion};
}

Result<Registration> convertedTo(const Registration& registration, const CameraMode& now) {
    const CameraMode& before = registration.camera;
    const auto change = oldFromNew(before, now);
    if (!change)
        return refused(change.error().what + " Register again, or choose the camera and size it was made with.");
    if (!known(before.picture) || !known(now.picture)) return registration;
    Registration converted = registration;
    converted.camera = now;
    if (now.device.empty()) converted.camera.device = before.device;
    if (*change == Change{}) {
        if (!known(now.sensor)) converted.camera.sensor = before.sensor;
        if (before.picture == now.picture) return converted;
    }
    const auto first = (*change)(Point<CameraFrame>{0.0, 0.0});
    const auto last = (*change)(Point<CameraFrame>{1.0 * now.picture.width, 1.0 * now.picture.height});
    constexpr double kSpare = 1.0;  // what the edge may be continued by
    const bool beyond = first.x < -kSpare || first.y < -kSpare || last.x > before.picture.width + kSpare ||
                        last.y > before.picture.height + kSpare;
    if (registration.map.dense() && beyond) {
        return refused(
            "it shows more of the sensor than was scanned. Choose the part that was scanned, or scan again.");
    }
    converted.map = remapped(registration.map, *change, now.picture);
    return converted;
}

std::optional<std::chrono::system_clock::time_point> momentOf(const std::string& utc) {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
    if (std::sscanf(utc.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d", &year, &month, &day, &hour, &minute, &second) != 6) {
        return std::nullopt;
    }
    const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
    return std::chrono::sys_days(date) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
           std::chrono::seconds(second);
}

std::string agedText(const Registration& registration, std::chrono::system_clock::time_point now) {
    const auto taken = momentOf(registration.taken);
    if (!taken) return "at an unknown time";
    const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(now - *taken).count();
    const auto counted = [](std::int64_t n, const char* unit) {
        return std::to_string(n) + " " + unit + (n == 1 ? "" : "s") + " ago";
    };
    if (minutes < -2) return "in the future";
    if (minutes < 2) return "just now";
    if (minutes < 120) return counted(minutes, "minute");
    if (minutes < 48 * 60) return counted(minutes / 60, "hour");
    if (minutes < 120 * 24 * 60) return counted(minutes / (24 * 60), "day");
    return counted(minutes / (30 * 24 * 60), "month");
}

std::string caption(const Registration& registration, std::chrono::system_clock::time_point now) {
    using Method = Registration::Method;
    static const std::array<const char*, 5> kHow{"Typed in", "Four corners set", "Point pairs set", "Chessboard seen",
                                                 "Scanned"};
    if (registration.method == Method::typed && registration.taken.empty()) return "Typed in";
    const auto pixels = [](double px) { return asText(px < 10.0 ? "%.2f px" : "%.0f px", px); };
    std::string words = kHow[static_cast<std::size_t>(registration.method)];
    words += " " + agedText(registration, now);
    if (!registration.camera.device.empty()) words += " with " + registration.camera.device;
    if (registration.points > 0) {
        words += ": " + pixels(registration.rms_px) + " rms, " + pixels(registration.worst_px) + " at worst, " +
                 std::to_string(registration.points) + " points";
    }
    return registration.provenance.empty() ? words : words + " (" + registration.provenance + ")";
}

}  // namespace ilf
