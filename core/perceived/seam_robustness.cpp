#include "core/perceived/seam_robustness.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/optics/gaze.h"

namespace ilf {
namespace {

std::string formatted(const char* pattern, double a, double b = 0.0) {
    char text[96];
    std::snprintf(text, sizeof text, pattern, a, b);
    return text;
}

/// How far the point that no power moves wanders over the surface when an eye turns by `degrees`.
Metre centreMoved(const EyeOptics& eye, Metre distance, double degrees) {
    const Metre pupil = pupilShift(degrees * std::numbers::pi / 180.0);
    return scalingCentre(eye, distance, {0.0_m, pupil}) - scalingCentre(eye, distance, {});
}

}  // namespace

std::vector<SeamErrorCase> errorCases(const SeamErrors& errors, const EyeOptics& eye, Metre distance, double nx,
                                      double ny) {
    const auto bothWays = [](auto&& misplaced) { return std::vector<Misplaced>{misplaced(1.0), misplaced(-1.0)}; };
    const auto shifted = [&](Metre by) {
        return bothWays([&](double sign) {
            Misplaced off;
            off.registrationX = sign * nx * by;
            off.registrationY = sign * ny * by;
            return off;
        });
    };
    const auto turned = [&](Metre by) {
        return bothWays([&](double sign) {
            Misplaced off;
            off.centreX = sign * nx * by;
            off.centreY = sign * ny * by;
            return off;
        });
    };
    const auto pupil = [&](double sign) {
        Misplaced off;
        off.pupil = std::max(sign * errors.pupil, -0.9 * eye.pupil);
        return off;
    };
    const auto lens = [&](double sign) {
        Misplaced off;
        off.lensToPupil = std::max(sign * errors.lensToPupil, -0.9 * eye.lensToPupil);
        return off;
    };
    Misplaced nearer, farther;
    nearer.distance = 1.0 - errors.nearer;
    farther.distance = 1.0 + errors.farther;
    const Metre wandered = abs(centreMoved(eye, distance, errors.turned_deg));
    return {
        {SeamErrorKind::pupil,
         formatted("pupil %.1f or %.1f mm", std::max(0.1 * eye.pupil, eye.pupil - errors.pupil).in(1.0_mm),
                   (eye.pupil + errors.pupil).in(1.0_mm)),
         bothWays(pupil), true},
        {SeamErrorKind::distance,
         formatted("%.0f %% nearer or %.0f %% farther", 100.0 * errors.nearer, 100.0 * errors.farther),
         {nearer, farther},
         true},
        {SeamErrorKind::registration, formatted("registration %.2f mm", errors.registration.in(1.0_mm)),
         shifted(errors.registration), true},
        {SeamErrorKind::registration, formatted("registration %.2f mm", errors.coarseRegistration.in(1.0_mm)),
         shifted(errors.coarseRegistration), false},
        {SeamErrorKind::gaze, formatted("optical centre %.0f mm off", errors.gaze.in(1.0_mm)), turned(errors.gaze),
         true},
        {SeamErrorKind::gaze,
         formatted("eye turned by %.0f degrees (optical centre %.0f mm off)", errors.turned_deg, wandered.in(1.0_mm)),
         turned(wandered), false},
        {SeamErrorKind::lensToPupil, formatted("lens to pupil +-%.0f mm", errors.lensToPupil.in(1.0_mm)),
         bothWays(lens), true},
    };
}

HidingWidth hidingWidth(Metre axesShift, Metre errorShift, Metre blurRadius, Metre region) {
    constexpr double kHidden = 0.01;
    HidingWidth hiding;
    hiding.axesShift = axesShift;
    hiding.shift = axesShift + errorShift;
    hiding.blurRadius = blurRadius;
    hiding.asked = hiding.shift / kHidden - 2.0 * blurRadius;
    const Metre least = 2.0 * blurRadius, most = std::max(region / 3.0, least);
    hiding.width = std::clamp(hiding.asked, least, most);
    hiding.clamped = hiding.asked > most;
    hiding.left = contrastOfShift(hiding.shift, hiding.width);
    return hiding;
}

double contrastOfShift(Metre shift, Metre width) {
    return abs(shift) >= width ? (abs(shift) > 0.0_m ? 1.0 : 0.0) : abs(shift) / width;
}

double leastContrastOfShift(Metre shift, Metre width, Metre blurRadius) {
    const Metre reach = width + 2.0 * blurRadius;
    return abs(shift) >= reach ? (abs(shift) > 0.0_m ? 1.0 : 0.0) : abs(shift) / reach;
}

double contrastOfBlur(Metre change, Metre width) {
    // Mean of max(0, u) where u is spread as the chords of a disc of radius 1.
    constexpr double kCorner = 2.0 / (3.0 * std::numbers::pi);
    return std::min(1.0, kCorner * (abs(change) / width));
}

}  // namespace ilf
