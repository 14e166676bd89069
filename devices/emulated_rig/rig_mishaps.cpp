#include "devices/emulated_rig/rig_mishaps.h"

#include <array>
#include <cassert>
#include <limits>
#include <utility>

namespace ilf::devices {
namespace {

using emulators::Mishap;

constexpr std::array<std::pair<std::string_view, Mishap>, 10> kWords{{{"nack", Mishap::nack},
                                                                      {"silence", Mishap::silence},
                                                                      {"stall", Mishap::stall},
                                                                      {"unplug", Mishap::unplug},
                                                                      {"wrong-mode", Mishap::wrongMode},
                                                                      {"underrun", Mishap::underrun},
                                                                      {"over-temperature", Mishap::overTemperature},
                                                                      {"dropped-trigger", Mishap::droppedTrigger},
                                                                      {"clock-drift", Mishap::clockDrift},
                                                                      {"stuck-frame", Mishap::stuckFrame}}};

}  // namespace

std::optional<Mishap> mishapFromWord(std::string_view word) {
    for (const auto& [name, mishap] : kWords)
        if (name == word) return mishap;
    return std::nullopt;
}

std::string mishapWords() {
    std::string words;
    for (const auto& [name, mishap] : kWords)
        words += std::string(words.empty() ? "" : ", ") + std::string(name);
    return words;
}

emulators::DeviceFault faultOf(const RigMishap& mishap) {
    const auto kind = mishapFromWord(mishap.kind);
    assert(kind);
    const auto times = mishap.times == 0 ? std::numeric_limits<std::uint64_t>::max() : mishap.times;
    return {*kind, mishap.after, times, mishap.amount};
}

}  // namespace ilf::devices
