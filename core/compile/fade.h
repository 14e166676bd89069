// Light of regions that are on their way to another look: a mixture of whole programs, so that it goes over evenly.
#pragma once

#include <vector>

#include "core/compile/compile.h"

namespace ilf {

/// A document in which nothing fades, and its share of the light.
struct FadePart {
    Document document;
    double share = 0.0;
};

/// What the document's light is mixed of; a document in which nothing fades is its only part. Each fading region has
/// its other look in just its share of the whole.
std::vector<FadePart> fadeParts(const Document& document);

/// Why programs are mixed and not masks: closed-form blending (compile.h) is linear in the light, so that a mixture of
/// two programs that each add up to even light does so too, at seams as well. A mask of half coverage has its border,
/// with the feather's ramp, where coverage passes one half: faded by its coverage, the ramp would vanish at once there.
/// `plan` is that of `document`: all parts play in its sweep.
Result<Compiled> compiledFading(const Document& document, const Plan& plan, const std::vector<FadePart>& parts,
                                const Compiled* previous);

/// The earlier compile that serves best: itself, or one of those it was mixed of.
const Compiled* likest(const Compiled* previous, const Document& document, const Plan& plan);

}  // namespace ilf
