// What may be typed or read from a file: every number finite and inside its range, or the sentence that says why not.
#include <cmath>
#include <cstdio>

#include "core/document/edit.h"
#include "core/document/edit_parts.h"

namespace ilf {

std::string spokenNumber(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string capitalised(std::string sentence) {
    if (!sentence.empty() && sentence[0] >= 'a' && sentence[0] <= 'z') {
        sentence[0] = static_cast<char>(sentence[0] - 'a' + 'A');
    }
    return sentence;
}

Result<void> inRange(const std::string& spoken, double value, double low, double high, const std::string& unit,
                     const std::string& reason) {
    if (std::isfinite(value) && value >= low && value <= high) return {};
    return fail(Fault::outOfRange, capitalised(spoken) + " must be from " + spokenNumber(low) + " to " +
                                       spokenNumber(high) + (unit.empty() ? "" : " " + unit) + ", not " +
                                       spokenNumber(value) + (reason.empty() ? "." : ": " + reason + "."));
}

namespace {

/// Well-formed UTF-8, without overlong forms and surrogates (Unicode 15, table 3-7).
bool isUtf8(const std::string& text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    for (std::size_t i = 0; i < text.size();) {
        const unsigned lead = byte(i);
        const std::size_t follow = lead < 0x80 ? 0 : lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3;
        if ((lead >= 0x80 && lead < 0xc2) || lead > 0xf4) return false;
        const unsigned second = byte(i + 1);
        if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) || (lead == 0xf0 && second < 0x90) ||
            (lead == 0xf4 && second > 0x8f)) {
            return false;
        }
        for (std::size_t k = 1; k <= follow; ++k) {
            if (byte(i + k) < 0x80 || byte(i + k) > 0xbf) return false;
        }
        i += follow + 1;
    }
    return true;
}

}  // namespace

Result<std::string> checkedName(const std::string& name) {
    constexpr std::size_t kLongestName = 200;
    const auto first = name.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) return fail(Fault::outOfRange, "A name needs at least one letter.");
    std::string trimmed = name.substr(first, name.find_last_not_of(" \t\r\n") - first + 1);
    if (trimmed.size() > kLongestName) {
        return fail(Fault::outOfRange, "A name can have at most 200 bytes, and this one has " +
                                           std::to_string(trimmed.size()) + ": shorten it.");
    }
    if (!isUtf8(trimmed)) return fail(Fault::outOfRange, "A name must be UTF-8 text: type it again.");
    for (const char c : trimmed) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
            return fail(Fault::outOfRange, "A name cannot hold line breaks, tabs or other control characters.");
        }
    }
    return trimmed;
}

namespace {

Result<void> checkedMetres(const std::string& spoken, Metre distance) {
    if (isFinite(distance) && distance > 0.0_m && distance <= kFarthestDistance) return {};
    return fail(Fault::outOfRange, capitalised(spoken) +
                                       " must be more than 0 m and at most 1000 m from the wearer's " + "lens, not " +
                                       spokenNumber(distance.si()) + " m.");
}

Result<void> checkedTolerance(const std::string& spoken, Metre tolerance, Metre below) {
    if (isFinite(tolerance) && tolerance >= 0.0_m && tolerance < below) return {};
    return fail(Fault::outOfRange, "The tolerance of " + spoken + " must be from 0 m to less than " +
                                       spokenNumber(below.si()) + " m, so that the surface stays in front of the " +
                                       "lens, not " + spokenNumber(tolerance.si()) + " m.");
}

Result<void> checkedPlane(const PlaneDistance& plane, const std::string& spoken) {
    for (const DistanceAnchor& anchor : plane.anchors) {
        if (!std::isfinite(anchor.at.x) || !std::isfinite(anchor.at.y)) {
            return fail(Fault::outOfRange,
                        capitalised(spoken) + " has a point that is nowhere in the picture: place it again.");
        }
        if (auto ok = checkedMetres("each point of " + spoken, anchor.distance); !ok) return ok;
    }
    Region surface;
    surface.distance = plane;
    if (!affineVergence(surface)) {
        return fail(Fault::outOfRange,
                    "The three points that give " + spoken + " are on one line: drag one of them aside.");
    }
    return {};
}

Result<void> firstRefusal(std::initializer_list<Result<void>> checks) {
    for (const Result<void>& check : checks) {
        if (!check) return check;
    }
    return {};
}

Result<void> checkedCamera(const CameraObserver& camera) {
    if (auto ok = firstRefusal({
            inRange("the camera's focal length", camera.focalLength.in(1.0_mm), 1.0, 1000.0, "mm"),
            inRange("the camera's f-number", camera.fNumber, 0.5, 64.0, ""),
            inRange("the camera's pixel pitch", camera.pixelPitch.in(1.0_um), 0.5, 100.0, "um"),
            checkedMetres("the distance the camera is focused at", camera.focusDistance),
        });
        !ok) {
        return ok;
    }
    if (camera.focusDistance <= camera.focalLength) {
        return fail(Fault::outOfRange, "The camera must be focused farther away than its focal length of " +
                                           spokenNumber(camera.focalLength.in(1.0_mm)) + " mm, not at " +
                                           spokenNumber(camera.focusDistance.in(1.0_mm)) + " mm.");
    }
    return {};
}

}  // namespace

