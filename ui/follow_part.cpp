#include "ui/follow_part.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/as_text.h"
#include "core/track/moved_mask.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

constexpr int kMostStream = 65535;  // devices/osc/pose_message.h
constexpr std::string_view kStream = "/pose/";
constexpr std::array kDictionaries{"APRILTAG_36h11", "APRILTAG_25h9", "APRILTAG_16h5", "APRILTAG_36h10",
                                   "4X4_50",         "4X4_250",       "5X5_100",       "5X5_250",
                                   "6X6_250",        "7X7_250",       "ARUCO_ORIGINAL"};

const char* lookWord(Follow::WhenLost whenLost) {
    switch (whenLost) {
    case Follow::WhenLost::blur:
        return "blurred";
    case Follow::WhenLost::neutral:
        return "neutral";
    case Follow::WhenLost::focus:
        return "sharp";
    }
    return "";
}

std::string seconds(Second time) {
    return time < 1.0_s ? asText("%.0f ms", 1e3 * time.si()) : asText("%.3g s", time.si());
}

double movedBy(const FollowedNow& now) {
    return std::hypot(middleOf(now.to).x - middleOf(now.from).x, middleOf(now.to).y - middleOf(now.from).y);
}

/// What a region follows first: private things that are blurred stay so when lost, all others get no light of their
/// own.
Follow newFollow(const Region& region) {
    Follow follow;
    follow.whenLost = region.look == Look::blur ? Follow::WhenLost::blur : Follow::WhenLost::neutral;
    return follow;
}

/// The marker that was found nearest to the region in the scene's picture, if there is any.
std::optional<MarkerTarget> nearestMarker(const Panel& p, const Region& region) {
    const auto middle = middleOf(region.mask);
    std::optional<MarkerTarget> nearest;
    double least = 0.0;
    for (const MarkerFound& found : p.view.follow.markers) {
        const double away = std::hypot(found.middle.x - middle.x, found.middle.y - middle.y);
        if (!found.inScene || (nearest && away >= least)) continue;
        least = away;
        nearest = MarkerTarget{found.dictionary, found.id};
    }
    return nearest;
}

/// What a look for markers gave: the nearest one is followed, or it is said that there is none.
void takeMarker(Panel& p, const Region& region) {
    p.state.markerFor.clear();
    const auto nearest = nearestMarker(p, region);
    Follow follow = region.follow.value_or(newFollow(region));
    follow.target = nearest.value_or(MarkerTarget{});
    p.commit(SetFollow{region.id, follow});
    if (region.locked) return;  // refused, which is said
    const MarkerTarget& marker = std::get<MarkerTarget>(follow.target);
    const std::string name = marker.dictionary + " number " + std::to_string(marker.id);
    const bool live = std::ranges::any_of(p.view.follow.markers, [](const MarkerFound& m) { return !m.inScene; });
    if (nearest) return say(p.state, "\"" + region.name + "\" follows " + name + ".", Tone::note, p.view.time_s);
    say(p.state,
        live ? "Markers are seen in the live picture only: grab it (F5), then pick one under \"seen now\"."
             : "No marker is seen yet: lay one on the thing and grab the picture (F5), or type which one it will be.",
        Tone::warning, p.view.time_s);
}

int streamNumber(const std::string& address) {
    int number = 1;
    if (address.starts_with(kStream))
        std::from_chars(address.data() + kStream.size(), address.data() + address.size(), number);
    return number;
}

PixelRect<CameraFrame> patchOf(const Panel& p, const Region& region) {
    return region.mask.coveredPixels().clipped(p.document().scene.size());
}

void set(Panel& p, const Region& region, const Follow& follow, bool commits = true) {
    p.edit(commits, SetFollow{region.id, follow});
}

