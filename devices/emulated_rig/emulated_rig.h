// A whole rig that nobody has to own, as a process: projector, converter, lenses, USB bus and the projector's display.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/base/result.h"
#include "devices/simulated/lens_emulator.h"

namespace ilf::devices {

/// Where its devices hang on the emulated bus.
inline constexpr const char* kEmulatedProjectorAt = "1-2";
inline constexpr const char* kEmulatedLensesAt = "1-3";

/// Serves until `stopDescriptor` (for example a signalfd) can be read; `said` gets one line for each thing worth a log.
/// Once everything is there, `rigEnvironment` tells programs how to see it; orders reach its devices by their cables
/// alone. Answers Read, ReadReceived, ReadExposure and RigMishap at `devicesAddress`.
///
/// Refuses if other devices run in this directory already; without libumockdev-preload.so.0 in LD_PRELOAD; without
/// Xvfb: each in one sentence that says what is missing.
Result<void> serveEmulatedRig(const std::filesystem::path& runtimeDirectory, LensPreset lens, int stopDescriptor,
                              const std::function<void(const std::string&)>& said);

}  // namespace ilf::devices
