#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <utility>

#include "projects/safe_file.h"
#include "projects/wave_blobs.h"
#include "projects/wave_database.h"
#include "projects/wave_schema.h"
#include "projects/wave_sqlite.h"

namespace ilf::projects {
namespace {

constexpr std::size_t kMostOfDatabase = std::size_t{256} << 20;
/// Of SQLite's file format, section 1.3: where the first page says what the file is.
constexpr std::size_t kHeaderBytes = 100, kPageSizeAt = 16, kLogAt = 18, kPagesAt = 28, kVersionAt = 60,
                      kApplicationAt = 68;

std::uint32_t bigEndian(const std::string& bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// What the header says; SQLite itself is asked only about a file that is whole and ours.
std::optional<std::string> wrongWithHeader(const std::string& bytes) {
    using namespace std::string_literals;
    const std::string magic = "SQLite format 3\0"s;
    if (bytes.empty()) return "is empty; take a backup, or record the lens again.";
    if (!bytes.starts_with(magic.substr(0, std::min(magic.size(), bytes.size())))) {
        return "is not a wave database (no SQLite file); choose a .ilflens file, or import CSV files with \"lens "
               "import\".";
    }
    if (bytes.size() < kHeaderBytes) return "is cut short; take a backup, or record the lens again.";
    const std::uint32_t page = bigEndian(bytes, kPageSizeAt, 2), pageBytes = page == 1 ? 65536 : page;
    const std::uint64_t whole = std::uint64_t{bigEndian(bytes, kPagesAt, 4)} * pageBytes;
    if (bigEndian(bytes, kApplicationAt, 4) != kWaveApplication) {
        return "is a database of another program; choose a .ilflens file.";
    }
    const std::uint32_t version = bigEndian(bytes, kVersionAt, 4);
    if (version > kWaveVersion) {
        return "was written by a newer version (format " + std::to_string(version) + ", this one reads " +
               std::to_string(kWaveVersion) + "); update this program.";
    }
    if (version < kWaveVersion) return "has a damaged header (format 0); take a backup, or record the lens again.";
    if (bytes.size() < whole) {
        return "is cut short (" + std::to_string(bytes.size()) + " of " + std::to_string(whole) +
               " bytes); take a backup, or record the lens again.";
    }
    if (bytes[kLogAt] != 1 || bytes[kLogAt + 1] != 1) {
        return "is kept with a write-ahead log by another program; close that program, or convert the file there with "
               "PRAGMA journal_mode=DELETE.";
    }
    return std::nullopt;
}

constexpr const char* kSelect =
    "SELECT w.id,w.family,w.freq_Hz,w.drive_unit,w.u_min,w.u_max,w.u_harm,w.temp_C,w.periods_avg,w.phase0_s,w.n,"
    "w.scale,w.offset,w.data,w.p_min,w.p_max,s.p_offset_D,s.p_gain,s.noise_D,s.provenance,s.etl_id,w.sha256,";
enum Column : int {
    cId,
    cFamily,
    cRate,
    cUnit,
    cDriveLow,
    cDriveHigh,
    cHarmonics,
    cTemperature,
    cPeriods,
    cPhase,
    cCount,
    cScale,
    cOffset,
    cData,
    cLow,
    cHigh,
    cSessionOffset,
    cSessionGain,
    cNoise,
    cProvenance,
    cLens,
    cChecksum,
    cSeal,
};

class Opening {
public:
    explicit Opening(std::string& bytes) : database_(bytes) {}

    Result<WaveFile> run() {
        return checkTables()
            .and_then([&] { return readWaves(); })
            .and_then([&] { return readLens(); })
            .and_then([&] { return readShaped(); })
            .and_then([&] { return readDelays(); })
            .and_then([&] { return checkPages(); })
            .map([&] { return std::move(out_); });
    }

private:
    static tl::unexpected<Error> bad(const std::string& what) { return fail(Fault::badFile, what); }
    tl::unexpected<Error> damaged(const std::string& what) const {
        return bad("is damaged (" + what + "); take a backup, or record the lens again.");
    }

    Result<void> checkTables() {
        auto tables = database_.statement("SELECT count(*) FROM sqlite_schema WHERE type='table' AND rootpage>0 AND "
                                          "name IN('device','session','wave','model','projector_delay')");
        if (!tables.step()) return damaged(database_.complaint());
        if (tables.whole(0) != 5) return damaged("its tables are not those of format 1");
        return {};
    }

    /// Last, since what the readers say of a wave helps more than what SQLite says of a page. Finds rows that are gone.
    Result<void> checkPages() {
        auto check = database_.statement("PRAGMA integrity_check(1)");
        if (!check.step()) return damaged(database_.complaint());
        if (const std::string said = check.text(0); said != "ok") return damaged(said.substr(0, said.find('\n')));
        return {};
    }

    Result<void> readWaves() {
        auto row = database_.statement(kSelect + std::string(kWaveSeal) +
                                       " FROM wave w LEFT JOIN session s ON s.id=w.session_id"
                                       " LEFT JOIN device d ON d.id=s.etl_id ORDER BY w.id");
        while (row.step()) {
            auto record = recordOf(row);
            if (!record)
                return bad("has a wave that cannot be used, " + std::to_string(row.whole(cId)) + ": " +
                           record.error().what);
            out_.records.push_back(*std::move(record));
        }
        if (row.failed()) return damaged(database_.complaint());
        if (out_.records.empty()) return bad("holds no waves; record or import some first.");
        return {};
    }

    Result<LensRecord> recordOf(const Statement& row);

    Result<void> readLens() {
        auto row = database_.statement("SELECT d.kind,d.model,d.serial,d.eye,d.notes,s.utc,s.method,s.software "
                                       "FROM session s JOIN device d ON d.id=s.etl_id ORDER BY s.id");
        if (!row.step()) return damaged("it says of no lens");
        const std::string kind = row.text(0);
        if (kind != "etl" && kind != "emulator") return bad("holds waves of a " + kind + ", not of a lens.");
        out_.lens = {kind == "emulator", row.text(1), row.text(2), row.text(3), row.text(4)};
        out_.recordedUtc = row.text(5);
        out_.method = row.text(6);
        out_.software = row.text(7);
        return {};
    }

    /// A shaped wave is a row of `wave` and one of `model` that says what it holds.
    Result<void> readShaped() {
        auto row =
            database_.statement("SELECT m.id,m.params,m.max_fit_D,substr(m.params,-32)=" + std::string(kModelSeal) +
                                ",m.kind FROM model m ORDER BY m.id");
        while (row.step()) {
            const std::string name = "model " + std::to_string(row.whole(0));
            const std::string bytes = row.bytes(1);
            if (bytes.size() < 32 || row.whole(3) != 1) return damaged(name + " does not match its checksum");
            if (row.text(4) != "shaped") continue;  // fitted models are fitted afresh
            const auto params = unpackedDoubles(std::string_view(bytes).substr(0, bytes.size() - 32));
            const auto largest = row.number(2);
            const bool finite = std::all_of(params.begin(), params.end(), [](double p) { return std::isfinite(p); });
            if (params.size() < 3 || !finite || !largest || params[2] < 0.0 || params[2] > 1000.0 ||
                params.size() < 3 + 3 * static_cast<std::size_t>(params[2])) {
                return damaged(name + " is not a shaped wave's");
            }
            const auto id = static_cast<std::int64_t>(std::clamp(params[0], -1e15, 1e15));
            const auto record =
                std::find_if(out_.records.begin(), out_.records.end(), [&](const LensRecord& r) { return r.id == id; });
            if (record == out_.records.end())
                return bad("lacks wave " + std::to_string(id) + ", which " + name +
                           " needs; import or learn it again.");
            const auto harmonics = static_cast<std::size_t>(std::clamp(params[1], 0.0, 1e6));
            if (harmonics == 0 || 2 * (harmonics - 1) >= record->power_D.size()) {
                return damaged(name + " has more harmonics than samples");
            }
            out_.shaped.push_back(shapedOf(*record, params, harmonics, *largest));
            out_.records.erase(record);
        }
        if (row.failed()) return damaged(database_.complaint());
        std::sort(out_.shaped.begin(), out_.shaped.end(),
                  [](const ShapedWave& a, const ShapedWave& b) { return a.id < b.id; });
        return {};
    }

    static ShapedWave shapedOf(const LensRecord& record, const std::vector<double>& params, std::size_t harmonics,
                               double largest) {
        ShapedWave wave;
        wave.id = record.id;
        wave.rate = record.rate;
        wave.unit = record.unit;
        wave.drive = record.drive;
        wave.power = harmonicsOf(record.power_D, harmonics - 1);
        wave.largestError_D = largest;
        wave.temperature_C = record.temperature_C;
        wave.provenance = record.provenance;
        std::size_t at = 3;
        for (double hold = 0.0; hold < params[2]; ++hold, at += 3)
            wave.holds.push_back({params[at], params[at + 1], params[at + 2]});
        wave.errors_D.assign(params.begin() + static_cast<std::ptrdiff_t>(at), params.end());
        return wave;
    }

    Result<void> readDelays() {
        auto row = database_.statement("SELECT d.model,p.mode,p.delay_s,p.sd_s,p.n FROM projector_delay p "
                                       "LEFT JOIN device d ON d.id=p.device_id ORDER BY p.rowid");
        while (row.step()) {
            const auto delay = row.number(2), deviation = row.number(3);
            if (!delay || !deviation) return damaged("a projector's delay is not finite");
            out_.delays.push_back({row.text(0), row.text(1), *delay, *deviation, static_cast<int>(row.whole(4))});
        }
        if (row.failed()) return damaged(database_.complaint());
        return {};
    }

    MemoryDatabase database_;
    WaveFile out_;
    std::optional<std::int64_t> lens_;
};

/// The drive from a row; x = 0 at sample 0.
Result<Harmonics> driveOf(const Statement& row, double low, double high) {
    if (row.nothing(cHarmonics) && low == high) return Harmonics{{low}};
    if (row.nothing(cHarmonics)) {
        return Harmonics{{0.5 * (low + high), std::complex<double>(0.0, -0.5 * (high - low))}};
    }
    Harmonics drive{unpackedComplex(row.bytes(cHarmonics))};
    if (drive.c.empty()) return fail(Fault::badFile, "its drive's harmonics are not whole numbers of 8 bytes.");
    for (const auto& c : drive.c) {
        if (!std::isfinite(c.real()) || !std::isfinite(c.imag()))
            return fail(Fault::badFile, "its drive is not finite.");
    }
    return drive;
}

Result<LensRecord> Opening::recordOf(const Statement& row) {
    LensRecord record;
    const auto provenance = provenanceFromWord(row.text(cProvenance));
    if (row.nothing(cLens) || !provenance) return bad("its session or lens is missing.");
    if (!lens_) lens_ = row.whole(cLens);
    if (*lens_ != row.whole(cLens)) return bad("it is of a second lens; this version keeps one lens a file.");
    const std::string unit = row.text(cUnit);
    if (unit != word(DriveUnit::volt) && unit != word(DriveUnit::ampere)) {
        return bad("its drive is counted in \"" + unit + "\"; only V and A are known.");
    }
    record.unit = unit == word(DriveUnit::volt) ? DriveUnit::volt : DriveUnit::ampere;
    if (!out_.records.empty() && out_.records.front().unit != record.unit) {
        return bad("its drive is in " + unit + ", that of the others is not; keep volts and amperes in two files.");
    }
    const auto scale = row.number(cScale), offset = row.number(cOffset), low = row.number(cLow),
               high = row.number(cHigh), gain = row.number(cSessionGain), shift = row.number(cSessionOffset);
    if (!scale || !offset || *scale == 0.0) return bad("its scale or offset is no finite number.");
    if (!gain || !shift || *gain == 0.0) return bad("its session's gain or offset is no finite number.");
    const auto rate = row.number(cRate), driveLow = row.number(cDriveLow), driveHigh = row.number(cDriveHigh),
               temperature = row.number(cTemperature), phase = row.number(cPhase), noise = row.number(cNoise);
    if (!rate || *rate <= 0.0) return bad("its rate is no number of hertz.");
    if (!driveLow || !driveHigh || !(*driveLow <= *driveHigh)) return bad("its drive's extremes are not in order.");
    if (!temperature) return bad("its lens's temperature is missing.");
    if (!phase) return bad("its phase is no finite number.");

    const std::string data = row.bytes(cData);
    if (row.whole(cCount) <= 0 || data.size() != 2 * static_cast<std::size_t>(row.whole(cCount))) {
        return bad("it has " + std::to_string(data.size()) + " bytes of samples where " +
                   std::to_string(row.whole(cCount)) + " samples need two each.");
    }
    if (row.bytes(cChecksum) != row.bytes(cSeal)) return bad("it does not match its checksum; take a backup.");
    record.power_D = unpacked16(data, *scale, *offset);
    const auto [least, most] = std::minmax_element(record.power_D.begin(), record.power_D.end());
    // Half a step either way is how far a writer's own rounding may be off.
    if (!low || !high || !(std::abs(*least - *low) <= std::abs(*scale)) ||
        !(std::abs(*most - *high) <= std::abs(*scale))) {
        return bad("its p_min and p_max are not the extremes of its samples.");
    }
    for (double& power : record.power_D) {
        power = *shift + *gain * power;
        if (!std::isfinite(power)) return bad("its power is not finite.");
    }
    auto drive = driveOf(row, *driveLow, *driveHigh);
    if (!drive) return tl::unexpected(drive.error());
    record.drive = *phase == 0.0 ? *std::move(drive) : drive->delayed(-*phase * *rate);
    record.id = row.whole(cId);
    record.family = row.text(cFamily);
    record.rate = Hertz::fromSi(*rate);
    record.temperature_C = *temperature;
    record.periodsAveraged = static_cast<int>(std::clamp<std::int64_t>(row.whole(cPeriods), 0, 1 << 30));
    record.noise_D = std::abs(*gain) * noise.value_or(0.0);
    record.provenance = *provenance;
    return record;
}

}  // namespace

Result<WaveFile> openWaves(const std::filesystem::path& path) {
    auto bytes = readWhole(path, kMostOfDatabase);
    if (!bytes) return tl::unexpected(bytes.error());
    if (const auto wrong = wrongWithHeader(*bytes)) return fail(Fault::badFile, spoken(path) + " " + *wrong);
    auto waves = Opening(*bytes).run();
    if (!waves) return fail(waves.error().fault, spoken(path) + " " + waves.error().what);
    return waves;
}

Result<LensRecord> waveOf(const WaveFile& waves, std::int64_t id) {
    for (const LensRecord& record : waves.records) {
        if (record.id == id) return record;
    }
    for (const ShapedWave& wave : waves.shaped) {
        if (wave.id != id) continue;
        LensRecord record;
        record.id = id;
        record.family = "shaped";
        record.rate = wave.rate;
        record.drive = wave.drive;
        record.unit = wave.unit;
        record.power_D = samplesOf(wave.power, 250);
        record.temperature_C = wave.temperature_C;
        record.provenance = wave.provenance;
        return record;
    }
    return fail(Fault::notFound, "There is no wave " + std::to_string(id) + " among the " +
                                     std::to_string(waves.records.size() + waves.shaped.size()) + " of " +
                                     waves.lens.name() + "; record it, or choose another.");
}

std::string RecordedLens::name() const {
    if (emulated) return "simulated lens, preset " + model + (serial.empty() ? "" : ", " + serial);
    return model + (serial.empty() ? "" : " " + serial);
}

}  // namespace ilf::projects
