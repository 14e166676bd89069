#include "app/headless/seams_json.h"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>

namespace ilf::app {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 4> kBlendings{"none", "linear, object", "linear, perceived", "closed form"};
constexpr std::array<const char*, 3> kSights{"hidden", "faint", "visible"};

const char* word(double weber) { return kSights[static_cast<std::size_t>(sight(weber))]; }

std::string named(const Document& document, const RegionId& id) {
    const Region* region = findRegion(document, id);
    return region != nullptr ? region->name : id;
}

template <class... Values>
std::string line(const char* pattern, Values... values) {
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), pattern, values...);
    return text.data();
}

json contrast(const SeamContrast& one) {
    return {{"weber", one.weber},
            {"csf_weighted", one.weighted},
            {"at_px", {one.at.x, one.at.y}},
            {"kind", one.gap ? "gap" : "overlap"}};
}

json bothEyes(const BothEyes& eyes) { return {{"left", contrast(eyes[0])}, {"right", contrast(eyes[1])}}; }

json shows(const std::optional<double>& speed) { return speed ? json(*speed) : json(); }

std::string shown(const std::optional<double>& speed) {
    return speed ? line("from %.0f mm/s on", *speed) : std::string("at no speed up to 10 m/s");
}

json oneSeam(const Document& document, const BorderSeam& seam) {
    json out = {{"blurred", named(document, seam.blurred)},
                {"other", named(document, seam.other)},
                {"depth_step", seam.depthStep},
                {"length_mm", seam.length.in(1.0_mm)},
                {"profiles", seam.profiles},
                {"share_looked_at", seam.sampled},
                {"now", bothEyes(seam.now)},
                {"seen", word(seam.worst())},
                {"combined_under_errors", {{"left", seam.combined[0]}, {"right", seam.combined[1]}}},
                {"eyes_apart_mm", seam.apart.in(1.0_mm)},
                {"hiding",
                 {{"shift_mm", seam.hiding.shift.in(1.0_mm)},
                  {"of_two_axes_mm", seam.hiding.axesShift.in(1.0_mm)},
                  {"blur_radius_mm", seam.hiding.blurRadius.in(1.0_mm)},
                  {"asked_mm", seam.hiding.asked.in(1.0_mm)},
                  {"width_mm", seam.hiding.width.in(1.0_mm)},
                  {"clamped", seam.hiding.clamped},
                  {"left", seam.hiding.left}}},
                {"says", seam.says}};
    for (std::size_t b = 0; b < kBlendings.size(); ++b)
        out["blendings"][kBlendings[b]] = bothEyes(seam.blendings[b]);
    for (const SeamUnderError& error : seam.errors) {
        json one = bothEyes(error.eyes);
        one["error"] = error.what;
        one["counts"] = error.counts;
        out["under_errors"].push_back(one);
    }
    return out;
}

void printMotion(std::ostream& out, const BorderMotion& motion) {
    out << line("  moving at %.0f mm/s:\n", motion.speed_mm_s)
        << line("    masks of each slot's own moment: followed %.2f %%, passing %.2f %%; shows ",
                100.0 * motion.ownPursued, 100.0 * motion.ownPassing)
        << shown(motion.ownShows_mm_s) << '\n'
        << line("    masks held for a sweep:          followed %.2f %%, passing %.2f %%; shows ",
                100.0 * motion.heldPursued, 100.0 * motion.heldPassing)
        << shown(motion.heldShows_mm_s) << '\n'
        << line("    feather for this speed (2 v T): %.1f mm\n", motion.feather_mm);
}

}  // namespace

void printSeams(std::ostream& out, const SeamsReport& report) {
    const Document& document = report.compiled.document;
    out << "Worst contrast along each border, left / right eye, of even light. Simulated.\n";
    if (report.seams.empty()) out << "There is no border between displaced light and other light.\n";
    for (std::size_t i = 0; i < report.seams.size(); ++i) {
        const BorderSeam& seam = report.seams[i];
        out << '\n'
            << named(document, seam.blurred) << " / " << named(document, seam.other)
            << line(": %s, %.0f mm, %d profiles", word(seam.worst()), seam.length.in(1.0_mm), seam.profiles)
            << (seam.sampled < 1.0 ? line(" over %.0f %% of it", 100.0 * seam.sampled) : "")
            << (seam.depthStep ? ", depth step" : "") << '\n';
        const auto row = [&](const std::string& what, const BothEyes& eyes) {
            out << line("  %-46s %6.2f / %6.2f %%   weighted %5.2f / %5.2f %%   at %.0f,%.0f / %.0f,%.0f\n",
                        what.c_str(), 100.0 * eyes[0].weber, 100.0 * eyes[1].weber, 100.0 * eyes[0].weighted,
                        100.0 * eyes[1].weighted, eyes[0].at.x, eyes[0].at.y, eyes[1].at.x, eyes[1].at.y);
        };
        for (std::size_t b = 0; b < kBlendings.size(); ++b) {
            const bool now = b == static_cast<std::size_t>(document.seam.blending);
            row(std::string(kBlendings[b]) + (now ? line(", %.0f mm (now)", document.seam.feather.in(1.0_mm)) : ""),
                seam.blendings[b]);
        }
        for (const SeamUnderError& error : seam.errors)
            row("  " + error.what + (error.counts ? "" : " (not counted)"), error.eyes);
        out << line("  %-46s %6.2f / %6.2f %%\n", "all counted errors, root of squares", 100.0 * seam.combined[0],
                    100.0 * seam.combined[1])
            << "  " << seam.says << '\n';
        if (i < report.motions.size()) printMotion(out, report.motions[i]);
    }
    out << line("\n%.0f ms\n", report.took_ms);
}

void printSeamsJson(std::ostream& out, const SeamsReport& report) {
    json all = {{"simulated", true},
                {"blending", kBlendings[static_cast<std::size_t>(report.compiled.document.seam.blending)]},
                {"feather_mm", report.compiled.document.seam.feather.in(1.0_mm)},
                {"borders", json::array()},
                {"took_ms", report.took_ms}};
    for (std::size_t i = 0; i < report.seams.size(); ++i) {
        json one = oneSeam(report.compiled.document, report.seams[i]);
        if (i < report.motions.size()) {
            const BorderMotion& m = report.motions[i];
            one["motion"] = {{"speed_mm_s", m.speed_mm_s},
                             {"own_moment", {{"pursued", m.ownPursued}, {"passing", m.ownPassing}}},
                             {"held", {{"pursued", m.heldPursued}, {"passing", m.heldPassing}}},
                             {"own_moment_shows_mm_s", shows(m.ownShows_mm_s)},
                             {"held_shows_mm_s", shows(m.heldShows_mm_s)},
                             {"feather_mm", m.feather_mm}};
        }
        all["borders"].push_back(one);
    }
    out << all.dump(2) << '\n';
}

}  // namespace ilf::app
