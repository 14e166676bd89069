#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "projects/safe_file.h"
#include "projects/wave_blobs.h"
#include "projects/wave_database.h"
#include "projects/wave_schema.h"
#include "projects/wave_sqlite.h"

namespace ilf::projects {
namespace {

/// One row of `wave`, whatever it comes from.
struct Row {
    std::int64_t id = 0;
    std::string family;
    Hertz rate;
    DriveUnit unit = DriveUnit::volt;
    Harmonics drive;
    std::vector<double> power_D;
    double temperature_C = 0.0;
    int periodsAveraged = 1;
    double noise_D = 0.0;
    Provenance provenance = Provenance::simulated;
};

constexpr std::size_t kShapedSamples = 250;
constexpr std::size_t kOvertones = 16;

Row rowOf(const LensRecord& record) {
    return {record.id,      record.family,    record.rate,          record.unit,
            record.drive,   record.power_D,   record.temperature_C, record.periodsAveraged,
            record.noise_D, record.provenance};
}
Row rowOf(const ShapedWave& wave) {
    return {wave.id,
            "shaped",
            wave.rate,
            wave.unit,
            wave.drive,
            samplesOf(wave.power, kShapedSamples),
            wave.temperature_C,
            1,
            0.0,
            wave.provenance};
}

bool finite(const Harmonics& f) {
    return std::all_of(f.c.begin(), f.c.end(),
                       [](const auto& c) { return std::isfinite(c.real()) && std::isfinite(c.imag()); });
}
bool finite(const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

/// A sine is told by its extremes alone; anything else keeps its harmonics.
bool plainSine(const Row& row) {
    const auto& c = row.drive.c;
    if (row.family != "sine" || c.empty() || c.size() > 2 || c[0].imag() != 0.0) return false;
    return c.size() == 1 || (c[1].real() == 0.0 && c[1].imag() < 0.0);
}

std::optional<std::string> wrongWith(const Row& row) {
    if (row.family.empty()) return "has no family";
    if (!(row.rate.si() > 0.0) || !isFinite(row.rate)) return "has no rate";
    if (row.power_D.empty()) return "has no samples";
    if (!finite(row.power_D)) return "has a power that is not finite";
    if (row.drive.c.empty()) return "has no drive";
    if (!finite(row.drive)) return "has a drive that is not finite";
    if (!std::isfinite(row.temperature_C)) return "has no temperature";
    if (!(row.noise_D >= 0.0) || !std::isfinite(row.noise_D)) return "has a noise that is not a number of dioptres";
    return std::nullopt;
}

double distortion(const std::vector<double>& power_D) {
    const Harmonics power = harmonicsOf(power_D, kOvertones);
    double overtones = 0.0;
    for (std::size_t k = 2; k < power.c.size(); ++k)
        overtones += std::norm(power.c[k]);
    return std::sqrt(overtones / std::norm(power.c[1]));
}

/// What `model` keeps of a shaped wave: its id, how many harmonics its power has, its holds and its errors.
std::vector<double> shapedParams(const ShapedWave& wave, std::int64_t id) {
    std::vector<double> params = {static_cast<double>(id), static_cast<double>(wave.power.c.size()),
                                  static_cast<double>(wave.holds.size())};
    for (const Hold& hold : wave.holds)
        params.insert(params.end(), {hold.centre, hold.length, hold.power_D});
    params.insert(params.end(), wave.errors_D.begin(), wave.errors_D.end());
    return params;
}

/// Fills a database in memory, then seals it.
class Saving {
public:
    explicit Saving(const WaveFile& waves) : waves_(waves) {}

    Result<std::string> file() {
        if (!database_.execute(kWaveSchema) || !database_.execute("BEGIN")) return broken();
        const auto filled = addDevices().and_then([&] { return addWaves(); });
        if (!filled) return tl::unexpected(filled.error());
        const std::string version = "PRAGMA application_id=" + std::to_string(kWaveApplication) +
                                    "; PRAGMA user_version=" + std::to_string(kWaveVersion) + ";";
        const std::string seals = "UPDATE wave SET sha256=(SELECT " + std::string(kWaveSeal) +
                                  " FROM wave w, session s, device d"
                                  " WHERE w.id=wave.id AND s.id=w.session_id AND d.id=s.etl_id);"
                                  "UPDATE model SET params=CAST(substr(params,1,length(params)-32)||(SELECT " +
                                  kModelSeal + " FROM model m WHERE m.id=model.id) AS BLOB);";
        if (!database_.execute(seals + "COMMIT;" + version)) return broken();
        return database_.file();
    }

private:
    tl::unexpected<Error> broken() {
        return fail(Fault::cannotWrite, "the waves cannot be put into a database: " + database_.complaint() + ".");
    }

    Result<void> addDevices() {
        auto device = database_.statement("INSERT INTO device VALUES(?,?,?,?,?,?)");
        const RecordedLens& lens = waves_.lens;
        device.bind(0, std::int64_t{1}).bind(1, lens.emulated ? "emulator" : "etl");
        device.bind(2, lens.model).bind(3, lens.serial).bind(4, lens.eye).bind(5, lens.notes);
        if (!device.run()) {
            return fail(Fault::outOfRange, "the lens's eye is \"" + lens.eye + "\"; it must be L, R or mono.");
        }
        auto delay = database_.statement("INSERT INTO projector_delay VALUES(1,?,?,?,?,?)");
        std::int64_t id = 2;
        for (const ProjectorDelay& one : waves_.delays) {
            if (!std::isfinite(one.delay_s) || !std::isfinite(one.deviation_s)) {
                return fail(Fault::outOfRange, "the delay of projector \"" + one.projector + "\" is not finite.");
            }
            device.bind(0, id).bind(1, "projector").bind(2, one.projector).bindNothing(3).bindNothing(4).bindNothing(5);
            delay.bind(0, id++).bind(1, one.mode).bind(2, one.delay_s).bind(3, one.deviation_s);
            delay.bind(4, std::int64_t{one.measurements});
            if (!device.run() || !delay.run()) return broken();
        }
        return {};
    }

    /// One session for each noise and provenance, since a session has one of each.
    Result<std::int64_t> sessionOf(const Row& row) {
        const auto [found, fresh] =
            sessions_.try_emplace({row.provenance, row.noise_D}, static_cast<std::int64_t>(sessions_.size()) + 1);
        if (!fresh) return found->second;
        auto session = database_.statement("INSERT INTO session VALUES(?,1,NULL,?,?,0,1,?,?,?)");
        session.bind(0, found->second).bind(1, waves_.recordedUtc).bind(2, waves_.method);
        session.bind(3, row.noise_D).bind(4, waves_.software).bind(5, word(row.provenance));
        if (!session.run()) return broken();
        return found->second;
    }

    Result<void> addWaves() {
        if (waves_.records.empty() && waves_.shaped.empty()) {
            return fail(Fault::outOfRange, "There are no waves to save; record or import some first.");
        }
        for (const LensRecord& record : waves_.records)
            next_ = std::max(next_, record.id + 1);
        for (const ShapedWave& wave : waves_.shaped)
            next_ = std::max(next_, wave.id + 1);
        auto insert = database_.statement(
            "INSERT INTO wave(id,session_id,family,freq_Hz,drive_unit,u_min,u_max,u_harm,temp_C,periods_avg,n,scale,"
            "offset,data,p_min,p_max,t_pmin_s,t_pmax_s,thd,sha256) VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,"
            "zeroblob(32))");
        for (const LensRecord& record : waves_.records) {
            if (auto id = addWave(insert, rowOf(record)); !id) return tl::unexpected(id.error());
        }
        for (const ShapedWave& wave : waves_.shaped) {
            const auto done = addWave(insert, rowOf(wave)).and_then([&](auto id) { return addHolds(wave, id); });
            if (!done) return done;
        }
        return {};
    }

    /// Gives the wave's id.
    Result<std::int64_t> addWave(Statement& wave, Row row) {
        if (row.id == 0) row.id = next_++;
        const std::string name = "wave " + std::to_string(row.id);
        if (const auto wrong = wrongWith(row)) {
            return fail(Fault::outOfRange, name + " " + *wrong + "; it cannot be saved.");
        }
        const bool sine = plainSine(row);
        const double middle = row.drive.mean(), half = sine && row.drive.c.size() > 1 ? -row.drive.c[1].imag() : 0.0;
        const Extremes drive = sine ? Extremes{middle - half, middle + half} : extremes(row.drive);
        const auto session = sessionOf(row);
        if (!session) return session;
        const Samples16 samples = packed16(row.power_D);
        const double step = 1.0 / (static_cast<double>(row.power_D.size()) * row.rate.si());
        wave.bind(0, row.id).bind(1, *session).bind(2, row.family).bind(3, row.rate.si()).bind(4, word(row.unit));
        wave.bind(5, drive.low).bind(6, drive.high);
        sine ? wave.bindNothing(7) : wave.bindBytes(7, packed(row.drive.c));
        wave.bind(8, row.temperature_C).bind(9, std::int64_t{row.periodsAveraged});
        wave.bind(10, static_cast<std::int64_t>(row.power_D.size()));
        wave.bind(11, samples.scale).bind(12, samples.offset).bindBytes(13, samples.data);
        wave.bind(14, samples.low).bind(15, samples.high);
        wave.bind(16, static_cast<double>(samples.atLow) * step).bind(17, static_cast<double>(samples.atHigh) * step);
        row.power_D.size() > 2 * kOvertones ? wave.bind(18, distortion(row.power_D)) : wave.bindNothing(18);
        if (!wave.run()) {
            return fail(Fault::outOfRange, name + " cannot be saved beside the others: its id, or its drive, rate and "
                                                  "temperature, are those of another wave. Keep one of the two.");
        }
        return row.id;
    }

    Result<void> addHolds(const ShapedWave& wave, std::int64_t id) {
        const std::vector<double> params = shapedParams(wave, id);
        if (!finite(params) || !std::isfinite(wave.largestError_D)) {
            return fail(Fault::outOfRange,
                        "wave " + std::to_string(id) + " has an error or a hold that is not finite.");
        }
        const Extremes drive = extremes(wave.drive);
        auto model = database_.statement(
            "INSERT INTO model SELECT NULL,session_id,'shaped',freq_Hz,?,NULL,?,?,? FROM wave WHERE id=?");
        model.bindBytes(0, packed(params) + std::string(32, '\0')).bind(1, wave.largestError_D);
        model.bindBytes(2, packed(std::vector{drive.low, drive.high}));
        model.bindBytes(3, packed(std::vector{wave.temperature_C})).bind(4, id);
        if (!model.run()) return broken();
        return {};
    }

    const WaveFile& waves_;
    MemoryDatabase database_;
    std::map<std::pair<Provenance, double>, std::int64_t> sessions_;
    std::int64_t next_ = 1;
};

}  // namespace

Result<void> saveWaves(const std::filesystem::path& path, const WaveFile& waves) {
    const auto file = Saving(waves).file();
    if (!file) return fail(file.error().fault, spoken(path) + " is not saved: " + file.error().what);
    return writeAtomically(path, *file);
}

}  // namespace ilf::projects
