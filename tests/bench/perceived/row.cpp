#include "tests/bench/perceived/row.h"

#include <algorithm>
#include <cmath>

namespace ilf::bench {
namespace {

std::string cell(double value, const char* format) {
    if (!std::isfinite(value)) return value > 0.0 ? "inf" : "";
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string decibels(double value, double floor) {
    return cell(std::isnan(floor) ? value : std::min(value, floor - kAboveFloor), "%.1f");
}
std::string drownedWord(const Errors& errors) {
    if (drowned(errors.psnr, errors.floor)) return "floor";
    return drowned(errors.band, errors.bandFloor) ? "band at floor" : "";
}

std::string quietWord(const Times& times) {
    if (times.repetitions == 0) return "";
    return times.others > kContended ? "contended" : "quiet";
}

}  // namespace

Row& Table::add(Row row) {
    rows_.push_back(std::move(row));
    const Row& r = rows_.back();
    std::string line = r.section + " | " + r.scene + " | " + r.method + " | " + r.what;
    if (r.threads > 0) line += " | " + std::to_string(r.threads) + "T";
    if (r.times.repetitions > 0) {
        line += " | " + cell(r.times.p50, "%.4g") + " ms (p95 " + cell(r.times.p95, "%.4g") + ", " +
                std::to_string(r.times.repetitions) + "x" + (quietWord(r.times) == "quiet" ? "" : ", contended") + ")";
    }
    if (r.errors.psnr == r.errors.psnr) {
        line += " | " + decibels(r.errors.psnr, r.errors.floor) + " dB, band " +
                decibels(r.errors.band, r.errors.bandFloor) + ", worst " + cell(r.errors.worst, "%.2g") + " " +
                drownedWord(r.errors);
    }
    if (!r.unit.empty()) line += " | " + cell(r.figure, "%.4g") + " " + r.unit;
    if (!r.note.empty()) line += " | " + r.note;
    std::fprintf(stderr, "%s\n", line.c_str());
    return rows_.back();
}

const Row* Table::find(const std::string& section, const std::string& scene, const std::string& method,
                       const std::string& what, int threads) const {
    const auto at = std::ranges::find_if(rows_, [&](const Row& r) {
        return r.section == section && r.scene == scene && r.method == method && r.what == what && r.threads == threads;
    });
    return at == rows_.end() ? nullptr : &*at;
}

bool Table::write(const std::string& path) const {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (!file) return false;
    std::fputs("section,scene,method,what,threads,ms_p50,ms_p95,ms_least,repetitions,psnr_dB,band_dB,worst,floor_dB,"
               "band_floor_dB,"
               "known,figure,unit,ratio,of_fma,of_memory,geometry_ms,tiles,computed,own_cpus,others_cpus,run,note\n",
               file);
    for (const Row& r : rows_) {
        std::string line = r.section + "," + r.scene + "," + r.method + "," + r.what + ",";
        line += (r.threads > 0 ? std::to_string(r.threads) : "") + ",";
        line += cell(r.times.p50, "%.6g") + "," + cell(r.times.p95, "%.6g") + "," + cell(r.times.least, "%.6g") + ",";
        line += (r.times.repetitions > 0 ? std::to_string(r.times.repetitions) : "") + ",";
        line += decibels(r.errors.psnr, r.errors.floor) + "," + decibels(r.errors.band, r.errors.bandFloor) + "," +
                cell(r.errors.worst, "%.3g") + "," + cell(r.errors.floor, "%.1f") + "," +
                cell(r.errors.bandFloor, "%.1f") + "," + drownedWord(r.errors) + ",";
        line += cell(r.figure, "%.6g") + "," + r.unit + "," + cell(r.ratio, "%.4g") + "," + cell(r.ofFma, "%.3g") +
                "," + cell(r.ofMemory, "%.3g") + "," + cell(r.geometry, "%.4g") + ",";
        line += r.tiles > 0 ? std::to_string(r.tiles) + "," + std::to_string(r.computed) + "," : ",,";
        line += (r.times.repetitions > 0 ? cell(r.times.own, "%.2f") + "," + cell(r.times.others, "%.2f") : ",") + ",";
        std::string note = r.note;
        std::ranges::replace(note, ',', ';');
        line += quietWord(r.times) + "," + note + "\n";
        std::fputs(line.c_str(), file);
    }
    return std::fclose(file) == 0;
}

}  // namespace ilf::bench
