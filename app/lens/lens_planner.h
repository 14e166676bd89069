// Plans with what is known of the rig's lens: its calibration file, or the simulated lens's own records.
#pragma once

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "app/lens/calibration_of.h"
#include "core/plan/plan.h"
#include "devices/simulated/emulated_lens.h"

namespace ilf::app {

/// Calibrations are made once a file, or a rate of the simulated lens, and kept; the recorded waves of the simulated
/// lens (paper, slotAware) take seconds the first time. One thread at a time.
class LensPlanner {
public:
    /// `lens`: what is simulated where the rig names no file.
    explicit LensPlanner(devices::SimulatedLens lens = devices::kUsualLens) : lens_(lens) {}

    /// None for the ideal lens, which needs none, and for rigs that plan ideal sines.
    /// `rest`: where the wearer's prescription holds the lens.
    Result<Calibration> calibration(const Rig& rig, Dioptre rest = {});
    /// What the document asks, with the lens's calibration.
    Result<PlanInput> input(const Document& document);
    /// With `learn` a shaped wave that is asked for and missing is learnt first, where the lens is simulated (0.2 s); a
    /// real lens learns with `illuminatedfocus lens shape`.
    Result<Plan> plan(const PlanInput& input, const Plan* previous, bool learn);

private:
    bool learn(const PlanInput& input, const std::vector<Dioptre>& levels);

    /// File, when written; or of the simulated lens: rate, many records, rest power.
    using Key = std::tuple<std::string, double, bool, double>;
    static Key keyOf(const Rig& rig, Dioptre rest);

    devices::SimulatedLens lens_;
    std::map<Key, Calibration> known_;
    std::set<std::pair<Key, std::vector<Dioptre>>> cannotLearn_;
};

/// How long a learnt wave holds each of `levels` levels, as a share of the sweep: 30 % for two up to 75 Hz, 27 % above;
/// more levels leave less for each.
double usualDuty(std::size_t levels, Hertz rate);
inline constexpr int kUsualHarmonics = 5;

}  // namespace ilf::app
