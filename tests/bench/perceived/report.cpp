#include "tests/bench/perceived/report.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>

#include "tests/bench/perceived/engine_rows.h"
#include "tests/bench/perceived/timing.h"

namespace ilf::bench {
namespace {

constexpr const char* kEye = "four objects; eye";
constexpr const char* kCamera = "four objects; camera";

std::string number(double value, const char* format = "%.3g") {
    if (std::isnan(value)) return "-";
    if (std::isinf(value)) return "inf";
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string decibels(double value, double floor) {
    if (std::isinf(value)) return "exact";
    return drowned(value, floor) ? "above " + number(floor - kAboveFloor, "%.0f") + " dB (floor)"
                                 : number(value, "%.1f") + " dB";
}
/// What of a PSNR is known.
double known(double value, double floor) { return std::isnan(floor) ? value : std::min(value, floor - kAboveFloor); }

std::string percent(double share) { return std::isnan(share) ? "-" : number(100.0 * share, "%.0f") + " %"; }

class Report {
public:
    explicit Report(const Table& table) : table_(table) {}

    std::string text;

    void figures() {
        text += "| figure | asked | measured | |\n| --- | --- | --- | --- |\n";
        timeAndError("seam; while dragging", full("seam", Rung::dragging), 1.0, 80.0);
        timeAndError("four objects, eye; while dragging", full(kEye, Rung::dragging), 3.5, 45.0);
        timeAndError("four objects, camera; while dragging", full(kCamera, Rung::dragging), 3.5, 42.0);
        timeAndError("four objects, eye; at rest", full(kEye, Rung::rest), 8.0, 52.0);
        timeAndError("four objects, camera; at rest", full(kCamera, Rung::rest), 8.0, 50.0);
        timeAndError("four objects, eye; refined", full(kEye, Rung::idle), kNothing, 58.0);
        timeAndError("four objects, camera; refined", full(kCamera, Rung::idle), kNothing, 56.0);
        const Row* twice = full("everything lit twice", Rung::dragging);
        timeAndError("everything lit twice; while dragging", twice, 10.0, 40.0);
        if (twice) most("everything lit twice; p95, ms", 16.7, twice->times.p95);
        band("boundary band while dragging", Rung::dragging, 38.0);
        band("boundary band at rest", Rung::rest, 47.0);
        band("boundary band refined", Rung::idle, 52.0);
        dabs();
        if (const Row* row = full("nothing to blur", Rung::dragging)) most("P = 0 everywhere, ms", 0.5, row->times.p50);
        nothingChanged();
        double geometry = 0.0;
        for (const char* scene : {kEye, kCamera})
            if (const Row* row = at(scene, Rung::dragging, edit::kGeometry, 2))
                geometry = std::max(geometry, row->geometry);
        if (geometry > 0.0) most("after a distance moved: geometry, 2 threads, ms", 5.0, geometry);
        plane();
        scaling("slots", "slot more at equal lit area, %", 8.0);
        scaling("radius", "r = 40 against r = 8, times", 1.4);
        scaling("pixels", "exponent of pixels, 512 to 2048 wide", 1.15);
    }

    void scenes() {
        text += "\n| full frame, 2 threads | while dragging | at rest | refined | dab 32, 1 thread | filter2D | "
                "gather, 1 thread |\n"
                "| --- | --- | --- | --- | --- | --- | --- |\n";
        std::vector<std::string> seen;
        for (const Row& row : table_.rows()) {
            if (row.section != "scene" || std::ranges::find(seen, row.scene) != seen.end()) continue;
            seen.push_back(row.scene);
            text += "| " + row.scene;
            for (const Rung rung : kRungs)
                text += " | " + cell(full(row.scene, rung));
            text += " | " + cell(at(row.scene, Rung::dragging, edit::dab(32, false), 1));
            text += " | " + cell(table_.find("baseline", row.scene, "filter2D", "full frame", 2));
            text += " | " + cell(table_.find("baseline", row.scene, "gather", "full frame", 1)) + " |\n";
        }
    }

    void machine(double loadBefore) {
        double peak = 0.0, one = 0.0, two = 0.0;
        int contended = 0, all = 0;
        for (const Row& row : table_.rows()) {
            if (row.unit == "GFLOP/s") peak = std::max(peak, row.figure);
            if (row.unit == "GB/s" && row.what != "9 MB") (row.threads == 1 ? one : two) = row.figure;
            if (row.times.repetitions == 0) continue;
            ++all;
            contended += row.times.others > kContended ? 1 : 0;
        }
        text += "\nCalibration: " + number(peak) + " GFLOP/s of multiply-adds on one thread, triad " + number(one) +
                " GB/s on one and " + number(two) + " on two. ";
        text += contended == 0 ? "No row was measured while other programs ran"
                               : std::to_string(contended) + " of " + std::to_string(all) +
                                     " rows were measured while other programs took a processor's " +
                                     number(100.0 * kContended, "%.0f") + " % or more: **contended**";
        text += " (load average " + number(loadBefore, "%.2f") + " before).\n";
    }

private:
    const Row* at(const std::string& scene, Rung rung, const std::string& what, int threads) const {
        return table_.find("scene", scene, std::string(word(rung)), what, threads);
    }
    const Row* full(const std::string& scene, Rung rung) const { return at(scene, rung, edit::kFull, 2); }

    static std::string cell(const Row* row) {
        if (!row) return "-";
        std::string text = number(row->times.p50) + " ms";
        if (!std::isnan(row->errors.psnr)) text += ", " + decibels(row->errors.psnr, row->errors.floor);
        return text;
    }

    void line(const std::string& figure, const std::string& asked, const std::string& measured, bool met,
              const std::string& limit = {}) {
        text +=
            "| " + figure + " | " + asked + " | " + measured + " | " + (met ? "met" : "**missed**" + limit) + " |\n";
    }
    void most(const std::string& figure, double asked, double measured) {
        line(figure, "<= " + number(asked), number(measured), measured <= asked);
    }
    void timeAndError(const std::string& figure, const Row* row, double milliseconds, double decibel) {
        if (!row) return;
        const bool quick = std::isnan(milliseconds) || row->times.p50 <= milliseconds;
        const bool right = known(row->errors.psnr, row->errors.floor) >= decibel;
        const std::string limit = quick
                                      ? ": error"
                                      : ": its exact sums would take " + percent(row->ofFma) +
                                            " of that time at the machine's peak, its bytes " + percent(row->ofMemory);
        line(figure,
             (std::isnan(milliseconds) ? "" : "<= " + number(milliseconds) + " ms, ") + ">= " + number(decibel) + " dB",
             number(row->times.p50) + " ms, " + decibels(row->errors.psnr, row->errors.floor), quick && right, limit);
    }
    void band(const std::string& figure, Rung rung, double asked) {
        const Row* worst = nullptr;
        for (const char* scene : {kEye, kCamera}) {
            const Row* row = full(scene, rung);
            if (row && !std::isnan(row->errors.band) && (!worst || row->errors.band < worst->errors.band)) worst = row;
        }
        if (!worst) return;
        line(figure + ", four objects, the worse of eye and camera", ">= " + number(asked) + " dB",
             decibels(worst->errors.band, worst->errors.bandFloor),
             known(worst->errors.band, worst->errors.bandFloor) >= asked);
    }
    void dabs() {
        for (const bool mask : {false, true}) {
            double worst = kNothing;
            for (const char* scene : {kEye, kCamera, "seam"})
                if (const Row* row = at(scene, Rung::dragging, edit::dab(32, mask), 1))
                    worst = std::isnan(worst) ? row->times.p50 : std::max(worst, row->times.p50);
            if (std::isnan(worst)) continue;
            most(std::string("dab of 32 px, ") + (mask ? "outline and light" : "light") +
                     ", 1 thread, while dragging, ms",
                 0.2, worst);
        }
    }
    void nothingChanged() {
        double worst = 0.0;
        int computed = 0, found = 0;
        for (const Row& row : table_.rows()) {
            if (row.section != "scene" || row.what != edit::kNothing) continue;
            worst = std::max(worst, row.times.p50);
            computed = std::max(computed, row.computed);
            ++found;
        }
        if (found > 0)
            line("nothing changed, worst scene", "<= 0.02 ms, 0 tiles",
                 number(worst) + " ms, " + std::to_string(computed) + " tiles", worst <= 0.02 && computed == 0);
    }
    void plane() {
        const Row* row = table_.find("plane", "1 plane", "engine at rest", "r = 20", 1);
        if (!row) return;
        line("one plane, r = 20, against filter2D", ">= 15x at >= 58 dB",
             number(row->ratio) + "x, " + number(row->errors.psnr, "%.1f") + " dB (" + number(row->times.p50) + " ms)",
             row->ratio >= 15.0 && row->errors.psnr >= 58.0,
             ": exact sums at peak take " + percent(row->ofFma) + " of it");
    }
    void scaling(const std::string& family, const std::string& figure, double asked) {
        const Row* row = table_.find("scaling", "all", std::string(word(Rung::dragging)), family, 1);
        if (row) most(figure, asked, row->figure);
    }

    const Table& table_;
};

}  // namespace

std::string report(const Table& table, double loadBefore) {
    Report made(table);
    made.figures();
    made.scenes();
    made.machine(loadBefore);
    return made.text;
}

}  // namespace ilf::bench
