#include "app/lens/calibration_of.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "app/lens/record_lens.h"
#include "app/words.h"
#include "core/lens/sine_record.h"
#include "ilf/version.h"
#include "projects/xdg.h"

namespace ilf::app {
namespace {

/// Where the lowest hold of a learnt wave lies; whoever plays the wave moves it.
constexpr double kLowAt = 0.5 / 16.0;
/// Enough for the waves of a survey: they are settled and their noise averages out over 40 of them.
constexpr Second kQuickSettle = 0.12_s;
constexpr int kQuickPeriods = 4;

/// As far as it was driven.
DriveLimits recordedLimits(const projects::WaveFile& waves) {
    DriveLimits limits;
    const auto include = [&](const Harmonics& drive) {
        const Extremes ends = extremes(drive);
        limits.peak = std::max({limits.peak, std::abs(ends.low), std::abs(ends.high)});
        limits.rms = std::max(limits.rms, drive.rms());
    };
    for (const LensRecord& record : waves.records)
        include(record.drive);
    for (const ShapedWave& wave : waves.shaped)
        include(wave.drive);
    // What was played may be played again, whatever rounding does to it.
    limits.peak *= 1.0 + 1e-6;
    limits.rms *= 1.0 + 1e-6;
    return limits;
}

/// A model's error no longer shrinks beyond this many waves, while fitting takes ever longer.
constexpr std::size_t kModelWaves = 120;

/// Of a large table the waves to fit: those within the lens's powers, each the farthest from all taken before.
std::vector<LensRecord> forModel(std::span<const LensRecord> records, const DriveLimits& limits) {
    struct Candidate {
        const LensRecord* record;
        double offset, amplitude, away = HUGE_VAL;
    };
    std::vector<Candidate> left;
    for (const LensRecord& record : records) {
        const auto [low, high] = std::minmax_element(record.power_D.begin(), record.power_D.end());
        if (*low < limits.lensMin.si() || *high > limits.lensMax.si()) continue;
        const double amplitude = record.drive.c.size() > 1 ? std::abs(record.drive.c[1]) : 0.0;
        left.push_back({&record, record.drive.mean(), amplitude});
    }
    std::vector<LensRecord> taken;
    std::size_t next = 0;
    while (!left.empty() && taken.size() < kModelWaves) {
        const Candidate now = left[next];
        taken.push_back(*now.record);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(next));
        next = 0;
        for (std::size_t i = 0; i < left.size(); ++i) {
            Candidate& other = left[i];
            other.away = std::min(other.away, std::hypot(other.offset - now.offset, other.amplitude - now.amplitude));
            if (other.away > left[next].away) next = i;
        }
    }
    return taken;
}

Result<void> addRate(LensCalibration& calibration, std::span<const LensRecord> records) {
    auto table = waveTable(records, calibration.drift_D_per_C);
    if (!table) return tl::unexpected(table.error());
    if (calibration.tables.empty()) calibration.temperature_C = table->temperature_C;
    calibration.tables.push_back(*std::move(table));
    // Too few or too similar waves give no model; the table still serves the modes that need none.
    const bool few = records.size() <= kModelWaves;
    const auto chosen = few ? std::vector<LensRecord>() : forModel(records, calibration.limits);
    if (auto model = fitted(few ? records : chosen, calibration.drift_D_per_C))
        calibration.models.push_back(*std::move(model));
    // All rates have the one coil; the records of any of them tell how it warms.
    std::vector<SineRecord> sines;
    for (const LensRecord& record : records) {
        if (auto sine = sineRecord(record, record.rate)) sines.push_back(*std::move(sine));
    }
    if (!sines.empty()) {
        calibration.warming_C_per_square = std::max(calibration.warming_C_per_square, warmth(sines).perSquare_C);
    }
    return {};
}

std::int64_t nextId(const LensCalibration& calibration) {
    std::int64_t last = 0;
    for (const WaveTable& table : calibration.tables) {
        for (const TableWave& wave : table.waves)
            last = std::max(last, wave.id);
    }
    for (const ShapedWave& wave : calibration.shaped)
        last = std::max(last, wave.id);
    return last + 1;
}

LensBench quickBench(devices::LensPreset preset) {
    LensBench bench;
    bench.preset = preset;
    bench.options.settle = kQuickSettle;
    bench.options.periods = kQuickPeriods;
    return bench;
}

}  // namespace

std::optional<LensBench> benchOf(const projects::RecordedLens& lens) {
    const auto preset = devices::lensPresetFromWord(lens.model);
    if (!lens.emulated || !preset) return std::nullopt;
    LensBench bench;
    bench.preset = *preset;
    const std::string_view prefix = "seed ", serial = lens.serial;
    if (serial.empty()) return bench;
    if (!serial.starts_with(prefix)) return std::nullopt;
    const char* end = serial.data() + serial.size();
    const auto [stopped, error] = std::from_chars(serial.data() + prefix.size(), end, bench.seed);
    if (error != std::errc() || stopped != end) return std::nullopt;
    return bench;
}