Result<void> checked(const Distance& distance, const std::string& spoken) {
    if (const auto* constant = std::get_if<ConstantDistance>(&distance)) {
        if (auto ok = checkedMetres(spoken, constant->value); !ok) return ok;
        return checkedTolerance(spoken, constant->tolerance, constant->value);
    }
    if (const auto* plane = std::get_if<PlaneDistance>(&distance)) return checkedPlane(*plane, spoken);
    return checkedTolerance(spoken, std::get<FromDepthMap>(distance).tolerance, kFarthestDistance);
}

Result<void> checked(const Wearer& wearer) {
    if (auto name = checkedName(wearer.name); !name) return tl::unexpected(name.error());
    if (auto ok = firstRefusal({
            inRange("the pupil", wearer.pupil.in(1.0_mm), 1.0, 9.0, "mm"),
            inRange("the way from lens to pupil", wearer.lensToPupil.in(1.0_mm), 5.0, 60.0, "mm"),
            inRange("the power of the eye", wearer.eyePower.si(), 40.0, 80.0, "D"),
            inRange("the prescription", wearer.ametropia.si(), -20.0, 20.0, "D", "no tunable lens can correct more"),
            inRange("the age", wearer.ageYears, 5.0, 110.0, "years"),
            inRange("the measured accommodation", wearer.measuredAccommodation.value_or(0.0_D).si(), 0.0, 25.0, "D"),
            inRange("the clear aperture of the lens", wearer.lensAperture.in(1.0_mm), 1.0, 100.0, "mm"),
        });
        !ok) {
        return ok;
    }
    if (wearer.confusion.preset == CircleOfConfusion::Preset::typed) {
        const double diameter = wearer.confusion.diameter.in(1.0_um);
        if (auto ok = inRange("the circle of confusion", diameter, 0.5, 500.0, "um"); !ok) return ok;
    }
    for (const LensAxis& axis : wearer.axes) {
        if (auto ok = firstRefusal({inRange("a lens axis", axis.right.in(1.0_mm), -200.0, 200.0, "mm to the right"),
                                    inRange("a lens axis", axis.down.in(1.0_mm), -200.0, 200.0, "mm down")});
            !ok) {
            return ok;
        }
    }
    if (auto ok = inRange("the way between the eyes", wearer.eyeSpacing().in(1.0_mm), 30.0, 90.0, "mm"); !ok) return ok;
    if (1.0 + wearer.lensToPupil * wearer.ametropia <= 0.0) {
        return fail(Fault::outOfRange, "With a prescription of " + spokenNumber(wearer.ametropia.si()) +
                                           " D and the lens " + spokenNumber(wearer.lensToPupil.in(1.0_mm)) +
                                           " mm before the pupil, the eye's far point lies between lens and eye, so "
                                           "that everything is blurred already: bring the lens closer.");
    }
    return wearer.camera ? checkedCamera(*wearer.camera) : Result<void>{};
}

