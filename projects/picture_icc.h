// The colour profile that tells readers of a file that its codes are sRGB.
#pragma once

#include <string>

namespace ilf::projects {

/// An ICC profile (version 4.3, ICC.1:2010): sRGB's primaries adapted to D50 and its exact transfer function.
std::string srgbProfile();

}  // namespace ilf::projects
