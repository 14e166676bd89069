#include "ui/prediction_card.h"

#include <array>
#include <cmath>

#include "ui/units.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

/// The figure whose +- the sentence gives, as it is written.
struct Headline {
    const Predicted* figure;
    const char* unit;
    double times = 1.0;  ///< what is written per SI unit
};

Headline headline(const PredictedRegion& made) {
    if (made.said.about == Saying::seam) return {&made.seen.seam, " %", 100.0};
    return {&made.seen.blur_arcmin, "\u2032"};
}

std::string withUnit(double value, const char* unit) {
    char text[48];
    std::snprintf(text, sizeof text, value < 0.995 ? "%.2f%s" : value < 9.95 ? "%.1f%s" : "%.0f%s", value, unit);
    return text;
}

const char* cause(ErrorSource source) {
    switch (source) {
    case ErrorSource::distance:
        return "The tolerances of this region's distance and of what the eye looks at. Measure them more closely.";
    case ErrorSource::pupil:
        return "A pupil differs by 1 mm from person to person and with the light.";
    case ErrorSource::registration:
        return "Light of one level may fall 0.25 mm beside that of another: assumed. It moves seams, not blur.";
    case ErrorSource::model:
        break;
    }
    return "The lens's power in this level's slots, and how real eyes differ from the reduced one (rays through the "
           "Navarro eye).";
}

/// A row of the "why": how much one source contributes, in figures and as a bar.
void causeRow(Panel& p, ErrorSource source, const Headline& of) {
    rowLabel(p, (std::string("  ") + word(source)).c_str(), cause(source));
    const double share = of.figure->share(source);
    const float height = ImGui::GetFrameHeight(), from = ImGui::GetCursorScreenPos().x, bar = p.px(64);
    const float middle = ImGui::GetCursorScreenPos().y + 0.5f * height, half = p.px(3);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled({from, middle - half}, {from + bar, middle + half}, colour::line, half);
    if (share > 0.0) {
        const float length = std::max(2.0f * half, bar * static_cast<float>(share));
        draw.AddRectFilled({from, middle - half}, {from + length, middle + half}, colour::derived, half);
    }
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + bar + p.px(8));
    const double part = of.times * of.figure->part(source);
    text(part > 0.0 ? "\u00b1 " + withUnit(part, of.unit) : "none", part > 0.0 ? colour::derived : colour::dim);
    tooltip(cause(source));
}

void why(Panel& p, const PredictedRegion& made) {
    const Headline of = headline(made);
    const double error = of.times * of.figure->error();
    ImGui::PushFont(font(Font::small));
    ImGui::PushStyleColor(ImGuiCol_Text, colour::dim);
    ImGui::SetNextItemOpen(p.state.whyOpen);
    const std::string label = "why \u00b1 " + withUnit(error, of.unit) + "###why";
    p.state.whyOpen =
        ImGui::TreeNodeEx(label.c_str(), ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_SpanAvailWidth);
    ImGui::PopStyleColor();
    ImGui::PopFont();
    tooltip("Each source alone, the larger of its two directions; together the root of the sum of their squares.");
    if (!p.state.whyOpen) return;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ImGui::GetStyle().ItemSpacing.x, 0));
    for (std::size_t i = 0; i < kErrorSources; ++i)
        causeRow(p, static_cast<ErrorSource>(i), of);
    ImGui::PopStyleVar();
}

