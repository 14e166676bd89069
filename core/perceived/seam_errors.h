// What is known of the errors of a document's seams, in place of what is assumed.
#pragma once

#include <optional>

#include "core/document/document.h"
#include "core/perceived/seam_robustness.h"
#include "core/plan/plan.h"

namespace ilf {

/// The assumed errors, with what is known instead: `registration` is the residual of the rig's registration, cast onto
/// the farthest surface of the plan, twice it the coarse one; `nearer` and `farther` are at least two standard
/// deviations of the least certain distance. The feather that seams suggest follows from them (scheduling 4.3).
/// `plan` is the document's.
SeamErrors knownErrors(const Document& document, const Plan& plan);

/// The rms residual of the rig's registration on a surface at `distance`; none where it was typed, or rests on no more
/// points than it takes.
std::optional<Metre> knownRegistration(const Document& document, Metre distance);

/// A length of `px` projector pixels on a surface at `distance`, in the middle of the picture.
Metre onSurface(const Document& document, double px, Metre distance);

}  // namespace ilf
