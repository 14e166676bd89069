#include "core/plan/report.h"

namespace ilf {

PlanReport planReport(const Plan& plan) {
    return {whyThisSweep(plan), whatWouldHelp(plan), planNotes(plan), lightCurve(plan)};
}

}  // namespace ilf
