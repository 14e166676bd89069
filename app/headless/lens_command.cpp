#include "app/headless/lens_command.h"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/lens/calibration_of.h"
#include "core/base/as_text.h"
#include "ilf/version.h"
#include "projects/wave_csv.h"

namespace ilf::app {
namespace {

Result<devices::LensPreset> presetNamed(const std::string& name) {
    if (const auto preset = devices::lensPresetFromWord(name)) return *preset;
    std::string all;
    for (const devices::LensPreset preset : devices::kLensPresets)
        all += (all.empty() ? "" : ", ") + std::string(word(preset));
    return fail(Fault::outOfRange, "There is no lens preset \"" + name + "\". Choose one of " + all + ".");
}

bool allSimulated(const projects::WaveFile& waves) {
    for (const LensRecord& record : waves.records) {
        if (record.provenance != Provenance::simulated) return false;
    }
    return waves.lens.emulated;
}

/// Recording again replaces what the emulator gave before, and nothing else.
Result<void> replaceable(const std::string& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return {};
    const auto there = projects::openWaves(file);
    if (there && !there->shaped.empty()) {
        return fail(Fault::cannotWrite,
                    "\"" + file + "\" holds " + std::to_string(there->shaped.size()) +
                        " learnt waves that would be lost; choose another name, or delete it first.");
    }
    if (there && allSimulated(*there)) return {};
    return fail(Fault::cannotWrite,
                "\"" + file + "\" is there already and holds no simulated waves; choose another name.");
}

Result<void> record(const LensRecordOptions& options) {
    const auto preset = presetNamed(options.preset);
    if (!preset) return tl::unexpected(preset.error());
    if (auto may = replaceable(options.out); !may) return may;
    LensBench bench;
    bench.preset = *preset;
    bench.seed = options.seed;
    bench.temperature_C = options.temperature_C;
    const Hertz rate = Hertz::fromSi(options.rate_Hz);
    const auto start = std::chrono::steady_clock::now();
    auto records = options.paper ? paperWaves(bench, rate) : surveyed(bench, rate, options.waves);
    if (!records) return tl::unexpected(records.error());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    projects::WaveFile waves = emptyFile(bench);
    waves.records = *std::move(records);
    if (auto saved = projects::saveWaves(options.out, waves); !saved) return saved;
    std::cout << options.out << ": " << waves.records.size() << " waves of the " << waves.lens.name() << " at "
              << options.rate_Hz << " Hz, recorded in " << asText("%.1f", seconds) << " s. Simulated, not measured.\n";
    return {};
}

Result<LensBench> benchFor(const LensShapeOptions& options, projects::WaveFile& waves) {
    if (options.file.empty()) {
        const auto preset = presetNamed(options.preset);
        if (!preset) return tl::unexpected(preset.error());
        LensBench bench;
        bench.preset = *preset;
        waves = emptyFile(bench);
        return bench;
    }
    auto opened = projects::openWaves(options.file);
    if (!opened) return tl::unexpected(opened.error());
    waves = *std::move(opened);
    auto bench = benchOf(waves.lens);
    if (!bench) {
        return fail(Fault::unsupported, "\"" + options.file + "\" is of " + waves.lens.name() +
                                            ", but this version can only drive the simulated lens; give a --preset.");
    }
    const auto calibration = calibrationFrom(waves);
    if (!calibration) return tl::unexpected(calibration.error());
    bench->temperature_C = (*calibration)->temperature_C;
    return *bench;
}

void print(const ShapedWave& wave, const LensBench& bench, const LensShapeOptions& options) {
    const Extremes drive = extremes(wave.drive);
    const double peak = std::max(std::abs(drive.low), std::abs(drive.high));
    if (options.json) {
        nlohmann::ordered_json out;
        out["lens"] = lensOf(bench).name();
        out["provenance"] = word(wave.provenance);
        out["rate_Hz"] = wave.rate.si();
        out["temperature_C"] = wave.temperature_C;
        for (const Hold& hold : wave.holds)
            out["holds"].push_back({{"centre", hold.centre}, {"length", hold.length}, {"power_D", hold.power_D}});
        out["largest_error_D"] = wave.largestError_D;
        out["errors_D"] = wave.errors_D;
        out["drive"] = {{"unit", word(wave.unit)}, {"peak", peak}, {"rms", wave.drive.rms()}};
        for (const auto& c : wave.drive.c)
            out["drive"]["harmonics"].push_back({c.real(), c.imag()});
        std::cout << out.dump(2) << '\n';
        return;
    }
    std::cout << "Learnt on the " << lensOf(bench).name() << " at " << options.rate_Hz
              << " Hz; simulated, not measured.\n"
              << "Largest error inside the holds, play by play (D):";
    for (const double error : wave.errors_D)
        std::cout << ' ' << asText("%.4f", error);
    std::cout << "\nKept: " << asText("%.4f", wave.largestError_D) << " D over " << wave.holds.size() << " holds of "
              << asText("%.1f", 100.0 * options.duty) << " % of the sweep; drive " << asText("%.4f", peak) << ' '
              << word(wave.unit) << " peak, " << asText("%.4f", wave.drive.rms()) << " rms.\n";
}

Result<void> shape(const LensShapeOptions& options) {
    if (options.levels_D.size() < 2) {
        return fail(Fault::outOfRange, "A shaped wave needs at least two levels, such as --levels 0,2.2.");
    }
    projects::WaveFile waves;
    const auto bench = benchFor(options, waves);
    if (!bench) return tl::unexpected(bench.error());
    if (!options.out.empty() && options.out != options.file) {
        if (auto may = replaceable(options.out); !may) return may;
    }
    std::vector<Dioptre> levels;
    for (const double level : options.levels_D)
        levels.push_back(Dioptre::fromSi(level));
    auto wave = learntOn(*bench, levels, options.duty, options.harmonics, Hertz::fromSi(options.rate_Hz));
    if (!wave) return tl::unexpected(wave.error());
    print(*wave, *bench, options);
    if (options.out.empty()) return {};
    waves.shaped.push_back(*std::move(wave));
    return projects::saveWaves(options.out, waves).map([&] {
        (options.json ? std::cerr : std::cout) << options.out << ": " << waves.records.size() << " recorded and "
                                               << waves.shaped.size() << " shaped waves\n";
    });
}

int ended(const char* command, const Result<void>& result) { return result ? kDone : refused(command, result.error()); }

}  // namespace

int lensRecordCommand(const LensRecordOptions& options) { return ended("lens record", record(options)); }
int lensShapeCommand(const LensShapeOptions& options) { return ended("lens shape", shape(options)); }

int lensImportCommand(const std::string& folder, const std::string& out) {
    const auto done = replaceable(out)
                          .and_then([&] { return projects::importWaves(folder); })
                          .and_then([&](projects::WaveFile waves) {
                              waves.software = std::string("illuminatedfocus ") + kVersion;
                              return projects::saveWaves(out, waves).map([&] {
                                  std::cout << out << ": " << waves.records.size() + waves.shaped.size() << " waves, "
                                            << waves.lens.name() << '\n';
                              });
                          });
    return ended("lens import", done);
}

int lensExportCommand(const std::string& file, const std::string& folder) {
    const auto done = projects::openWaves(file).and_then([&](const projects::WaveFile& waves) {
        return projects::exportWaves(folder, waves).map([&] {
            std::cout << folder << ": " << waves.records.size() + waves.shaped.size() << " waves, " << waves.lens.name()
                      << '\n';
        });
    });
    return ended("lens export", done);
}

}  // namespace ilf::app
