// The selected region: look, strength, distance, and what the plan makes of them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/document/plane_fit.h"
#include "ui/canvas.h"
#include "ui/follow_part.h"
#include "ui/icons.h"
#include "ui/new_region.h"
#include "ui/prediction_card.h"
#include "ui/why_no_part.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

constexpr const char* kDistanceHelp =
    "Measured from the wearer's lens along the view, not from the camera or projector. 0.5, 50 cm, 500 mm or 2 dpt.";

FieldSpec distanceSpec() { return {Unit::metre, kNearestTyped.si(), kFarthestTyped.si(), 0.0, kDistanceHelp}; }

/// Anchors of a new plane: a triangle on what the region covers, at the distance it had.
PlaneDistance planeOver(const Panel& p, const Region& region, Metre distance) {
    const Size size = p.document().scene.size();
    PixelRect<CameraFrame> box{0, 0, std::max(3, size.width), std::max(3, size.height)};
    if (!region.mask.empty()) {
        const auto covered = region.mask.coveredPixels().clipped(size);
        if (!covered.empty()) box = covered;
    }
    const double x0 = box.x0, y0 = box.y0, w = box.width(), h = box.height();
    return {{DistanceAnchor{{x0 + 0.2 * w, y0 + 0.8 * h}, distance},
             DistanceAnchor{{x0 + 0.8 * w, y0 + 0.8 * h}, distance},
             DistanceAnchor{{x0 + 0.5 * w, y0 + 0.15 * h}, distance}}};
}

/// Where a plane's three points can come from besides being dragged: the depth map beneath, or a printed marker.
void planeSources(Panel& p, const Region& region) {
    const float width = (ImGui::GetContentRegionAvail().x - p.px(8)) / 2;
    const auto found = [&](const auto& plane, const std::string& words) {
        if (!plane) return say(p.state, plane.error().what, Tone::warning, p.view.time_s);
        p.commit(SetDistance{region.id, plane->distance});
        say(p.state, words, Tone::note, p.view.time_s);
    };
    ImGui::BeginDisabled(!p.document().scene.depth);
    if (ImGui::Button("Fit to depth###fitPlane", {width, 0})) {
        const auto plane = fittedPlane(p.document(), region);
        found(plane, plane ? "The plane of \"" + region.name + "\" fits the depth map to \u00b1 " +
                                 formatted(2.0 * plane->rms) + " (2 sigma), with " +
                                 formatted(plane->inliers, Unit::percent) + " of its pixels on it."
                           : std::string());
    }
    ImGui::EndDisabled();
    tooltip("The plane that fits the depth map beneath the region best; what stands on it does not count.");
    ImGui::SameLine();
    const SurfaceMarker marker{"APRILTAG_36h11", p.state.markerId, p.state.markerSide};
    if (ImGui::Button("From marker###markerPlane", {width, 0})) {
        const auto plane = markerPlane(p.document(), region, sceneCamera(p.document()), marker);
        found(plane, plane ? "The marker lies " + formatted(plane->markerDistance) +
                                 " from the lens; the plane is known to \u00b1 " +
                                 formatted(plane->distance.tolerance) + " (2 sigma)."
                           : std::string());
    }
    tooltip("The plane that a printed marker (AprilTag 36h11) lies in, found in the scene's picture.");
    const FieldSpec side{Unit::millimetre, 0.005, 2.0, 0.0,
                         "Side of the marker's black square, as measured on the print."};
    if (const auto change = numberRow(p, "  marker's side", "###markerSide", p.state.markerSide.si(), side)) {
        p.state.markerSide = Metre::fromSi(change->value);
    }
    const FieldSpec id{Unit::number, 0.0, 586.0, 1.0, "Which of the family's markers it is."};
    if (const auto change = numberRow(p, "  its number", "###markerId", p.state.markerId, id)) {
        p.state.markerId = static_cast<int>(std::lround(change->value));
    }
}

