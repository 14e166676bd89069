#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "app/exit_code.h"
#include "app/headless/lens_command.h"
#include "app/headless/prepare.h"
#include "app/lens/calibration_of.h"
#include "core/base/as_text.h"
#include "core/lens/sine_record.h"

namespace ilf::app {
namespace {

using Json = nlohmann::ordered_json;

struct Range {
    double low = HUGE_VAL, high = -HUGE_VAL;
    void include(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};
Json json(const Range& range) { return {range.low, range.high}; }

/// All waves of one rate.
struct RateInfo {
    std::map<std::string, int> families;
    Range power_D, drive;
    int beyond = 0;  ///< leave the lens's limits
};

std::map<double, RateInfo> ratesOf(const projects::WaveFile& waves, const DriveLimits& limits) {
    std::map<double, RateInfo> rates;
    const auto include = [&](Hertz rate, const std::string& family, const Harmonics& drive, double low, double high) {
        RateInfo& info = rates[rate.si()];
        ++info.families[family];
        info.power_D.include(low);
        info.power_D.include(high);
        const Extremes ends = extremes(drive);
        info.drive.include(ends.low);
        info.drive.include(ends.high);
        if (low < limits.lensMin.si() || high > limits.lensMax.si()) ++info.beyond;
    };
    for (const LensRecord& record : waves.records) {
        const auto [low, high] = std::minmax_element(record.power_D.begin(), record.power_D.end());
        include(record.rate, record.family, record.drive, *low, *high);
    }
    for (const ShapedWave& wave : waves.shaped) {
        const Extremes ends = extremes(wave.power);
        include(wave.rate, "shaped", wave.drive, ends.low, ends.high);
    }
    return rates;
}

Json infoOf(const std::string& file, const projects::WaveFile& waves, const LensCalibration& calibration) {
    Json out;
    out["file"] = file;
    out["lens"] = calibration.lens;
    out["simulated"] = waves.lens.emulated;
    out["eye"] = waves.lens.eye;
    out["recorded_utc"] = waves.recordedUtc;
    out["method"] = waves.method;
    out["software"] = waves.software;
    std::set<std::string> provenance;
    Range temperature;
    for (const LensRecord& record : waves.records) {
        provenance.insert(std::string(word(record.provenance)));
        temperature.include(record.temperature_C);
    }
    for (const ShapedWave& wave : waves.shaped) {
        provenance.insert(std::string(word(wave.provenance)));
        temperature.include(wave.temperature_C);
    }
    out["provenance"] = provenance;
    out["temperature_C"] = {{"at_rest", calibration.temperature_C}, {"while_played", json(temperature)}};
    const DriveLimits& limits = calibration.limits;
    out["limits"] = {{"drive_unit", word(calibration.unit)},
                     {"drive_peak", limits.peak},
                     {"drive_rms", limits.rms},
                     {"power_D", {limits.lensMin.si(), limits.lensMax.si()}}};
    for (const auto& [rate, info] : ratesOf(waves, limits)) {
        Json one = {{"rate_Hz", rate},
                    {"waves", info.families},
                    {"power_D", json(info.power_D)},
                    {"drive", json(info.drive)},
                    {"beyond_lens", info.beyond}};
        one["model"] = nullptr;
        for (const ContinuousModel& model : calibration.models) {
            if (!sameRate(model.rate, Hertz::fromSi(rate))) continue;
            one["model"] = {
                {"degree", model.degree}, {"rms_fit_D", model.rmsFit_D}, {"largest_fit_D", model.largestFit_D}};
        }
        out["rates"].push_back(one);
    }
    out["shaped"] = Json::array();
    for (const ShapedWave& wave : waves.shaped) {
        Json one = {{"id", wave.id}, {"rate_Hz", wave.rate.si()}, {"largest_error_D", wave.largestError_D}};
        for (const Hold& hold : wave.holds)
            one["holds"].push_back({{"centre", hold.centre}, {"length", hold.length}, {"power_D", hold.power_D}});
        out["shaped"].push_back(one);
    }
    return out;
}

std::string span(const Json& range, const char* format) {
    return asText(format, range[0]) + " to " + asText(format, range[1]);
}

void print(const Json& info) {
    const std::string unit = info["limits"]["drive_unit"];
    std::cout << info["file"].get<std::string>() << ": " << info["lens"].get<std::string>();
    for (const auto& word : info["provenance"])
        std::cout << ", " << word.get<std::string>();
    std::cout << "\n  eye " << info["eye"].get<std::string>() << ", recorded "
              << info["recorded_utc"].get<std::string>() << " (" << info["method"].get<std::string>()
              << ")\n  temperature " << asText("%.1f", info["temperature_C"]["at_rest"]) << " degrees C at rest, "
              << span(info["temperature_C"]["while_played"], "%.1f") << " while played\n  limits "
              << asText("%.4g", info["limits"]["drive_peak"]) << ' ' << unit << " peak, "
              << asText("%.4g", info["limits"]["drive_rms"]) << ' ' << unit << " rms, "
              << span(info["limits"]["power_D"], "%g") << " D\n";
    for (const Json& rate : info["rates"]) {
        std::cout << "  " << asText("%g", rate["rate_Hz"]) << " Hz:";
        for (const auto& [family, count] : rate["waves"].items())
            std::cout << ' ' << count << ' ' << family;
        std::cout << ", powers " << span(rate["power_D"], "%.2f") << " D, drives " << span(rate["drive"], "%.4f") << ' '
                  << unit;
        if (rate["beyond_lens"] > 0) std::cout << "; " << rate["beyond_lens"] << " beyond the lens, never chosen";
        if (rate["model"].is_null()) {
            std::cout << "\n    no continuous model: too few or too similar waves\n";
        } else {
            std::cout << "\n    continuous model of degree " << rate["model"]["degree"] << ": "
                      << asText("%.4f", rate["model"]["rms_fit_D"]) << " D rms, "
                      << asText("%.4f", rate["model"]["largest_fit_D"]) << " D largest, noise included\n";
        }
    }
    for (const Json& wave : info["shaped"]) {
        std::cout << "  shaped wave " << wave["id"] << ", " << asText("%g", wave["rate_Hz"]) << " Hz, holds";
        for (const Json& hold : wave["holds"])
            std::cout << ' ' << asText("%g", hold["power_D"]) << " D ("
                      << asText("%.0f", 100.0 * hold["length"].get<double>()) << " %)";
        std::cout << " within " << asText("%.3f", wave["largest_error_D"]) << " D\n";
    }
}

Json choiceOf(const LensChooseOptions& options, const LensCalibration& calibration, const WaveChoice& choice) {
    Json out;
    out["lens"] = calibration.lens;
    out["mode"] = options.mode;
    out["rate_Hz"] = options.rate_Hz;
    out["asked_D"] = {options.low_D, options.high_D};
    out["reachable_D"] = choice.reachable.si();
    if (!choice.wave) {
        out["wave"] = nullptr;
        out["why"] = choice.why;
        return out;
    }
    const Waveform& wave = *choice.wave;
    const Extremes power = extremes(wave.power), drive = extremes(wave.drive);
    out["provenance"] = word(wave.provenance);
    Json chosen = {{"id", wave.wave},
                   {"power_D", {power.low, power.high}},
                   {"drive", {{"unit", word(wave.unit)}, {"low", drive.low}, {"high", drive.high}}}};
    for (const auto& c : wave.drive.c)
        chosen["drive"]["harmonics"].push_back({c.real(), c.imag()});
    for (const auto& c : wave.power.c)
        chosen["power_harmonics"].push_back({c.real(), c.imag()});
    out["wave"] = chosen;
    return out;
}

}  // namespace

int lensInfoCommand(const std::string& file, bool json) {
    const auto waves = projects::openWaves(file);
    if (!waves) return refused("lens info", waves.error());
    const auto calibration = calibrationFrom(*waves);
    if (!calibration) return refused("lens info", calibration.error());
    const Json info = infoOf(file, *waves, **calibration);
    if (json) {
        std::cout << info.dump(2) << '\n';
    } else {
        print(info);
    }
    return kDone;
}

int lensChooseCommand(const LensChooseOptions& options) {
    const auto mode = waveModeFromWord(options.mode);
    if (!mode || *mode == WaveMode::idealSine) {
        return refused("lens choose", {Fault::outOfRange, "There is no mode \"" + options.mode +
                                                              "\". Choose paper, slot-aware, continuous or shaped."});
    }
    const auto calibration = projects::openWaves(options.file).and_then(calibrationFrom);
    if (!calibration) return refused("lens choose", calibration.error());
    WaveWish wish;
    wish.low = Dioptre::fromSi(options.low_D);
    wish.high = Dioptre::fromSi(options.high_D);
    wish.levels = {wish.low, wish.high};
    wish.rate = Hertz::fromSi(options.rate_Hz);
    const WaveChoice choice = chosenWave(**calibration, *mode, wish);
    if (options.json) std::cout << choiceOf(options, **calibration, choice).dump(2) << '\n';
    if (!choice.wave) return refused("lens choose", {Fault::unsafe, choice.why});
    if (options.json) return kDone;
    const Extremes power = extremes(choice.wave->power), drive = extremes(choice.wave->drive);
    std::cout << (choice.wave->wave != 0 ? "Wave " + std::to_string(choice.wave->wave)
                                         : std::string("A wave between the records"))
              << " (" << options.mode << ", " << word(choice.wave->provenance) << "): " << asText("%.3f", power.low)
              << " to " << asText("%.3f", power.high) << " D for " << asText("%g", options.low_D) << " to "
              << asText("%g", options.high_D) << " D asked, driven from " << asText("%.5f", drive.low) << " to "
              << asText("%.5f", drive.high) << ' ' << word(choice.wave->unit) << "; up to "
              << asText("%.2f", choice.reachable.si()) << " D can be reached\n";
    return kDone;
}

}  // namespace ilf::app
