#include "core/registration/scan_diagnosis.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "core/base/as_text.h"
#include "core/registration/ambient.h"
#include "core/registration/scan_faults.h"
#include "core/registration/scan_orders.h"

namespace ilf {

const char* word(ScanFault fault) {
    switch (fault) {
    case ScanFault::tooDark:
        return "too-dark";
    case ScanFault::saturated:
        return "saturated";
    case ScanFault::moved:
        return "moved";
    case ScanFault::wrongScreen:
        return "wrong-screen";
    case ScanFault::otherOrder:
        return "other-order";
    case ScanFault::ambientLight:
        return "ambient-light";
    case ScanFault::previousFrame:
        return "previous-frame";
    case ScanFault::glossy:
        return "glossy";
    case ScanFault::flat:
        return "flat";
    case ScanFault::fewPixels:
        return "few-pixels";
    }
    return "";
}

bool ScanDiagnosis::usable() const {
    return std::ranges::none_of(findings,
                                [](const ScanFinding& f) { return f.weight == ScanFinding::Weight::failure; });
}

ScanDiagnosis scanDiagnosis(const Scan& scan, const DecodedScan& decoded) {
    using enum ScanFault;
    using enum ScanFinding::Weight;
    const ScanLight light = scanLight(scan);
    ScanDiagnosis out;
    out.lit = light.lit;
    out.decodedShare = light.lit > 0 ? static_cast<double>(decoded.count[0]) / light.lit : 0.0;
    out.medianContrast = light.contrast;
    out.projectorShare = light.projectorShare;
    const double pixels = std::max<double>(1.0, static_cast<double>(decoded.state.pixels().size()));
    const auto share = [&](PixelState state) { return decoded.count[static_cast<std::size_t>(state)] / pixels; };
    const auto percent = [](double part) { return asText("%.0f %%", 100.0 * part); };
    const auto add = [&](ScanFault fault, ScanFinding::Weight weight, std::string what,
                         PixelRect<CameraFrame> area = {}) {
        out.findings.push_back({fault, weight, std::move(what), area});
    };

    // No light at all explains everything else.
    if (light.following < 0.005) {
        if (light.blackSaturated > 0.5) {
            add(ambientLight, failure,
                "The camera's picture is at the end of its range even while the projector is black: dim the room, "
                "shorten the exposure, or close the aperture.");
        } else if (light.brightest < 20) {
            add(tooDark, failure,
                "The camera sees hardly any light at all (at most " + std::to_string(light.brightest) +
                    " of 255): open the aperture, expose longer, and see that the projector is on.");
        } else {
            add(wrongScreen, failure,
                "Nothing in the camera's picture follows the patterns: they are shown on another screen, or the "
                "camera looks elsewhere. Choose the projector's display and point the camera at its light.");
        }
        return out;
    }
    const bool readable = readableShare(decoded) >= 0.5;
    if (!readable) {
        if (const auto other = otherReading(scan)) {
            if (other->lag > 0) {
                const std::string frames =
                    other->lag == 1 ? "the pattern before" : std::to_string(other->lag) + " patterns before";
                add(previousFrame, failure,
                    "Each picture shows " + frames +
                        " its own: the camera delivers old frames. Wait longer after each "
                        "pattern, or throw away " +
                        std::to_string(other->lag) + " more frames before keeping one.");
            } else {
                add(otherOrder, failure,
                    "The pictures show the patterns in another order (" + other->order +
                        "): say so in the folder's scan.json, or scan again.");
            }
            return out;
        }
    }
    if (const auto stale = staleFrames(scan); !stale.empty()) {
        add(previousFrame, failure,
            "In " + std::to_string(stale.size()) + (stale.size() == 1 ? " place" : " places") +
                " a pattern's picture and its inverse's are the same, first in pictures " +
                std::to_string(stale.front().first) + " and " + std::to_string(stale.front().second) +
                ": the camera delivered a frame twice. Wait longer after each pattern.");
        return out;  // a wrong bit makes the rest look worse than it is
    }
    if (const auto motion = motionIn(scan)) {
        const bool all = motion->area.empty();
        const std::string far =
            all ? "by about " + asText("%.1f", motion->shift_px) + " camera pixels" : "in a part of the picture";
        add(moved, motion->shift_px > 1.5 || !all ? failure : warning,
            "Something moved " + far + " while the pictures were taken, first near picture " +
                std::to_string(motion->picture) + ": fix camera, projector and object, keep people out, scan again.",
            motion->area);
    }
    const double saturatedShare =
        light.lit + light.saturated > 0 ? static_cast<double>(light.saturated) / (light.lit + light.saturated) : 0.0;
    // Where black alone ends the range it is the room that is too bright.
    if (light.blackSaturated > 0.05 || (light.lit > 0 && light.projectorShare < 1.0 / 3.0)) {
        add(ambientLight, readable && light.blackSaturated <= 0.05 ? warning : failure,
            "Only " + percent(light.projectorShare) +
                " of the light is the projector's: dim the room, shade the window, or bring the projector nearer.");
    } else if (saturatedShare > 0.02) {
        add(saturated, saturatedShare > 0.25 ? failure : warning,
            percent(saturatedShare) +
                " of the lit pixels are brighter than the sensor can tell (yellow on the quality map): shorten the "
                "exposure, close the aperture, or turn glossy things away.",
            areaOf(decoded, PixelState::saturated));
    }
    if (light.contrast < 12.0 && light.blackSaturated <= 0.05 && saturatedShare <= 0.25) {
        add(tooDark, light.contrast < 6.0 || !readable ? failure : warning,
            "White is only " + asText("%.0f", light.contrast) +
                " of 255 above black for the middle lit pixel: expose longer, open the aperture, or dim the room.");
    }
    if (light.lit + light.saturated < 0.05 * pixels) {
        add(fewPixels, failure,
            "The projector lights only " + percent((light.lit + light.saturated) / pixels) +
                " of the picture: move the camera or the projector, or zoom, until its light fills most of it.");
    }
    const Mixed mixed = mixedLight(scan, decoded);
    // What moved, or is seen too small, mixes light as well.
    const bool otherwise = std::ranges::any_of(
        out.findings, [](const ScanFinding& f) { return f.fault == moved || f.fault == fewPixels; });
    if (mixed.share > 0.1 && !otherwise) {
        add(glossy, mixed.share > 0.5 ? failure : warning,
            percent(mixed.share) +
                " of the well lit pixels see two parts of the raster at once (orange on the quality map): gloss, or "
                "light thrown from one surface onto another. Turn or powder shiny things, or mask them.",
            mixed.area);
    }
    if (out.usable() && (share(PixelState::decoded) < 0.05 || decoded.count[0] < 5000)) {
        add(fewPixels, failure,
            "Only " + percent(share(PixelState::decoded)) +
                " of the picture was decoded: let the projector's light fill more of the camera's picture.");
    } else if (!readable && out.findings.empty()) {
        add(fewPixels, failure,
            "The patterns cannot be read, and no cause stands out: " + percent(share(PixelState::decoded)) +
                " of the picture was decoded to places that do not follow each other. Check the projector's raster "
                "size and that nothing scales its picture.");
    }
    if (readable && isFlat(decoded)) {
        add(flat, note,
            "All that was decoded lies on one plane: good for a map of it, but a calibration needs a board in several "
            "poses.");
    }
    std::ranges::stable_sort(out.findings, [](const ScanFinding& a, const ScanFinding& b) {
        return static_cast<int>(a.weight) > static_cast<int>(b.weight);
    });
    return out;
}

}  // namespace ilf
