// A mark in the runtime directory while a stage may be anything but safe, so that others can see to it.
#pragma once

#include <filesystem>

#include "core/base/quantity.h"

namespace ilf::app {

/// Set by a player before it first touches a real (or emulated) stage, taken away once that is safe and left alone. A
/// player that is killed leaves it behind, with the power at which its wearer's lenses rest; who comes after it lets
/// them rest there.
void markStage(const std::filesystem::path& runtimeDirectory, Dioptre rest);
void unmarkStage(const std::filesystem::path& runtimeDirectory);
bool stageIsMarked(const std::filesystem::path& runtimeDirectory);
/// As marked; 0 D without a mark, or where it says nothing sensible.
Dioptre markedRest(const std::filesystem::path& runtimeDirectory);

/// Held by the white guard.
std::filesystem::path guardLock(const std::filesystem::path& runtimeDirectory);

}  // namespace ilf::app
