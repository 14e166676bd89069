#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "projects/safe_file.h"
#include "projects/wave_csv.h"
#include "projects/wave_csv_text.h"
#include "projects/wave_period.h"

namespace ilf::projects {
namespace {

constexpr std::size_t kMostOfCsv = std::size_t{16} << 20;
/// Of the drive's swing: how far, rms, a recorded drive may be from the sine that the header tells of.
constexpr double kDriveTolerance = 0.05;
constexpr std::size_t kDriveHarmonics = 16;

struct Named {
    fs::path file;
    std::map<std::string, std::string> keys;
};

Result<std::vector<Named>> manifestOf(const fs::path& folder) {
    const fs::path path = folder / "manifest.csv";
    const auto text = readWhole(path, kMostOfCsv);
    if (!text) return tl::unexpected(text.error());
    std::vector<Named> files;
    std::vector<std::string> columns;
    int number = 0;
    for (std::string_view rest = *text; !rest.empty();) {
        const std::size_t end = rest.find('\n');
        const auto cells = csvCells(rest.substr(0, end));
        const bool empty = cells.size() == 1 && (cells[0].empty() || cells[0].starts_with('#'));
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
        ++number;
        if (empty) continue;
        const auto wrong = [&](const std::string& what) {
            return fail(Fault::badFile, spoken(path) + ", line " + std::to_string(number) + ": " + what);
        };
        if (columns.empty()) {
            columns = cells;
            if (std::find(columns.begin(), columns.end(), "file") == columns.end()) {
                return wrong("there must be a column \"file\".");
            }
            continue;
        }
        if (cells.size() != columns.size()) {
            return wrong(std::to_string(cells.size()) + " values for " + std::to_string(columns.size()) + " columns.");
        }
        Named named;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (columns[i] == "file") {
                const fs::path name = cells[i];
                if (name.empty() || name.is_absolute() || name.has_parent_path()) {
                    return wrong("\"" + cells[i] + "\" is no file beside the manifest.");
                }
                named.file = folder / name;
            } else if (!cells[i].empty()) {
                named.keys[columns[i]] = cells[i];
            }
        }
        files.push_back(std::move(named));
    }
    return files;
}

Result<std::vector<Named>> filesOf(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
        return fail(Fault::notFound, spoken(folder) + " is no folder. Give the folder that holds the CSV files.");
    }
    if (fs::exists(folder / "manifest.csv", error)) return manifestOf(folder);
    std::vector<Named> files;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->path().extension() == ".csv") files.push_back({entry->path(), {}});
    }
    if (error) return fail(Fault::badFile, spoken(folder) + " cannot be read: " + error.message() + ".");
    std::sort(files.begin(), files.end(), [](const Named& a, const Named& b) { return a.file < b.file; });
    return files;
}

/// What the header says of the lens and how it was recorded.
Result<WaveFile> frameOf(const CsvWave& csv) {
    WaveFile out;
    const auto serial = csv.text("etl_serial");
    if (!serial) return tl::unexpected(serial.error());
    const std::string kind = csv.text("etl_kind", "etl"), eye = csv.text("eye", "mono");
    if (kind != "etl" && kind != "emulator")
        return csv.wrong("etl_kind", "must be etl or emulator, not \"" + kind + "\".");
    if (eye != "L" && eye != "R" && eye != "mono")
        return csv.wrong("eye", "must be L, R or mono, not \"" + eye + "\".");
    out.lens = {kind == "emulator", csv.text("etl_model", "unknown lens"), *serial, eye, csv.text("notes", "")};
    out.recordedUtc = csv.text("utc", "unknown");
    out.method = csv.text("method", "csv");
    return out;
}

