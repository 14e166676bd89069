// `validate`: opens, plans and compiles a project and says all that is wrong with it.
#pragma once

#include <string>

#include "app/lens/rig_choice.h"

namespace ilf::app {

int validateCommand(const std::string& file, const RigChoice& rig = {});

}  // namespace ilf::app
