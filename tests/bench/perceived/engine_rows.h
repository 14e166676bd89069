// The engine on one scene: every rung, on one and two threads, after every kind of edit.
#pragma once

#include <optional>

#include "tests/bench/perceived/calibration.h"
#include "tests/bench/perceived/scenes.h"
#include "tests/bench/perceived/truth.h"

namespace ilf::bench {

inline constexpr std::array<Rung, 3> kRungs{Rung::dragging, Rung::rest, Rung::idle};

/// What is done between two frames.
namespace edit {
inline constexpr const char* kFirst = "first frame";  ///< an engine that has seen nothing
inline constexpr const char* kFull = "full frame";    ///< the light of every lit pixel changes
inline constexpr const char* kGeometry = "distance moved";
inline constexpr const char* kNothing = "nothing changed";
/// "dab 32 light", "dab 128 mask" ...
std::string dab(int diameter, bool mask);
}  // namespace edit

/// Views that follow each other; the first is seen untimed before the others.
struct Steps {
    std::string what;
    std::vector<Shown> shown;
};
/// All edits the scene allows.
std::vector<Steps> stepsOf(const BenchScene& scene);

/// Times of `see` alone: planning and compiling were done before.
Row engineRow(const BenchScene& scene, const Steps& steps, Rung rung, int threads, const Patience& patience);

/// Adds all rows of a scene; errors of the full frames, if there is a truth.
void addEngineRows(Table& table, const BenchScene& scene, const Truth* truth, const Machine& machine,
                   const Patience& patience, bool sizesOnly = false);

}  // namespace ilf::bench
