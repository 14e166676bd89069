#include <cstdio>
#include <string>

#include "projects/safe_file.h"
#include "projects/wave_csv.h"

namespace ilf::projects {
namespace {

std::string exact(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

/// One line; a header's value ends with its line.
std::string oneLine(std::string text) {
    for (char& letter : text) {
        if (letter == '\n' || letter == '\r') letter = ' ';
    }
    return text;
}

class Writing {
public:
    void key(const char* name, const std::string& value) {
        text_.append("# ").append(name).append("=").append(oneLine(value)).append("\n");
    }
    void key(const char* name, double value) { key(name, exact(value)); }

    void header(const WaveFile& waves, const LensRecord& record) {
        key("schema", "1");
        key("id", std::to_string(record.id));
        key("etl_kind", waves.lens.emulated ? "emulator" : "etl");
        key("etl_model", waves.lens.model);
        key("etl_serial", waves.lens.serial);
        key("eye", waves.lens.eye);
        key("notes", waves.lens.notes);
        key("utc", waves.recordedUtc);
        key("method", waves.method);
        key("provenance", std::string(word(record.provenance)));
        key("family", record.family);
        key("freq_Hz", record.rate.si());
        key("u_unit", std::string(word(record.unit)));
        const Extremes drive = extremes(record.drive);
        // A sine from its rising middle is told by its extremes alone, exactly.
        const auto& c = record.drive.c;
        const bool sine = record.family == "sine" && c.size() == 2 && c[1].real() == 0.0 && c[1].imag() < 0.0;
        key("u_min", sine ? c[0].real() + c[1].imag() : drive.low);
        key("u_max", sine ? c[0].real() - c[1].imag() : drive.high);
        if (!sine) key("u_harmonics", std::to_string(record.drive.c.empty() ? 0 : record.drive.c.size() - 1));
        key("temp_C", record.temperature_C);
        key("periods_avg", std::to_string(record.periodsAveraged));
        key("noise_D", record.noise_D);
    }
    void holds(const ShapedWave& wave) {
        std::string holds, errors;
        for (const Hold& hold : wave.holds)
            holds += exact(hold.centre) + " " + exact(hold.length) + " " + exact(hold.power_D) + " ";
        for (const double error : wave.errors_D)
            errors += exact(error) + " ";
        key("holds", holds);
        key("errors_D", errors);
        key("largest_error_D", wave.largestError_D);
        key("p_harmonics", std::to_string(wave.power.c.empty() ? 0 : wave.power.c.size() - 1));
    }
    void samples(const LensRecord& record) {
        text_ += "t_s,u,P_D\n";
        const std::size_t n = record.power_D.size();
        const std::vector<double> drive = samplesOf(record.drive, n);
        for (std::size_t i = 0; i < n; ++i) {
            const double t = static_cast<double>(i) / (static_cast<double>(n) * record.rate.si());
            text_ += exact(t) + "," + exact(drive[i]) + "," + exact(record.power_D[i]) + "\n";
        }
    }
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

Result<void> writeAll(const fs::path& folder, const WaveFile& waves) {
    std::string manifest = "file,id\n";
    const auto write = [&](const LensRecord& record, const ShapedWave* shaped) {
        Writing out;
        out.header(waves, record);
        if (shaped != nullptr) out.holds(*shaped);
        out.samples(record);
        char name[40];
        std::snprintf(name, sizeof name, "wave-%06lld.csv", static_cast<long long>(record.id));
        manifest.append(name).append(",").append(std::to_string(record.id)).append("\n");
        return writeNew(folder / name, out.text());
    };
    for (const LensRecord& record : waves.records) {
        if (auto written = write(record, nullptr); !written) return written;
    }
    for (const ShapedWave& wave : waves.shaped) {
        const auto written = waveOf(waves, wave.id).and_then([&](const LensRecord& r) { return write(r, &wave); });
        if (!written) return written;
    }
    if (auto written = writeNew(folder / "manifest.csv", manifest); !written) return written;
    return syncFolder(folder);
}

}  // namespace

Result<void> exportWaves(const fs::path& folder, const WaveFile& waves) {
    std::error_code ignored;
    const fs::path target = folder.has_filename() ? folder : folder.parent_path();
    if (fs::exists(target, ignored) && !(fs::is_directory(target, ignored) && fs::is_empty(target, ignored))) {
        return fail(Fault::cannotWrite, spoken(target) + " is there already and not empty; name a new folder.");
    }
    const fs::path fresh = siblingOf(target, "new");
    const auto put = makeFolders(fresh).and_then([&] { return writeAll(fresh, waves); }).and_then([&] {
        return putInPlace(fresh, target);
    });
    if (!put) {
        removeQuietly(fresh);
        return tl::unexpected(put.error());
    }
    removeQuietly(*put);  // the empty folder that was there
    return syncFolder(target.parent_path());
}

}  // namespace ilf::projects