void markerRows(Panel& p, const Region& region, const MarkerTarget& marker) {
    const FollowView& view = p.view.follow;
    const auto use = [&](const MarkerTarget& next) {
        Follow follow = *region.follow;
        follow.target = next;
        set(p, region, follow);
    };
    rowLabel(p, "  dictionary", "The family of printed markers it is of, by OpenCV's name.");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("###dictionary", marker.dictionary.c_str())) {
        for (const char* name : kDictionaries) {
            if (ImGui::Selectable(name, marker.dictionary == name)) use({name, marker.id});
        }
        ImGui::EndCombo();
    }
    const FieldSpec spec{Unit::number, 0.0, 1000.0, 1.0, "Which of the dictionary's markers it is."};
    if (const auto change = numberRow(p, "  its number", "###marker", marker.id, spec); change && change->commits)
        use({marker.dictionary, static_cast<int>(std::lround(change->value))});
    rowLabel(p, "  seen now", "Markers in the scene's picture and the live one. Those of the scene's can be followed.");
    const char* words = view.looking           ? "looking..."
                        : !view.looked         ? "look"
                        : view.markers.empty() ? "none"
                                               : "pick one";
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("###seen", words)) {
        if (ImGui::IsWindowAppearing() && !view.looking) p.requests.push_back(LookForMarkers{});
        if (view.looking) text("Looking...", colour::dim);
        if (!view.looking && view.markers.empty()) text("No marker is seen.", colour::dim);
        for (const MarkerFound& found : view.markers) {
            const std::string name =
                found.dictionary + "  " + std::to_string(found.id) + (found.inScene ? "" : "  (live only: grab first)");
            if (ImGui::Selectable(name.c_str(), marker == MarkerTarget{found.dictionary, found.id}))
                use({found.dictionary, found.id});
        }
        ImGui::EndCombo();
    }
}

void planarRows(Panel& p, const Region& region, const PlanarTarget& target) {
    rowLabel(p, "  as it looks", "How the flat thing looks where the region lies, in the scene's picture.");
    const auto patch = patchOf(p, region);
    const bool same = patch == target.patch;
    ImGui::BeginDisabled(same);
    const std::string words = std::to_string(target.patch.width()) + " x " + std::to_string(target.patch.height()) +
                              " px" + (same ? "" : ": learn anew") + "###learn";
    if (ImGui::Button(words.c_str(), {-1, 0})) {
        Follow follow = *region.follow;
        follow.target = PlanarTarget{patch};
        set(p, region, follow);
    }
    ImGui::EndDisabled();
    tooltip("Learnt from the scene's picture where the region lies. Grab a picture (F5) to learn it as the camera sees "
            "it now.");
}

void streamRows(Panel& p, const Region& region, const StreamTarget& stream) {
    const FieldSpec spec{Unit::number, 0.0, kMostStream, 1.0,
                         "N of the address /pose/N, to which x, y (0 to 1 of the picture), z, rotation (degrees) and "
                         "confidence are sent. The middle of what is painted goes to x, y; z is not used: the region "
                         "keeps its distance."};
    const auto change = numberRow(p, "  pose number", "###stream", streamNumber(stream.address), spec);
    if (!change || !change->commits) return;
    Follow follow = *region.follow;
    follow.target = StreamTarget{std::string(kStream) + std::to_string(std::lround(change->value))};
    set(p, region, follow);
}

void lossRows(Panel& p, const Region& region) {
    const Follow& now = *region.follow;
    rowLabel(p, "When lost",
             "The look it has when its target has been lost for a while. Private things stay blurred, "
             "guidance goes neutral.");
    if (const auto picked = choice("###lost", {"blur", "neutral", "sharp"}, static_cast<int>(now.whenLost),
                                   ImGui::GetContentRegionAvail().x)) {
        Follow follow = now;
        follow.whenLost = static_cast<Follow::WhenLost>(*picked);
        set(p, region, follow);
    }
    const auto time = [&](const char* label, const char* id, Second value, const char* help, Second Follow::* which) {
        const FieldSpec spec{Unit::millisecond, 0.0, 60.0, 0.005, help};
        if (const auto change = numberRow(p, label, id, value.si(), spec)) {
            Follow follow = now;
            follow.*which = Second::fromSi(change->value);
            set(p, region, follow, change->commits);
        }
    };
    time("  stays for", "###hold", now.hold, "It stays where it was last seen for so long.", &Follow::hold);
    time("  then fades in", "###fade", now.fade, "Then its look changes within this time.", &Follow::fade);
}

}  // namespace