void figureRows(Panel& p, const PredictedRegion& made) {
    const RegionPrediction& seen = made.seen;
    const auto with = [](const Predicted& v, const char* unit) { return plusMinus(v.value, v.error()) + unit; };
    const auto whole = [](double v) { return std::to_string(std::lround(v)); };
    derivedRow(p, "blur", with(seen.blur_arcmin, "\u2032") + ", " + with(seen.defocus_D, " D"),
               "Predicted diameter of the blur disc, and defocus, at the point that shows the look least.");
    if (!seen.camera) {
        derivedRow(p, "acuity", "20/" + whole(seen.snellen.value) + " \u00b1 " + whole(seen.snellen.error()),
                   "Estimated: 0.65 arcmin of resolution for each millimetre of pupil and dioptre (Smith 1991), with "
                   "the 1 arcmin of a sharp eye. People differ by a factor of 1.5.");
        derivedRow(p, "print keeps", plusMinusPercent(seen.contrast),
                   "Predicted contrast of print with 7.5 lines per degree, such as 3 mm letters at 0.5 m; sharp it has "
                   "59 %.");
        if (seen.look == Look::blur)
            derivedRow(p, "  looked at", plusMinusPercent(seen.contrastLooked),
                       "The same for an eye that looks straight at it and does all it can to read it.");
    }
    if (std::abs(seen.ambientLeak.value) >= 5e-4)
        derivedRow(p, "  by the room", plusMinusPercent(seen.ambientLeak),
                   "What ambient light, seen through the whole sweep, adds to that contrast or takes away.");
    if (seen.seams)
        derivedRow(p, "seam", plusMinusPercent(seen.seam),
                   "Predicted at worst where it meets light of another level: two lens axes see one blended border in "
                   "two places, and registration errs. The Seam page has each border.");
    derivedRow(p, "light", formatted(seen.light, Unit::percent), "Of steady light, for every region alike.");
}

}  // namespace

CompactRows::CompactRows(const Panel& p) {
    const ImGuiStyle& style = ImGui::GetStyle();
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(style.FramePadding.x, p.px(1)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(style.ItemSpacing.x, p.px(3)));
}

CompactRows::~CompactRows() { ImGui::PopStyleVar(2); }

const PredictedRegion& predictedRegion(Panel& p, const Region& region, const RegionPlan& planned) {
    const Document& document = p.document();
    const PredictedRegion* kept = p.state.predicted.get();
    const bool same = kept != nullptr && kept->region == region && kept->seam == document.seam &&
                      kept->wearer == document.wearer && kept->scale == document.scene.scale && kept->plan == *p.plan();
    if (!same) {
        const RegionPrediction seen = predicted(*p.plan(), planned, document);
        p.state.predicted = std::make_shared<const PredictedRegion>(
            PredictedRegion{*p.plan(), region, document.seam, document.wearer, document.scene.scale, seen,
                            statement(*p.plan(), planned, seen)});
    }
    return *p.state.predicted;
}

void predictionCard(Panel& p, const Region& region, const RegionPlan& planned) {
    const PredictedRegion& made = predictedRegion(p, region, planned);
    const float pad = p.px(10), width = ImGui::GetContentRegionAvail().x;
    const ImVec2 from = ImGui::GetCursorScreenPos();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.ChannelsSplit(2);
    draw.ChannelsSetCurrent(1);
    ImGui::Dummy({1, pad - ImGui::GetStyle().ItemSpacing.y});
    ImGui::Indent(pad);
    const auto said = [&](const std::string& words, ImU32 ink, Font which) {
        ImGui::PushTextWrapPos(ImGui::GetWindowContentRegionMax().x - pad);
        text(words, ink, which);
        ImGui::PopTextWrapPos();
    };
    heading("PREDICTED");
    tooltip("Worked out from distances, wearer and lens. Nothing of it was measured.");
    said(made.said.text, made.said.warns ? colour::warn : colour::text, Font::body);
    if (!made.said.help.empty()) said(made.said.help, colour::text, Font::small);
    if (!made.said.privacy.empty())
        said(made.said.privacy, made.said.privacyWarns ? colour::warn : colour::good, Font::small);
    why(p, made);
    ImGui::Unindent(pad);
    ImGui::Dummy({1, pad - ImGui::GetStyle().ItemSpacing.y});
    const ImVec2 to{from.x + width, ImGui::GetCursorScreenPos().y - ImGui::GetStyle().ItemSpacing.y};
    draw.ChannelsSetCurrent(0);
    const float rounding = ImGui::GetStyle().FrameRounding;
    draw.AddRectFilled(from, to, colour::raised, rounding);
    draw.AddRectFilled(from, {from.x + p.px(3), to.y}, made.said.warns ? colour::warn : lookColour(planned.look),
                       rounding);
    draw.ChannelsMerge();
    const CompactRows compact(p);
    figureRows(p, made);
}

}  // namespace ilf::ui
