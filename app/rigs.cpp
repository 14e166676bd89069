#include "app/rigs.h"

#include <utility>

#include "core/plan/projector.h"
#include "projects/wearer_rig.h"

namespace ilf::app {
namespace {

/// Milliamperes and dioptres of the emulated lens (preset datasheet; the others differ in how fast they get there), as
/// warm as each current makes it in the end, in a room of 30 C.
constexpr std::pair<double, double> kStatic_mA_D[] = {
    {-250.0, -12.031}, {-225.0, -11.327}, {-200.0, -10.575}, {-175.0, -9.703}, {-150.0, -8.670}, {-125.0, -7.461},
    {-100.0, -6.082},  {-75.0, -4.556},   {-50.0, -2.920},   {-25.0, -1.215},  {0.0, 0.510},     {25.0, 2.209},
    {50.0, 3.842},     {75.0, 5.376},     {100.0, 6.794},    {125.0, 8.097},   {150.0, 9.308},   {175.0, 10.477},
    {200.0, 11.688},   {225.0, 13.057},   {250.0, 14.742}};

LensWiring emulatedWiring() {
    LensWiring wiring;
    // Drives of the emulated lens are volts before its amplifier of 2.4 A/V.
    wiring.amplifier.input = VoltPerAmpere::fromSi(1.0 / 2.4);
    for (const auto& [current_mA, power_D] : kStatic_mA_D)
        wiring.powers.push_back({Ampere::fromSi(1e-3 * current_mA), Dioptre::fromSi(power_D)});
    return wiring;
}

}  // namespace

Rig emulatedRig() {
    Rig rig;
    rig.name = "Emulated LightCrafter 4500 and lenses";
    rig.projector = {912, 1140};
    rig.kind = ProjectorKind::lightCrafter4500;
    rig.bits = 4;
    rig.slotRate = 6.0 * rig.sweepRate;
    rig.projectorDelay = 0.0_ms;  // the emulated board's TRIG_OUT_2 rises as the first slot's light begins
    rig.devices.emplace();
    rig.devices->projectorAt = "1-2";
    rig.devices->lensesAt = "1-3";
    rig.devices->left = rig.devices->right = emulatedWiring();
    return rig;
}

bool isEmulatedRig(std::string_view word) {
    constexpr std::string_view name = kEmulatedRig;
    if (!word.starts_with(name)) return false;
    word.remove_prefix(name.size());
    return word.empty() || (word.size() == 2 && word[0] == ':' && word[1] >= '1' && word[1] <= '8');
}

Result<Rig> rigFrom(const std::string& wordOrFile) {
    if (wordOrFile == kSimulatedRig) return Rig{};
    if (isEmulatedRig(wordOrFile)) {
        if (wordOrFile == kEmulatedRig) return emulatedRig();
        return withProjector(emulatedRig(), ProjectorKind::lightCrafter4500, wordOrFile.back() - '0');
    }
    return projects::readRig(wordOrFile);
}

}  // namespace ilf::app
