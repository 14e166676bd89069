// Why the plan says nothing of a region.
#pragma once

#include <string>

#include "core/document/document.h"

namespace ilf::ui {

/// In a sentence, with what would help. Precondition: the document has a plan, and the region is not in it.
std::string whyNoPart(const Document& document, const Region& region);

}  // namespace ilf::ui
