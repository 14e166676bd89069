// `validate`: opens, plans and compiles a project and says all that is wrong with it.
#pragma once

#include <string>

namespace ilf::app {

int validateCommand(const std::string& file);

}  // namespace ilf::app