void distanceFields(Panel& p, const Region& region) {
    const Distance& distance = region.distance;
    const bool focus = std::exchange(p.state.focusDistance, false);
    const auto set = [&](const FieldChange& change, Distance next) {
        p.state.hintsUsed.insert(Hint::distance);
        p.edit(change.commits, SetDistance{region.id, std::move(next)});
    };
    rowLabel(p, "Distance", kDistanceHelp);
    const int kind = static_cast<int>(distance.index());
    const float width = ImGui::GetContentRegionAvail().x;
    if (const auto picked = choice("###kind", {"constant", "plane", "depth"}, kind, width); picked && *picked != kind) {
        const RegionPlan* planned = p.planOf(region.id);
        Metre at = planned != nullptr && isFinite(planned->nearest) ? planned->nearest : 1.0_m;
        if (const auto* constant = std::get_if<ConstantDistance>(&distance)) at = constant->value;
        if (*picked == 0) p.commit(SetDistance{region.id, ConstantDistance{at, {}}});
        if (*picked == 1) {
            const auto fitted = fittedPlane(p.document(), region);  // refused where there is no depth to fit
            p.commit(SetDistance{region.id, fitted ? fitted->distance : planeOver(p, region, at)});
        }
        if (*picked == 2 && p.document().scene.depth) p.commit(SetDistance{region.id, FromDepthMap{}});
        if (*picked == 2 && !p.document().scene.depth) {
            say(p.state, "This scene has no depth map. Load one on the Scene page first, or scan.", Tone::warning,
                p.view.time_s);
        }
    }
    const FieldSpec tolerance{Unit::metre, 0.0, 100.0, 0.001,
                              "The surface lies within the distance \u00b1 this; taken as two sigma."};
    if (const auto* constant = std::get_if<ConstantDistance>(&distance)) {
        if (const auto change =
                numberRow(p, "  from the lens", "###distance", constant->value.si(), distanceSpec(), focus)) {
            set(*change, ConstantDistance{Metre::fromSi(change->value), constant->tolerance});
        }
        if (const auto change =
                numberRow(p, "  tolerance \u00b1", "###tolerance", constant->tolerance.si(), tolerance)) {
            set(*change, ConstantDistance{constant->value, Metre::fromSi(change->value)});
        }
    } else if (const auto* plane = std::get_if<PlaneDistance>(&distance)) {
        for (std::size_t i = 0; i < plane->anchors.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));
            const std::string label = "  point " + std::to_string(i + 1);
            if (const auto change = numberRow(p, label.c_str(), "###anchor", plane->anchors[i].distance.si(),
                                              distanceSpec(), focus && i == 0)) {
                PlaneDistance next = *plane;
                next.anchors[i].distance = Metre::fromSi(change->value);
                set(*change, next);
            }
            ImGui::PopID();
        }
        if (const auto change = numberRow(p, "  tolerance \u00b1", "###tolerance", plane->tolerance.si(), tolerance)) {
            PlaneDistance next = *plane;
            next.tolerance = Metre::fromSi(change->value);
            set(*change, next);
        }
        planeSources(p, region);
    } else {
        const Metre now = std::get<FromDepthMap>(distance).tolerance;
        if (const auto change = numberRow(p, "  tolerance \u00b1", "###tolerance", now.si(), tolerance)) {
            set(*change, FromDepthMap{Metre::fromSi(change->value)});
        }
    }
}

