// How much light there is and how honest each slot: waves, error allowed, and what the plan says of it in words.
#include <algorithm>
#include <array>

#include "core/plan/projector.h"
#include "ui/chart_frame.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

/// Draws a choice of words; gives the index of the one picked.
template <std::size_t N>
std::optional<std::size_t> combo(Panel& p, const char* label, const char* id, const std::array<const char*, N>& names,
                                 std::size_t current, const char* help) {
    rowLabel(p, label, help);
    ImGui::SetNextItemWidth(-1);
    std::optional<std::size_t> picked;
    if (!ImGui::BeginCombo(id, names[current])) return picked;
    for (std::size_t i = 0; i < N; ++i) {
        if (ImGui::Selectable(names[i], i == current) && i != current) picked = i;
    }
    ImGui::EndCombo();
    return picked;
}

void chooseWaves(Panel& p, const Rig& rig) {
    constexpr std::array<WaveMode, 5> kModes{WaveMode::continuous, WaveMode::shaped, WaveMode::slotAware,
                                             WaveMode::paper, WaveMode::idealSine};
    constexpr std::array<const char*, 5> kNames{"continuous", "shaped, learnt", "recorded, by slots",
                                                "recorded, paper's rule", "ideal sine"};
    std::size_t current = 0;
    while (current + 1 < kModes.size() && kModes[current] != rig.waves)
        ++current;
    if (const auto picked = combo(p, "Waves", "###waves", kNames, current, "How the lens's wave is found.")) {
        Rig next = rig;
        next.waves = kModes[*picked];
        p.commit(SetRig{next});
    }
}

void chooseProjector(Panel& p, const Rig& rig) {
    constexpr std::array<const char*, 2> kNames{"high speed, 8 bits", "LightCrafter 4500"};
    const auto kind = combo(p, "Projector", "###projectorKind", kNames, static_cast<std::size_t>(rig.kind),
                            "What a slot can be: its shortest time and its bits.");
    if (kind) {
        const auto chosen = static_cast<ProjectorKind>(*kind);
        p.commit(SetRig{withProjector(rig, chosen, chosen == ProjectorKind::lightCrafter4500 ? 6 : 8)});
    }
    if (rig.kind != ProjectorKind::lightCrafter4500) return;
    constexpr std::array<const char*, 8> kBits{"1", "2", "3", "4", "5", "6", "7", "8"};
    const auto bits = combo(p, "Bits", "###bits", kBits, static_cast<std::size_t>(rig.bits - 1),
                            "Of each slot's picture: fewer bits, more and shorter slots.");
    if (bits) p.commit(SetRig{withProjector(rig, rig.kind, static_cast<int>(*bits) + 1)});
}

void drawCurve(Panel& p, const Plan& plan, const std::vector<LightPoint>& curve) {
    if (curve.empty()) return;
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const double width = static_cast<double>(ImGui::GetContentRegionAvail().x), height = 150 * p.scale;
    ChartRange light{0.0, 5.0};
    std::vector<ChartPoint> points;
    for (const LightPoint& point : curve) {
        if (point.light <= 0.0) continue;
        points.push_back({point.budget.si(), 100.0 * point.light});
        light.high = std::max(light.high, 110.0 * point.light);
    }
    const ChartFrame frame = chartFrame(
        p, {static_cast<double>(from.x) - 10 * p.scale, static_cast<double>(from.y), width + 20 * p.scale, height},
        "LIGHT by allowed error", formatted(plan.light, Unit::percent) + " now",
        {curve.front().budget.si(), curve.back().budget.si()}, light, "D", "%", true);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    chartCurve(draw, frame, points, colour::text, p.px(1.8));
    const ImVec2 now =
        frame.at(std::clamp(plan.input.rig.powerBudget.si(), curve.front().budget.si(), curve.back().budget.si()),
                 100.0 * plan.light);
    draw.AddLine({now.x, static_cast<float>(frame.plot.bottom())}, now, faded(colour::focus, 0.7), p.px(1));
    draw.AddCircleFilled(now, p.px(4.5), colour::focus);
    ImGui::Dummy({1.0f, static_cast<float>(height)});
}

/// A row for one number of the rig.
void rigNumber(Panel& p, const char* label, const char* id, double value, FieldSpec spec, void (*put)(Rig&, double)) {
    if (const auto change = numberRow(p, label, id, value, spec)) {
        Rig next = p.document().rig;
        put(next, change->value);
        p.edit(change->commits, SetRig{next});
    }
}

void roomRows(Panel& p, const Rig& rig) {
    chooseProjector(p, rig);
    rigNumber(p, "Ambient lx", "###ambient", rig.room.ambient_lx,
              {Unit::number, 0.0, 1e5, 1.0, "Light from elsewhere on the lit area, in lux."},
              [](Rig& r, double v) { r.room.ambient_lx = v; });
    rigNumber(p, "Lumens", "###lumens", rig.room.projector_lm,
              {Unit::number, 1.0, 1e5, 2.0, "The projector's light when it is steady."},
              [](Rig& r, double v) { r.room.projector_lm = v; });
    rigNumber(p, "Lit m\u00b2", "###litArea", rig.room.litArea_m2,
              {Unit::number, 0.01, 100.0, 0.01, "The area that light falls on, in square metres."},
              [](Rig& r, double v) { r.room.litArea_m2 = v; });
}

void levelRows(Panel& p, const Plan& plan) {
    for (const Level& level : plan.levels) {
        const std::string kind = level.kind == LevelKind::focus ? "focus " : "blur ";
        derivedRow(p, (kind + formatted(level.power)).c_str(),
                   "\u00b1 " + formatted(level.rmsError.si(), Unit::dioptre) + " rms in " +
                       std::to_string(level.slots.size()) + " slots",
                   "Predicted lens power in this level's slots against what was asked.");
    }
}

void workRow(const PlanWork& work) {
    wrapped(std::to_string(work.plans) + " plans: waves chosen " + std::to_string(work.wavesChosen) + ", kept " +
                std::to_string(work.wavesKept) + "; schedules made " + std::to_string(work.schedulesMade) + ", kept " +
                std::to_string(work.schedulesKept) + ".",
            colour::dim, Font::small);
}

}  // namespace

void lightPage(Panel& p) {
    const Rig& rig = p.document().rig;
    chooseWaves(p, rig);
    rigNumber(p, "Error", "###powerBudget", rig.powerBudget.si(),
              {Unit::dioptre, 0.005, 2.0, 0.002, "Slots light a level while the lens's rms error stays below this."},
              [](Rig& r, double v) { r.powerBudget = Dioptre::fromSi(v); });
    const Plan* plan = p.plan();
    const PlanReport* report = p.view.computed.report.get();
    if (plan != nullptr) {
        levelRows(p, *plan);
        for (const std::string& warning : plan->warnings)
            wrapped(warning, colour::warn, Font::small);
        if (report != nullptr) {
            drawCurve(p, *plan, report->curve);
            wrapped(report->why, colour::text, Font::small);
            for (const std::string& help : report->help)
                wrapped(help, colour::good, Font::small);
        }
    }
    roomRows(p, rig);
    if (plan == nullptr) return;
    if (report != nullptr) {
        for (const PlanNote& note : report->notes) {
            wrapped(note.text, note.warns ? colour::warn : colour::dim, Font::small);
            tooltip("Predicted: " + note.model + ".");
        }
    }
    workRow(plan->work);
}

}  // namespace ilf::ui
