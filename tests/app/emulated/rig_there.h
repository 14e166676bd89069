// Whether programs with an emulated rig can run here at all; where not, tests skip aloud.
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>

namespace ilf {

/// Xvfb and umockdev's preload are what the rig is made of; sanitizers want to be loaded before the latter and cannot
/// be, in processes that the core starts.
inline bool rigThere() {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
    MESSAGE("SKIPPED: the emulated rig's processes preload a library that a sanitizer must precede");
    return false;
#else
    if (std::system("command -v Xvfb >/dev/null 2>&1") != 0) {
        MESSAGE("SKIPPED: there is no Xvfb (package xvfb)");
        return false;
    }
    if (std::system("LD_PRELOAD=libumockdev-preload.so.0 true 2>&1 | grep -q preloaded") == 0) {
        MESSAGE("SKIPPED: there is no libumockdev-preload.so.0 (package umockdev)");
        return false;
    }
    return true;
#endif
}

}  // namespace ilf
