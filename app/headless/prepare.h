// Opening, planning and compiling in one go, for the headless commands.
#pragma once

#include <string>

#include "app/lens/rig_choice.h"
#include "app/open.h"
#include "core/compile/compile.h"

namespace ilf::app {

struct Prepared {
    OpenedFile opened;
    Compiled compiled;
    double open_ms = 0.0, plan_ms = 0.0, compile_ms = 0.0;
};

Result<Prepared> prepared(const std::string& file, const RigChoice& rig = {});

/// Writes "illuminatedfocus COMMAND: sentence" to standard error and gives the exit code.
int refused(const char* command, const Error& error);

}  // namespace ilf::app