void derived(Panel& p, const RegionPlan& planned) {
    const Plan& plan = *p.plan();
    const CompactRows compact(p);
    std::string at = formatted(planned.nearest);
    if (planned.farthest > planned.nearest) at += " \u2013 " + formatted(planned.farthest);
    derivedRow(p, "distance", at, "Of what is seen of it, nearest to farthest, its uncertainty added on both sides.");
    derivedRow(p, "  known to",
               planned.sigma > 0.0_m ? "\u00b1 " + formatted(2.0 * planned.sigma) + " (2 sigma)" : "not said",
               "Two standard deviations (sigma): of the depth map and the wearer's place, of the fitted plane, or the "
               "tolerance typed.");
    if (planned.look == Look::blur) {
        std::string least = planned.pMin ? formatted(*planned.pMin) : "blurred at rest";
        if (plan.driver == planned.id)
            least += std::string("  ") + (hasIcons() ? icon::star : "*") + " drives the sweep";
        derivedRow(p, "P_min", least, "The least lens power that blurs its nearest point.");
    }
    if (planned.look == Look::blur && planned.blurDiameterFarthest > 1.05 * planned.blurDiameter) {
        const auto arcmin = [&](Metre diameter) {
            const double radians = diameter / plan.input.eye.retina;
            return std::to_string(std::lround(radians * 10800.0 / std::numbers::pi));
        };
        derivedRow(p, "blur",
                   arcmin(planned.blurDiameter) + " \u2013 " + arcmin(planned.blurDiameterFarthest) + "\u2032",
                   "Least at its nearest point, which the power is chosen for, and most at its farthest.");
    }
    if (planned.level)
        derivedRow(p, "lit at", formatted(planned.levelPower), "Lens power while this region has light.");
    if (planned.scale != 1.0) {
        derivedRow(p, "appears", formatted(planned.scale, Unit::percent) + " of its size",
                   "Magnification by the lens: the cause of the seam.");
    }
}

}  // namespace

void selectedPage(Panel& p) {
    const Region* region = p.selected();
    if (region == nullptr) {
        p.state.focusDistance = false;
        wrapped("No region is selected. Click one in the list, or on the picture with the pointer (V).", colour::dim);
        return;
    }
    ImGui::PushID("region");
    text(region->name, colour::text, Font::strong);
    if (!region->visible) {
        ImGui::SameLine();
        text("hidden", colour::dim);
    }
    rowLabel(p, "Look");
    if (const auto look = choice("###look", {"focus", "blur", "neutral"}, static_cast<int>(region->look),
                                 ImGui::GetContentRegionAvail().x)) {
        p.commit(SetLook{region->id, static_cast<Look>(*look)});
    }
    if (region->look == Look::blur) {
        rowLabel(p, "Strength", "Lit at the end of the sweep as in the paper, or at P_min plus a strength of its own.");
        const bool own = region->strength.has_value();
        const float width = own ? p.px(84) : ImGui::GetContentRegionAvail().x;
        if (ImGui::Button(own ? "own###strengthKind" : "end of sweep###strengthKind", {width, 0})) {
            p.commit(SetStrength{region->id, own ? std::nullopt : std::optional(p.document().alpha)});
        }
        tooltip("Click to change between the end of the sweep and a strength of its own.");
        if (own) {
            ImGui::SameLine();
            const FieldSpec spec{Unit::dioptre, 0.05, 10.0, 0.01, "Power above P_min: how strongly it is blurred."};
            if (const auto change = numberField(p, "###strength", region->strength->si(), spec)) {
                p.edit(change->commits, SetStrength{region->id, Dioptre::fromSi(change->value)});
            }
        }
    }
    distanceFields(p, *region);
    followPart(p, *region);
    if (const RegionPlan* planned = p.planOf(region->id)) {
        ImGui::Dummy({1, p.px(2)});
        predictionCard(p, *region, *planned);
        derived(p, *planned);
    } else if (p.view.computed.forCurrent && p.plan() != nullptr) {
        const std::string why = whyNoPart(p.document(), *region);
        wrapped(why, region->mask.blank() ? colour::dim : colour::warn, Font::small);
    } else if (!p.view.computed.planError.empty()) {
        wrapped(p.view.computed.planError, colour::fault);
    }
    ImGui::PopID();
}

void selectedPanel(Panel& p) {
    if (p.at.selected.empty()) return;
    beginPanel("###selected", p.at.selected, colour::panel, true, true);
    selectedPage(p);
    ImGui::End();
}

}  // namespace ilf::ui
