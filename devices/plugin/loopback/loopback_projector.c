/* A projector that is not there, as a plugin: the example of how to write one, and what tests play on. It keeps the
 * pictures in memory, counts frames by the clock, and fails on demand.
 *
 * Options (in `open`'s text, and before that in the environment's ILF_LOOPBACK_PROJECTOR), separated by commas:
 *   size=WIDTHxHEIGHT   its raster; without: 1024x768
 *   refuse=CALL:N       the N-th CALL ("swap", or "any") from now fails, once
 *   gone=N              unplugged from the N-th call on
 *   slow=CALL:MS        each CALL takes that many milliseconds longer
 *   drop=N              every N-th frame is not shown
 *   underrun=N          every N-th sweep lacks a picture
 *   lose_trigger=N      every N-th sweep's pulse is missing; with 1, triggers from outside stay away for good
 *   stuck=1             swaps return, and nothing changes
 *   ppm=N               its clock is that much faster than it should be
 *   hot=1, dark=1       too hot; its light source failed
 */
#define _POSIX_C_SOURCE 200809L
#include "devices/plugin/loopback/loopback_projector.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "devices/plugin/illuminatedfocus_projector.h"

enum { MOST_SLOTS = 256, MOST_PIXELS_A_SIDE = 16384 };
static const double SLOWEST_HZ = 1.0, FASTEST_8_BIT_HZ = 1000.0, FASTEST_1_BIT_HZ = 8000.0;

typedef struct buffer {
    uint8_t* slot[MOST_SLOTS]; /* null: no picture */
} buffer;

typedef struct faults {
    char refused[24], slowed[24];
    long refuse_at, gone_at, slow_ms, drop_every, underrun_every, lose_every, ppm;
    int stuck, hot, dark;
    long calls, refusable; /* since they were set */
} faults;

struct ilf_projector {
    int open, playing, configured, triggers_gone;
    uint32_t width, height;
    ilf_configuration how;
    buffer front, back;
    int front_whole;
    uint64_t program;
    uint64_t started_ns, counted_frames, counted_sweeps; /* of this start */
    uint64_t frames_in, frames_out, underruns, triggers_lost;
    uint64_t drop_phase, underrun_phase, lose_phase;
};

static ilf_projector the;
static faults wrong;
static int manual;
static uint64_t manual_ns;
static ilf_loopback_judge judge;
static void* judge_user;

/* ---- time ---- */