projects::RecordedLens lensOf(const LensBench& bench) {
    projects::RecordedLens lens;
    lens.model = word(bench.preset);
    if (bench.seed != 0) lens.serial = "seed " + std::to_string(bench.seed);
    return lens;
}

projects::WaveFile emptyFile(const LensBench& bench) {
    projects::WaveFile waves;
    waves.lens = lensOf(bench);
    waves.recordedUtc = utcNow();
    waves.software = std::string("illuminatedfocus ") + kVersion;
    return waves;
}

Result<ShapedWave> learntOn(const LensBench& bench, std::span<const Dioptre> levels, double duty, int harmonics,
                            Hertz rate) {
    std::vector<double> levels_D;
    for (const Dioptre level : levels)
        levels_D.push_back(level.si());
    std::sort(levels_D.begin(), levels_D.end());
    devices::LensEmulator lens = bench.lens();
    const auto record = devices::recorder(lens, bench.options);
    auto wave = learnt(record, rate, holdsFor(levels_D, duty, kLowAt), harmonics, lens.limits());
    // What its own drive warms the coil by belongs to the wave, as it does to a table's.
    if (wave) wave->temperature_C = bench.temperature_C;
    return wave;
}

Result<Calibration> calibrationFrom(const projects::WaveFile& waves) {
    LensCalibration calibration;
    calibration.lens = waves.lens.name();
    const auto bench = benchOf(waves.lens);
    calibration.limits = bench ? bench->lens().limits() : recordedLimits(waves);
    std::map<double, std::vector<LensRecord>> rates;
    for (const LensRecord& record : waves.records) {
        if (record.family != "sine") continue;
        const auto near = std::find_if(rates.begin(), rates.end(), [&](const auto& rate) {
            return sameRate(Hertz::fromSi(rate.first), record.rate);
        });
        (near == rates.end() ? rates[record.rate.si()] : near->second).push_back(record);
    }
    if (!waves.shaped.empty()) {
        calibration.unit = waves.shaped.front().unit;
        calibration.provenance = waves.shaped.front().provenance;
        calibration.temperature_C = waves.shaped.front().temperature_C;
    }
    for (const auto& [rate, records] : rates) {
        calibration.unit = records.front().unit;
        calibration.provenance = records.front().provenance;
        if (const auto added = addRate(calibration, records); !added) return tl::unexpected(added.error());
    }
    calibration.shaped = waves.shaped;
    if (calibration.tables.empty() && calibration.shaped.empty()) {
        return fail(Fault::notFound, "There are no sine waves and no shaped waves of " + calibration.lens +
                                         " to plan with; record some.");
    }
    return std::make_shared<const LensCalibration>(std::move(calibration));
}

Result<Calibration> simulatedCalibration(devices::LensPreset preset, Hertz rate, Dioptre rest) {
    static std::mutex mutex;
    static std::map<std::tuple<devices::LensPreset, double, double>, Calibration> made;
    const std::scoped_lock lock(mutex);
    const Dioptre about = Dioptre::fromSi(std::round(rest.si()));
    Calibration& kept = made[{preset, rate.si(), about.si()}];
    if (kept) return kept;
    const LensBench bench = quickBench(preset);
    const auto records = surveyed(bench, rate, 40, about);
    if (!records) return tl::unexpected(records.error());
    LensCalibration calibration;
    calibration.lens = lensOf(bench).name();
    calibration.limits = bench.lens().limits();
    if (const auto added = addRate(calibration, *records); !added) return tl::unexpected(added.error());
    kept = std::make_shared<const LensCalibration>(std::move(calibration));
    return kept;
}

Result<Calibration> simulatedTable(devices::LensPreset preset, Hertz rate) {
    LensBench bench;
    bench.preset = preset;
    char name[96];
    std::snprintf(name, sizeof name, "%s-%s-%.6gHz.ilflens", std::string(word(preset)).c_str(), kVersion, rate.si());
    const std::filesystem::path path = projects::cacheDir() / "simulated-lenses" / name;
    if (auto kept = projects::openWaves(path).and_then(calibrationFrom)) return kept;
    auto records = paperWaves(bench, rate);
    if (!records) return tl::unexpected(records.error());
    projects::WaveFile waves = emptyFile(bench);
    waves.records = *std::move(records);
    std::error_code ignored;
    std::filesystem::create_directories(path.parent_path(), ignored);
    // As it will be read the next time, to the last bit; without a cache it is recorded again then.
    if (projects::saveWaves(path, waves)) return projects::openWaves(path).and_then(calibrationFrom);
    return calibrationFrom(waves);
}

Result<Calibration> withShapedWave(const Calibration& calibration, devices::LensPreset preset,
                                   std::span<const Dioptre> levels, double duty, int harmonics, Hertz rate) {
    LensBench bench = quickBench(preset);
    bench.temperature_C = calibration->temperature_C;
    auto wave = learntOn(bench, levels, duty, harmonics, rate);
    if (!wave) return tl::unexpected(wave.error());
    LensCalibration next = *calibration;
    wave->id = nextId(next);
    next.shaped.push_back(*std::move(wave));
    return std::make_shared<const LensCalibration>(std::move(next));
}

}  // namespace ilf::app
