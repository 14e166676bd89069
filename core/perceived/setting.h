// What every way of working out a view starts with: a checked request, its scale and the eye's attention.
#pragma once

#include "core/perceived/attention.h"

namespace ilf::view {

struct Setting {
    ViewScale scale;
    Attention attention;
    bool plain = false;  ///< nothing is blurred for anybody: the view is the picture
};

/// A still lens that blurs nothing shows the picture: the eye is free to look around and focuses wherever it looks.
/// Asked what it sees attending one region, it shows what that leaves blurred.
Result<Setting> setting(const Document& document, const Plan& plan, const Program& program, const ViewRequest& request);

}  // namespace ilf::view