/// The header's numbers, before the samples.
Result<LensRecord> headerOf(const CsvWave& csv) {
    LensRecord record;
    const auto schema = csv.number("schema");
    if (!schema) return tl::unexpected(schema.error());
    if (*schema != 1.0) return csv.wrong("schema", "is " + csv.text("schema", "") + "; this version reads 1.");
    const auto rate = csv.number("freq_Hz"), temperature = csv.number("temp_C"), periods = csv.number("periods_avg"),
               id = csv.number("id", 0.0), noise = csv.number("noise_D", 0.0);
    for (const auto* value : {&rate, &temperature, &periods, &id, &noise}) {
        if (!*value) return tl::unexpected(value->error());
    }
    if (!(*rate > 0.0)) return csv.wrong("freq_Hz", "must be above 0.");
    if (!(*noise >= 0.0)) return csv.wrong("noise_D", "must not be negative.");
    if (*periods < 0.0 || *periods > 1e9 || *periods != std::floor(*periods)) {
        return csv.wrong("periods_avg", "must be a whole number.");
    }
    if (*id < 0.0 || *id > 1e15 || *id != std::floor(*id)) return csv.wrong("id", "must be a whole number.");
    const auto unit = csv.text("u_unit");
    if (!unit) return tl::unexpected(unit.error());
    if (*unit != word(DriveUnit::volt) && *unit != word(DriveUnit::ampere)) {
        return csv.wrong("u_unit", "must be V or A, not \"" + *unit + "\".");
    }
    const auto said = csv.text("provenance");
    if (!said) return tl::unexpected(said.error());
    const auto provenance = provenanceFromWord(*said);
    if (!provenance) return csv.wrong("provenance", "must be measured, simulated or imported, not \"" + *said + "\".");
    record.id = static_cast<std::int64_t>(*id);
    record.family = csv.text("family", "sine");
    if (record.family.empty()) return csv.wrong("family", "must not be empty.");
    record.rate = Hertz::fromSi(*rate);
    record.unit = *unit == word(DriveUnit::volt) ? DriveUnit::volt : DriveUnit::ampere;
    record.temperature_C = *temperature;
    record.periodsAveraged = static_cast<int>(*periods);
    record.noise_D = *noise;
    record.provenance = *provenance;
    return record;
}

/// The samples: one period, equally spaced.
Result<void> readPeriod(CsvWave& csv, LensRecord& record) {
    if (csv.time_s.size() < kFewestSamples) {
        return csv.wrong("has " + std::to_string(csv.time_s.size()) + " samples; a period needs at least " +
                         std::to_string(kFewestSamples) + ".");
    }
    const double rate = record.rate.si();
    if (const auto wrong = notAPeriod(csv.time_s, rate)) return csv.wrong(csv.lines[wrong->sample], wrong->why);
    const double noise = csv.has("noise_D") ? record.noise_D : noiseOf(csv.power_D);
    record.noise_D = noise;
    if (equallySpaced(csv.time_s, rate)) {
        record.power_D = csv.power_D;
    } else {
        record.power_D = resampled(csv.time_s, csv.power_D, rate);
        csv.drive = resampled(csv.time_s, csv.drive, rate);
    }
    // In the order of the file, where its end meets its start.
    const auto jump = jumpAtSeam(csv.power_D, noise);
    if (!jump) return {};
    std::string text = std::to_string(*jump);
    return csv.wrong(csv.lines.back(), "the power jumps by " + text.substr(0, text.find('.') + 4) +
                                           " D from the end to the start, more than 3 sigma; the wave does not repeat, "
                                           "or the lens had not settled.");
}

Result<void> readDrive(const CsvWave& csv, LensRecord& record) {
    const auto low = csv.number("u_min"), high = csv.number("u_max");
    if (!low) return tl::unexpected(low.error());
    if (!high) return tl::unexpected(high.error());
    if (*low > *high) return csv.wrong("u_max", "is less than u_min.");
    const double middle = 0.5 * (*low + *high), half = 0.5 * (*high - *low);
    // Our own exports say how many harmonics the column has: a sine may then begin anywhere.
    if (record.family != "sine" || csv.has("u_harmonics")) {
        const auto count = csv.number("u_harmonics", static_cast<double>(kDriveHarmonics));
        if (!count) return tl::unexpected(count.error());
        if (*count < 0.0 || *count != std::floor(*count) || 2.0 * *count >= static_cast<double>(csv.drive.size())) {
            return csv.wrong("u_harmonics", "must be a whole number below half of the samples.");
        }
        record.drive = harmonicsOf(csv.drive, static_cast<std::size_t>(*count));
        return {};
    }
    record.drive.c = {middle};
    if (half > 0.0) record.drive.c.emplace_back(0.0, -half);
    const std::vector<double> sine = samplesOf(record.drive, csv.drive.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < sine.size(); ++i)
        squares += (csv.drive[i] - sine[i]) * (csv.drive[i] - sine[i]);
    const double off = std::sqrt(squares / static_cast<double>(sine.size()));
    if (off > kDriveTolerance * (half > 0.0 ? half : std::abs(middle))) {
        return csv.wrong("u_max", "and u_min tell of another drive than the column u, which must be the sine between "
                                  "them from its rising middle; give its family, or begin at that time.");
    }
    return {};
}

