/* What a test may ask of the loopback projector besides; a plugin of a real projector has nothing like it. */
#include <string.h>

#include "devices/plugin/loopback/loopback_machine.h"

static void hook_reset(int manual_clock) {
    white();
    memset(&the, 0, sizeof the);
    memset(&wrong, 0, sizeof wrong);
    judge_calls(NULL, NULL);
    use_clock(manual_clock);
}

static int hook_faults(const char* options) {
    faults f;
    memset(&f, 0, sizeof f);
    if (!understood(options, &f, NULL, NULL)) return 0;
    counted();
    wrong = f;
    return 1;
}

static int full_light(uint32_t slot) {
    const size_t n = (size_t)the.width * the.height;
    size_t i;
    for (i = 0; i < n; ++i)
        if (the.front.slot[slot][i] != (the.how.bits == 8 ? 255 : 128)) return 0;
    return 1;
}

static int hook_slotted(void) {
    uint32_t i;
    if (!the.playing) return 0;
    for (i = 0; i < the.how.slots; ++i)
        if (!full_light(i)) return 1;
    return 0;
}

static int hook_light(uint32_t slot, uint8_t* pixels, uint64_t bytes) {
    const uint64_t n = (uint64_t)the.width * the.height;
    if (bytes != n || (the.playing && slot >= the.how.slots)) return 0;
    if (the.playing)
        memcpy(pixels, the.front.slot[slot], (size_t)n);
    else
        memset(pixels, 255, (size_t)n);
    return 1;
}

static ilf_projector* hook_opened(void) { return the.open ? &the : NULL; }
static uint32_t hook_slots(void) { return the.playing ? the.how.slots : 0; }
static double hook_rate(void) { return the.playing ? the.how.slot_rate_hz : 0.0; }

ILF_PLUGIN_EXPORT extern const ilf_loopback_hooks ilf_loopback;
const ilf_loopback_hooks ilf_loopback = {hook_reset, now_ns,       wait_ns,     hook_faults, judge_calls,
                                         hook_light, hook_slotted, hook_opened, hook_slots,  hook_rate};
