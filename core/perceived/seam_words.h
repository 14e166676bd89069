// What a seam means, in one sentence for the operator.
#pragma once

#include <string>

#include "core/perceived/seam_border.h"

namespace ilf {

/// What is left of a border's seam for two eyes, and what feather would hide it.
std::string saidOf(const BorderSeam& seam, const Seam& settings);

}  // namespace ilf