FollowWords followWords(const FollowView& view, const Region& region) {
    const auto now = std::ranges::find(view.regions, region.id, &FollowedNow::region);
    const bool stream = std::holds_alternative<StreamTarget>(region.follow->target);
    if (now == view.regions.end()) {
        if (stream && view.oscPort == 0)
            return {"no poses are heard", Tone::warning, "Start the studio with --osc-port 9720 to hear them."};
        if (!stream && !view.camera)
            return {"not looked for", Tone::note,
                    "No live picture: it stays where it was painted. Open a camera and let it run live."};
        return {"begins...", Tone::note, {}};
    }
    if (!now->trouble.empty()) return {"cannot follow", Tone::warning, now->trouble};
    switch (now->state) {
    case FollowState::following:
        return {"following, " + formatted(now->confidence, Unit::percent) + " sure", Tone::note,
                formatted(movedBy(*now), Unit::pixel) + " from where it was painted."};
    case FollowState::holding:
        return {"not seen: stays", Tone::warning, {}};
    case FollowState::fading:
        return {"not seen: turns " + std::string(lookWord(region.follow->whenLost)), Tone::warning, {}};
    case FollowState::lost:
        break;
    }
    return {"lost: " + std::string(lookWord(region.follow->whenLost)), Tone::error, {}};
}

std::string lossWords(const Region& region) {
    const Follow& follow = *region.follow;
    return "Lost, it stays for " + seconds(follow.hold) + ", then turns " + lookWord(follow.whenLost) + " within " +
           seconds(follow.fade) + ".";
}

void followPart(Panel& p, const Region& region) {
    if (region.id == kBackgroundId) return;
    ImGui::PushID("follow");
    rowLabel(p, "Follows", "What the region moves along with, as the live camera sees it or another program says.");
    const int kind = region.follow ? static_cast<int>(region.follow->target.index()) + 1 : 0;
    const auto picked =
        choice("###follows", {"nothing", "marker", "flat", "pose"}, kind, ImGui::GetContentRegionAvail().x);
    if (picked && *picked != kind) {
        Follow follow = region.follow.value_or(newFollow(region));
        p.state.markerFor.clear();
        if (*picked == 0) p.commit(SetFollow{region.id, std::nullopt});
        if (*picked == 1) {
            p.requests.push_back(LookForMarkers{});
            p.state.markerFor = region.id;
        }
        if (*picked == 2) follow.target = PlanarTarget{patchOf(p, region)};
        if (*picked == 3) follow.target = StreamTarget{};
        if (*picked > 1) set(p, region, follow);
    } else if (p.state.markerFor == region.id) {
        const bool seen = !p.view.follow.looking && p.view.follow.looked;
        if (seen) takeMarker(p, region);
        if (!seen) wrapped("Looking for markers...", colour::dim, Font::small);
    }
    if (region.follow) {
        const FollowWords words = followWords(p.view.follow, region);
        const ImU32 ink = words.tone == Tone::error     ? colour::fault
                          : words.tone == Tone::warning ? colour::warn
                                                        : colour::derived;
        rowLabel(p, "  now");
        text(words.words, ink);
        if (!words.help.empty()) wrapped(words.help, colour::dim, Font::small);
        if (p.view.follow.behind)
            wrapped("What is on show follows as it was put there; edits wait for TAKE.", colour::dim, Font::small);
        if (const auto* marker = std::get_if<MarkerTarget>(&region.follow->target)) markerRows(p, region, *marker);
        if (const auto* target = std::get_if<PlanarTarget>(&region.follow->target)) planarRows(p, region, *target);
        if (const auto* stream = std::get_if<StreamTarget>(&region.follow->target)) streamRows(p, region, *stream);
        lossRows(p, region);
        wrapped(lossWords(region), colour::dim, Font::small);
    }
    ImGui::PopID();
}

}  // namespace ilf::ui
