// The debug panel: what the last view, the last compile and the last frame took, and what they could leave out.
#pragma once

#include <string>
#include <vector>

#include "ui/view.h"

namespace ilf::ui {

/// One row: what is counted, its value, and a sentence for the tooltip.
struct DebugRow {
    const char* label;
    std::string value;
    const char* help;
};
struct DebugSection {
    std::string title;
    std::vector<DebugRow> rows;
};

/// What the panel says; sections without figures are left out.
std::vector<DebugSection> debugSections(const Computed& computed);

}  // namespace ilf::ui
