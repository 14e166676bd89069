// Where a rig is measured: its devices on the USB, or a bench that is emulated in the process.
#pragma once

#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/document/rig.h"
#include "devices/measure/rig_measurement.h"

namespace ilf::devices {
struct EmulatedBench;
}

namespace ilf::app {

/// What is asked for. Nothing is opened by it.
struct MeasureOrder {
    std::string word;  ///< of the rig, as `--rig` takes it
    Rig rig;
    Eye eye = Eye::left;
    bool projector = true;  ///< its delay as well
    Hertz rate = 60.0_Hz;
    std::size_t waves = 40;
    /// Two powers or more. None on an emulated bench: as an emulated lensmeter tells them.
    std::optional<std::vector<StaticPower>> known;
    std::optional<double> temperature_C;  ///< of the lens; an emulated one says its own
    std::string model, serial;            ///< of the lens
};

/// Refused, with what would help: rigs whose devices nobody could measure.
Result<void> measurable(const std::string& word, const Rig& rig);

/// Lines of milliamperes and dioptres; those that do not begin with a number are headings or remarks. Refused: a line
/// that is neither, with its number; `name` is what the sentence calls the list.
Result<std::vector<StaticPower>> knownPowers(std::istream& lines, const std::string& name);

/// Used by one thread.
class MeasurePlace {
public:
    /// `stop` and `watch` as in RigMeasurementSetup. Refused: what `measurable` refuses, fewer than two known powers,
    /// no temperature, devices that are not there.
    static Result<std::unique_ptr<MeasurePlace>> open(const MeasureOrder& order, std::function<bool()> stop,
                                                      devices::MeasureWatch watch);
    ~MeasurePlace();

    /// In the order they are done.
    std::vector<devices::MeasureStep> steps() const;
    /// On an emulated bench somebody has connected by now what the step asks for.
    void connected(devices::MeasureStep step);
    devices::RigMeasurement& measurement() { return *measurement_; }
    /// What comes of it is no measurement of glass: an emulated bench, or devices on an emulated bus.
    bool simulated() const { return simulated_; }
    const MeasureOrder& order() const { return order_; }
    const std::vector<StaticPower>& known() const { return known_; }
    /// For tests, which let things go wrong on it; nullptr: real devices.
    devices::EmulatedBench* bench();

private:
    struct Parts;
    explicit MeasurePlace(MeasureOrder order);
    Result<void> openedBench(devices::RigMeasurementSetup& setup);
    Result<void> openedDevices(devices::RigMeasurementSetup& setup);

    MeasureOrder order_;
    std::vector<StaticPower> known_;
    bool simulated_ = true;
    std::unique_ptr<Parts> parts_;
    std::unique_ptr<devices::RigMeasurement> measurement_;  // last: it ends before what it measures with
};

/// Whether this rig word is measured on the emulated bench.
bool onEmulatedBench(const std::string& word);

}  // namespace ilf::app