Result<void> checked(const Rig& rig) {
    if (auto name = checkedName(rig.name); !name) return tl::unexpected(name.error());
    if (auto ok = firstRefusal({
            inRange("the projector's width", rig.projector.width, 1, 8192, "pixels"),
            inRange("the projector's height", rig.projector.height, 1, 8192, "pixels"),
        });
        !ok) {
        return ok;
    }
    const double sweep = rig.sweepRate.si();
    if (!std::isfinite(sweep) || sweep < 30.0 || sweep > 1000.0) {
        return fail(Fault::outOfRange, "The sweep rate must be from 30 to 1000 Hz, not " + spokenNumber(sweep) +
                                           " Hz: light that pulses at 3 to 30 Hz can trigger seizures.");
    }
    const double slots = rig.slotRate / rig.sweepRate;
    if (!std::isfinite(slots) || std::abs(slots - std::round(slots)) > 1e-9 * slots || std::round(slots) < 1.0) {
        return fail(Fault::outOfRange, "The slot rate must be an integer multiple of the sweep rate of " +
                                           spokenNumber(sweep) + " Hz, not " + spokenNumber(rig.slotRate.si()) +
                                           " Hz: slots that drift against the sweep make light flicker visibly, as "
                                           "1000 Hz over 60 Hz does at 20 Hz.");
    }
    if (auto ok = firstRefusal({
            inRange("the slots of one sweep", std::round(slots), 2, 1024, ""),
            inRange("the projector's delay", rig.projectorDelay.in(1.0_ms), 0.0, 100.0, "ms"),
            inRange("the lowest lens power", rig.lensMin.si(), -50.0, 50.0, "D"),
            inRange("the highest lens power", rig.lensMax.si(), -50.0, 50.0, "D"),
            inRange("the bits of a slot's picture", rig.bits, 1, 8, ""),
            inRange("the projector's fastest slot rate", rig.fastest.si(), 1.0, 1e6, "Hz"),
            inRange("the power error a slot may have", rig.powerBudget.si(), 0.001, 5.0, "D"),
            inRange("the share of its power that blur may be wrong by", rig.blurShare, 0.0, 1.0, ""),
            inRange("the projector's light", rig.room.projector_lm, 0.1, 1e6, "lm"),
            inRange("the lit area", rig.room.litArea_m2, 1e-4, 1e4, "m\u00b2"),
            inRange("the ambient light", rig.room.ambient_lx, 0.0, 1e5, "lx"),
        });
        !ok) {
        return ok;
    }
    if (rig.lensMin >= rig.lensMax) {
        return fail(Fault::outOfRange, "The lowest lens power, " + spokenNumber(rig.lensMin.si()) +
                                           " D, must be below the highest, " + spokenNumber(rig.lensMax.si()) + " D.");
    }
    if (rig.primaries) {
        const auto& [red, green, blue] = *rig.primaries;
        const auto visible = [](const char* spoken, Metre length) {
            return inRange(spoken, length.si() * 1e9, 380.0, 780.0, "nm", "nothing else is seen");
        };
        if (auto ok = firstRefusal({visible("the wavelength of the red light", red),
                                    visible("the wavelength of the green light", green),
                                    visible("the wavelength of the blue light", blue)});
            !ok) {
            return ok;
        }
        if (!(red > green && green > blue)) {
            return fail(Fault::outOfRange, "The projector's wavelengths must fall from red over green to blue, not " +
                                               spokenNumber(red.si() * 1e9) + ", " + spokenNumber(green.si() * 1e9) +
                                               " and " + spokenNumber(blue.si() * 1e9) + " nm: check their order.");
        }
    }
    if (rig.registration) {
        double size = 1.0;  // of the three rows: what the determinant of a well-conditioned map is compared with
        for (std::size_t row = 0; row < 3; ++row) {
            const double* m = &rig.registration->map.nearest().m[3 * row];
            size *= std::hypot(m[0], m[1], m[2]);
        }
        if (!std::isfinite(size) || !(std::abs(rig.registration->map.nearest().determinant()) > 1e-12 * size)) {
            return fail(Fault::outOfRange, "The registration of camera and projector folds the picture onto a line, so "
                                           "that there is no way back: register again.");
        }
    }
    return rig.devices ? checked(*rig.devices) : Result<void>{};
}

Result<void> checkedTogether(const Wearer& wearer, const Rig& rig) {
    if (wearer.lensToPupil * rig.lensMax < 1.0) return {};
    return fail(Fault::outOfRange, "With the lens " + spokenNumber(wearer.lensToPupil.in(1.0_mm)) +
                                       " mm before the pupil its power must stay below " +
                                       spokenNumber((1.0 / wearer.lensToPupil).si()) + " D, and the rig allows " +
                                       spokenNumber(rig.lensMax.si()) +
                                       " D: beyond that the lens focuses in front of the eye.");
}

}  // namespace ilf
