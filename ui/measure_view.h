// Measuring a rig, as the window shows it: the steps, what is heard now, and what came of them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/document/wearer.h"
#include "ui/charts.h"

namespace ilf::ui {

/// What the operator says before the first step.
struct MeasureSetup {
    Eye eye = Eye::left;
    bool projector = true;      ///< its delay as well
    std::string known;          ///< "milliamperes, dioptres", one a line
    std::string temperature;    ///< of the lens, degrees C
    std::string model, serial;  ///< of the lens
    bool operator==(const MeasureSetup&) const = default;
};

enum class MeasureStanding { waiting, now, working, good, bad };

struct MeasureStepView {
    std::string title, connect, expect;
    MeasureStanding standing = MeasureStanding::waiting;
    std::string measured, advice;  ///< what came of it; `advice` where that was not good
};

/// Nothing of it is a device: the app measures and says how far it is.
struct MeasureView {
    enum class State {
        setup,       ///< what is known of the lens is asked for
        preparing,   ///< devices are taken from the output core and opened
        connecting,  ///< the operator connects what the step needs
        working,
        judged,  ///< the step's outcome is shown
        good,    ///< every step was good; nothing is written yet
        storing,
        stored,
        ending,  ///< the lenses go to rest, and devices back to the output core
    };
    State state = State::setup;
    std::string rig;            ///< its name
    bool emulated = false;      ///< on a bench in this program
    bool holdsDevices = false;  ///< the output core is stopped meanwhile, in safe light
    Eye eye = Eye::left;
    std::vector<MeasureStepView> steps;
    std::size_t at = 0;   ///< the step that is done, or shown
    std::string doing;    ///< "wave 12 of 43"
    std::string trouble;  ///< the last thing that was refused, with what helps
    std::string file;     ///< that was written

    /// What AI0 and AI1 heard last: milliseconds, volts.
    std::vector<ChartPoint> input0, photodiode;
    /// Powers at rest by milliamperes, and those of them that were known before.
    std::vector<ChartPoint> powers, known;
    /// The last wave: milliseconds of its period, dioptres, and the drive that makes it in milliamperes.
    std::vector<ChartPoint> wave, drive;
    std::string waveName;  ///< "-1.20 to 3.40 D"
};

}  // namespace ilf::ui