static uint64_t now_ns(void) {
    struct timespec t;
    if (manual) return manual_ns;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static void wait_ns(uint64_t ns) {
    struct timespec t;
    if (manual) {
        manual_ns += ns;
        return;
    }
    t.tv_sec = (time_t)(ns / 1000000000u);
    t.tv_nsec = (long)(ns % 1000000000u);
    nanosleep(&t, NULL);
}

/* ---- options and faults ---- */

static int number_after(const char* text, const char* key, long* value) {
    char* end = NULL;
    const size_t n = strlen(key);
    if (strncmp(text, key, n) != 0) return 0;
    *value = strtol(text + n, &end, 10);
    return end != text + n && *end == '\0';
}

/* "refuse=swap:3" */
static int call_after(const char* text, const char* key, char call[24], long* value) {
    const size_t n = strlen(key);
    const char* colon = strchr(text, ':');
    if (strncmp(text, key, n) != 0 || colon == NULL || (size_t)(colon - text) - n >= 24) return 0;
    memset(call, 0, 24);
    memcpy(call, text + n, (size_t)(colon - text) - n);
    return number_after(colon, ":", value);
}

static int size_after(const char* text, uint32_t* width, uint32_t* height) {
    unsigned w = 0, h = 0;
    char rest = 0;
    if (sscanf(text, "size=%5ux%5u%c", &w, &h, &rest) != 2) return 0;
    if (w < 1 || h < 1 || w > MOST_PIXELS_A_SIDE || h > MOST_PIXELS_A_SIDE) return 0;
    *width = w;
    *height = h;
    return 1;
}

/* 0 if it is not understood. */
static int one_option(const char* text, faults* f, uint32_t* width, uint32_t* height) {
    long on = 0;
    if (call_after(text, "refuse=", f->refused, &f->refuse_at)) return f->refuse_at > 0;
    if (call_after(text, "slow=", f->slowed, &f->slow_ms)) return f->slow_ms >= 0;
    if (number_after(text, "gone=", &f->gone_at)) return f->gone_at > 0;
    if (number_after(text, "drop=", &f->drop_every)) return f->drop_every > 0;
    if (number_after(text, "underrun=", &f->underrun_every)) return f->underrun_every > 0;
    if (number_after(text, "lose_trigger=", &f->lose_every)) return f->lose_every > 0;
    if (number_after(text, "ppm=", &f->ppm)) return f->ppm > -100000 && f->ppm < 100000;
    if (number_after(text, "stuck=", &on)) return (f->stuck = on != 0), 1;
    if (number_after(text, "hot=", &on)) return (f->hot = on != 0), 1;
    if (number_after(text, "dark=", &on)) return (f->dark = on != 0), 1;
    return width != NULL && size_after(text, width, height);
}

static int all_options(const char* text, faults* f, uint32_t* width, uint32_t* height) {
    char one[64];
    while (text != NULL && *text != '\0') {
        const size_t n = strcspn(text, ",");
        if (n >= sizeof one) return 0;
        memcpy(one, text, n);
        one[n] = '\0';
        if (n > 0 && !one_option(one, f, width, height)) return 0;
        text += n;
        if (*text == ',') ++text;
    }
    return 1;
}

/* ---- every call begins and ends with these ---- */

static ilf_code said(ilf_code code, ilf_message* message, const char* text) {
    snprintf(message->text, sizeof message->text, "%s", text);
    return code;
}

typedef enum fate { GOES, FAILS, FAILS_AFTERWARDS, IS_GONE } fate;

static fate begun(const char* call) {
    int judged = 0;
    if (judge != NULL) judged = judge(call, judge_user);
    ++wrong.calls;
    if (wrong.slow_ms > 0 && strcmp(wrong.slowed, call) == 0) wait_ns((uint64_t)wrong.slow_ms * 1000000u);
    if (wrong.gone_at > 0 && wrong.calls >= wrong.gone_at) {
        the.playing = 0; /* without power it shows nothing; with power again, white */
        return IS_GONE;
    }
    if (wrong.refuse_at > 0 && (strcmp(wrong.refused, call) == 0 || strcmp(wrong.refused, "any") == 0) &&
        ++wrong.refusable == wrong.refuse_at)
        return FAILS;
    return judged == 0 ? GOES : judged == 1 ? FAILS : FAILS_AFTERWARDS;
}

static ilf_code no(fate f, const char* call, ilf_message* message) {
    if (f == IS_GONE) return said(ILF_ABSENT, message, "The loopback projector is unplugged.");
    snprintf(message->text, sizeof message->text, "It failed (%s).", call);
    return ILF_FAILED;
}

static ilf_code done(fate f, const char* call, ilf_message* message) {
    return f == FAILS_AFTERWARDS ? no(f, call, message) : ILF_OK;
}

/* ---- buffers, sweeps, counters ---- */

static void emptied(buffer* b) {
    int i;
    for (i = 0; i < MOST_SLOTS; ++i) {
        free(b->slot[i]);
        b->slot[i] = NULL;
    }
}

static uint64_t frames_since_start(void) {
    const double rate = the.how.slot_rate_hz * (1.0 + 1e-6 * (double)wrong.ppm);
    return (uint64_t)((double)(now_ns() - the.started_ns) * 1e-9 * rate);
}

/* How often something that happens every `every`-th time happened in `times` more. */
static uint64_t happened(uint64_t times, long every, uint64_t* phase) {
    uint64_t n;
    if (every <= 0) return 0;
    *phase += times;
    n = *phase / (uint64_t)every;
    *phase %= (uint64_t)every;
    return n;
}

static void white(void) {
    the.playing = 0;
    the.program = 0;
    the.front_whole = 0;
    emptied(&the.front);
    emptied(&the.back);
}

static void counted(void) {
    uint64_t frames, sweeps, lost, late, dropped;
    if (!the.playing) return;
    frames = frames_since_start() - the.counted_frames;
    the.counted_frames += frames;
    sweeps = the.counted_frames / the.how.slots - the.counted_sweeps;
    the.counted_sweeps += sweeps;

    lost = happened(sweeps, wrong.lose_every, &the.lose_phase);
    late = happened(sweeps, wrong.underrun_every, &the.underrun_phase);
    dropped = happened(frames, wrong.drop_every, &the.drop_phase) + late;
    if (the.how.trigger != ILF_TRIGGER_OWN_CLOCK) dropped += lost * the.how.slots;
    if (dropped > frames) dropped = frames;
    the.frames_in += frames;
    the.frames_out += frames - dropped;
    the.underruns += late;
    the.triggers_lost += lost;

    if (the.how.trigger != ILF_TRIGGER_OWN_CLOCK && wrong.lose_every == 1 &&
        now_ns() - the.started_ns > the.how.trigger_timeout_ns) {
        white();
        the.triggers_gone = 1;
    }
}

/* ---- the calls ---- */

static ilf_code list(ilf_place* places, uint32_t capacity, uint32_t* count, ilf_message* message) {
    const fate f = begun("list");
    if (f == FAILS) return no(f, "list", message);
    *count = f == IS_GONE ? 0 : 1;
    if (capacity > 0 && *count > 0) {
        snprintf(places[0].id, sizeof places[0].id, "loopback");
        snprintf(places[0].name, sizeof places[0].name, "Loopback projector (makes no light)");
    }
    return done(f, "list", message);
}

static ilf_code open_it(const char* place, const char* options, ilf_projector** projector, ilf_message* message) {
    faults asked = wrong;
    uint32_t width = 1024, height = 768;
    const fate f = begun("open");
    *projector = NULL;
    if (f == FAILS || f == IS_GONE) return no(f, "open", message);
    if (*place != '\0' && strcmp(place, "loopback") != 0)
        return said(ILF_ABSENT, message, "There is no such projector; the only one is called \"loopback\".");
    if (the.open) return said(ILF_BUSY, message, "The loopback projector is open already.");
    asked.calls = wrong.calls;
    asked.refusable = wrong.refusable;
    if (!all_options(getenv("ILF_LOOPBACK_PROJECTOR"), &asked, &width, &height) ||
        !all_options(options, &asked, &width, &height))
        return said(ILF_REFUSED, message,
                    "The options are not understood; write for instance \"size=1024x768,drop=100\".");
    memset(&the, 0, sizeof the);
    wrong = asked;
    the.open = 1;
    the.width = width;
    the.height = height;
    if (f == FAILS_AFTERWARDS) { /* nobody will close it */
        the.open = 0;
        return no(f, "open", message);
    }
    *projector = &the;
    return ILF_OK;
}

static ilf_code close_it(ilf_projector* p, ilf_message* message) {
    const fate f = begun("close");
    white();
    p->open = 0;
    return f == GOES ? ILF_OK : no(f, "close", message);
}

static ilf_code describe(ilf_projector* p, ilf_description* d, ilf_message* message) {
    const fate f = begun("describe");
    if (f == FAILS || f == IS_GONE) return no(f, "describe", message);
    if (d->struct_size < sizeof *d) return said(ILF_NOT_NOW, message, "The host is older than version 1.");
    d->width_px = p->width;
    d->height_px = p->height;
    d->triggers = ILF_TRIGGER_OWN_CLOCK | ILF_TRIGGER_EACH_SLOT | ILF_TRIGGER_EACH_SWEEP;
    d->slots_most = MOST_SLOTS;
    d->depth_count = 2;
    d->depths[0].bits = 8;
    d->depths[0].slowest_hz = SLOWEST_HZ;
    d->depths[0].fastest_hz = FASTEST_8_BIT_HZ;
    d->depths[1].bits = 1;
    d->depths[1].slowest_hz = SLOWEST_HZ;
    d->depths[1].fastest_hz = FASTEST_1_BIT_HZ;
    d->makes_no_light = 1;
    snprintf(d->name, sizeof d->name, "Loopback projector");
    return done(f, "describe", message);
}

static ilf_code configure(ilf_projector* p, const ilf_configuration* how, ilf_message* message) {
    const fate f = begun("configure");
    if (f == FAILS || f == IS_GONE) return no(f, "configure", message);
    if (p->playing) return said(ILF_NOT_NOW, message, "It plays; stop it first.");
    if (how->slots < 1 || how->slots > MOST_SLOTS || (how->bits != 8 && how->bits != 1) ||
        !(how->slot_rate_hz >= SLOWEST_HZ) ||
        how->slot_rate_hz > (how->bits == 8 ? FASTEST_8_BIT_HZ : FASTEST_1_BIT_HZ) ||
        (how->trigger != ILF_TRIGGER_OWN_CLOCK && how->trigger != ILF_TRIGGER_EACH_SLOT &&
         how->trigger != ILF_TRIGGER_EACH_SWEEP))
        return said(ILF_REFUSED, message, "It cannot play so many slots, bits or slots a second.");
    white();
    p->how = *how;
    p->configured = 1;
    return done(f, "configure", message);
}

static ilf_code upload(ilf_projector* p, const ilf_frame* frame, ilf_message* message) {
    uint32_t y;
    const fate f = begun("upload");
    if (f == FAILS || f == IS_GONE) return no(f, "upload", message);
    if (!p->configured) return said(ILF_NOT_NOW, message, "It is not configured.");
    if (frame->slot >= p->how.slots) return said(ILF_REFUSED, message, "The sweep has no such slot.");
    if (frame->width_px != p->width || frame->height_px != p->height || frame->row_pitch_bytes < p->width)
        return said(ILF_REFUSED, message, "The picture has not its raster.");
    if (p->back.slot[frame->slot] == NULL) p->back.slot[frame->slot] = malloc((size_t)p->width * p->height);
    if (p->back.slot[frame->slot] == NULL) return said(ILF_FAILED, message, "Out of memory.");
    for (y = 0; y < p->height; ++y)
        memcpy(p->back.slot[frame->slot] + (size_t)y * p->width, frame->pixels + (size_t)y * frame->row_pitch_bytes,
               p->width);
    return done(f, "upload", message);
}

static ilf_code swap(ilf_projector* p, uint64_t program, ilf_message* message) {
    uint32_t i;
    const fate f = begun("swap");
    if (f == FAILS || f == IS_GONE) return no(f, "swap", message);
    if (!p->configured || program == 0) return said(ILF_NOT_NOW, message, "It is not configured, or has no name.");
    for (i = 0; i < p->how.slots; ++i)
        if (p->back.slot[i] == NULL) return said(ILF_REFUSED, message, "A slot has no picture.");
    if (p->playing) { /* until the next sweep begins */
        const uint64_t next = (frames_since_start() / p->how.slots + 1) * p->how.slots;
        const double due_ns = (double)next / (p->how.slot_rate_hz * (1.0 + 1e-6 * (double)wrong.ppm)) * 1e9;
        const uint64_t due = p->started_ns + (uint64_t)due_ns + 1, now = now_ns();
        if (due > now) wait_ns(due - now);
        counted();
    }
    if (!wrong.stuck) {
        emptied(&p->front);
        p->front = p->back;
        memset(&p->back, 0, sizeof p->back);
        p->program = program;
        p->front_whole = 1;
    }
    return done(f, "swap", message);
}

static ilf_code start(ilf_projector* p, ilf_message* message) {
    const fate f = begun("start");
    if (f == FAILS || f == IS_GONE) return no(f, "start", message);
    if (!p->front_whole) return said(ILF_NOT_NOW, message, "Nothing was swapped in that it could play.");
    if (!p->playing) {
        p->playing = 1;
        p->triggers_gone = 0;
        p->started_ns = now_ns();
        p->counted_frames = p->counted_sweeps = 0;
    }
    return done(f, "start", message);
}

static ilf_code stop(ilf_projector* p, ilf_message* message) {
    const fate f = begun("stop");
    (void)p;
    if (f == FAILS || f == IS_GONE) return no(f, "stop", message);
    counted();
    white();
    return done(f, "stop", message);
}

static ilf_code steady_white(ilf_projector* p, ilf_message* message) {
    const fate f = begun("steady_white");
    (void)p;
    if (f == FAILS || f == IS_GONE) return no(f, "steady_white", message);
    counted();
    white();
    return done(f, "steady_white", message);
}

static ilf_code status(ilf_projector* p, ilf_status* s, ilf_message* message) {
    const fate f = begun("status");
    if (f == FAILS || f == IS_GONE) return no(f, "status", message);
    if (s->struct_size < sizeof *s) return said(ILF_NOT_NOW, message, "The host is older than version 1.");
    counted();
    s->state = wrong.dark ? ILF_STATE_DARK : p->playing ? ILF_STATE_PLAYING : ILF_STATE_STEADY_WHITE;
    if (wrong.dark) s->errors |= ILF_ERROR_LIGHT_SOURCE;
    if (wrong.hot) s->errors |= ILF_ERROR_TOO_HOT;
    if (p->triggers_gone) s->errors |= ILF_ERROR_NO_TRIGGER;
    s->program = p->playing ? p->program : 0;
    s->frames_in = p->frames_in;
    s->frames_out = p->frames_out;
    s->underruns = p->underruns;
    s->triggers_lost = p->triggers_lost;
    if (p->playing) s->slot_rate_hz = p->how.slot_rate_hz * (1.0 + 1e-6 * (double)wrong.ppm);
    s->light_source_c = wrong.hot ? 91.0 : 41.0;
    return done(f, "status", message);
}

ILF_PLUGIN_EXPORT const ilf_projector_plugin_v1* ilf_projector_plugin(uint32_t host_version);
const ilf_projector_plugin_v1* ilf_projector_plugin(uint32_t host_version) {
    static const ilf_projector_plugin_v1 table = {sizeof table, 1,        "loopback",   "1",       "",     list,
                                                  open_it,      close_it, describe,     configure, upload, swap,
                                                  start,        stop,     steady_white, status};
    return host_version >= 1 ? &table : NULL;
}

/* ---- for tests ---- */

static void hook_reset(void) {
    white();
    memset(&the, 0, sizeof the);
    memset(&wrong, 0, sizeof wrong);
    judge = NULL;
    manual = 1;
    manual_ns = 0;
}

static int hook_faults(const char* options) {
    faults f;
    memset(&f, 0, sizeof f);
    if (!all_options(options, &f, NULL, NULL)) return 0;
    counted();
    wrong = f;
    return 1;
}

static void hook_judge(ilf_loopback_judge how, void* user) {
    judge = how;
    judge_user = user;
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
const ilf_loopback_hooks ilf_loopback = {hook_reset, now_ns,       wait_ns,     hook_faults, hook_judge,
                                         hook_light, hook_slotted, hook_opened, hook_slots,  hook_rate};
