// How the programs end: the exit codes scripts rely on.
#pragma once

#include "core/base/result.h"

namespace ilf::app {

enum ExitCode : int {
    kDone = 0,
    kFailed = 1,
    kUsage = 2,
    kDevice = 3,
    kUnsafePlan = 4,
};

inline int exitCode(const Error& error) {
    switch (error.fault) {
    case Fault::device:
        return kDevice;
    case Fault::unsafe:
        return kUnsafePlan;
    default:
        return kFailed;
    }
}

}  // namespace ilf::app
