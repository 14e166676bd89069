// What a prediction means, in the sentences an operator reads: one that dominates, and one on privacy.
#pragma once

#include <string>

#include "core/perceived/prediction.h"

namespace ilf {

/// What the dominant sentence is about. The first that applies wins:
enum class Saying {
    problem,   ///< the plan cannot do what is asked: its own sentence, whatever else is predicted
    readable,  ///< to be blurred, and yet print in it can be read while the wearer looks elsewhere
    blurred,   ///< to be blurred: how much
    soft,      ///< to be sharp, but blurred beyond the circle of confusion once its +- is counted
    seam,      ///< to be sharp, with a border that will be seen: `kSeamSeen` or more
    sharp,     ///< to be sharp: how sharp it stays
    even,      ///< neutral: which part of its light is sharp
    steady,    ///< nothing sweeps and nothing is blurred
};
/// Raw contrast from which a blended border is seen: about 1 % weighted by the eye's sensitivity (scheduling 4.3).
inline constexpr double kSeamSeen = 0.04;

struct Statement {
    Saying about = Saying::steady;
    bool warns = false;
    std::string text{};
    std::string help{};     ///< the plan's, for a problem
    std::string privacy{};  ///< of blurred regions seen by a person: whether print in it stays unreadable
    bool privacyWarns = false;
    bool operator==(const Statement&) const = default;
};
Statement statement(const Plan& plan, const RegionPlan& region, const RegionPrediction& seen);

/// "31 \u00b1 8", with as many decimals as the error (or without one the value) gives sense to.
std::string plusMinus(double value, double error);
/// "2.4 \u00b1 0.3 %" of a share of 1.
std::string plusMinusPercent(const Predicted& share);

}  // namespace ilf