Result<ShapedWave> shapedOf(const CsvWave& csv, const LensRecord& record) {
    ShapedWave wave;
    const auto holds = csv.numbers("holds"), errors = csv.numbers("errors_D");
    const auto largest = csv.number("largest_error_D"), harmonics = csv.number("p_harmonics");
    if (!holds) return tl::unexpected(holds.error());
    if (!errors) return tl::unexpected(errors.error());
    if (!largest) return tl::unexpected(largest.error());
    if (!harmonics) return tl::unexpected(harmonics.error());
    if (holds->size() % 3 != 0) return csv.wrong("holds", "must be centre, length and power of each hold.");
    if (*harmonics < 0.0 || 2.0 * *harmonics >= static_cast<double>(record.power_D.size())) {
        return csv.wrong("p_harmonics", "must be below half of the samples.");
    }
    wave.id = record.id;
    wave.rate = record.rate;
    wave.unit = record.unit;
    wave.drive = record.drive;
    wave.power = harmonicsOf(record.power_D, static_cast<std::size_t>(*harmonics));
    for (std::size_t i = 0; i < holds->size(); i += 3)
        wave.holds.push_back({(*holds)[i], (*holds)[i + 1], (*holds)[i + 2]});
    wave.errors_D = *errors;
    wave.largestError_D = *largest;
    wave.temperature_C = record.temperature_C;
    wave.provenance = record.provenance;
    return wave;
}

/// Adds one file's wave to those of the files before.
Result<void> addFile(WaveFile& waves, std::set<std::int64_t>& ids, const Named& named) {
    const auto text = readWhole(named.file, kMostOfCsv);
    if (!text) return tl::unexpected(text.error());
    auto csv = CsvWave::of(*text, spoken(named.file), named.keys);
    if (!csv) return tl::unexpected(csv.error());
    auto frame = frameOf(*csv);
    if (!frame) return tl::unexpected(frame.error());
    auto record = headerOf(*csv);
    if (!record) return tl::unexpected(record.error());
    const auto read = readPeriod(*csv, *record).and_then([&] { return readDrive(*csv, *record); });
    if (!read) return read;
    if (ids.empty()) {
        waves = *std::move(frame);
    } else if (frame->lens != waves.lens) {
        return csv->wrong("etl_serial", "is of another lens (" + frame->lens.name() + ") than the files before (" +
                                            waves.lens.name() + "); import each lens by itself.");
    }
    if (record->id == 0) record->id = ids.empty() ? 1 : *ids.rbegin() + 1;
    if (!ids.insert(record->id).second) {
        return csv->wrong("id",
                          std::to_string(record->id) + " is that of a file before; leave ids out, or correct it.");
    }
    if (!csv->has("holds")) {
        waves.records.push_back(*std::move(record));
        return {};
    }
    auto shaped = shapedOf(*csv, *record);
    if (!shaped) return tl::unexpected(shaped.error());
    waves.shaped.push_back(*std::move(shaped));
    return {};
}

}  // namespace

Result<WaveFile> importWaves(const fs::path& folder) {
    const auto files = filesOf(folder);
    if (!files) return tl::unexpected(files.error());
    if (files->empty()) return fail(Fault::notFound, spoken(folder) + " holds no CSV files of waves.");
    WaveFile waves;
    std::set<std::int64_t> ids;
    for (const Named& named : *files) {
        if (auto added = addFile(waves, ids, named); !added) return tl::unexpected(added.error());
    }
    return waves;
}

}  // namespace ilf::projects
