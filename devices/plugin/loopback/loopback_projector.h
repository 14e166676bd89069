// What a test may ask of the loopback plugin besides: its clock, its light, and faults at any time.
#pragma once

#include <stdint.h>

// NOLINTBEGIN: this is C, which the rules for C++ would turn into C++.

#ifdef __cplusplus
extern "C" {
#endif

/// Before each call of the plugin, by its name ("swap"): 0 lets it be, 1 makes it fail, 2 makes it fail after it took
/// effect.
typedef int (*ilf_loopback_judge)(const char* call, void* user);

/// A table of this name (ILF_LOOPBACK_HOOKS) is exported beside the plugin's entry.
typedef struct ilf_loopback_hooks {
    /// Forgets everything: closed, no faults, no judge. With `manual_clock` time stands still, at 0 ns, unless
    /// `advance_ns` or a call's waiting moves it.
    void (*reset)(int manual_clock);
    uint64_t (*now_ns)(void);
    void (*advance_ns)(uint64_t by);
    /// Faults as in `open`'s options, from now on; empty: none. 0 if they are not understood.
    int (*set_faults)(const char* options);
    /// Null: nobody judges.
    void (*set_judge)(ilf_loopback_judge judge, void* user);
    /// The light of a slot, `bytes` = width x height of it, as the room sees it now: full in steady white. 0 if there
    /// is no such slot or not so many pixels.
    int (*light_of_slot)(uint32_t slot, uint8_t* pixels, uint64_t bytes);
    /// 1 while a slot's light is not full everywhere.
    int (*slotted)(void);
    /// Null while it is closed.
    struct ilf_projector* (*opened)(void);
    uint32_t (*slots)(void);
    double (*slot_rate_hz)(void);
} ilf_loopback_hooks;

#define ILF_LOOPBACK_HOOKS "ilf_loopback"

#ifdef __cplusplus
}
#endif

// NOLINTEND
