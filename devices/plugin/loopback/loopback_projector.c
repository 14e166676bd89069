/* A projector that is not there, as a plugin: the example of how to write one, and what tests play on. It keeps the
 * pictures in memory, counts frames by the clock, and fails on demand (loopback_faults.c).
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
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "devices/plugin/loopback/loopback_machine.h"

static const double SLOWEST_HZ = 1.0, FASTEST_8_BIT_HZ = 1000.0, FASTEST_1_BIT_HZ = 8000.0;

ilf_projector the;

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

void white(void) {
    the.playing = 0;
    the.program = 0;
    the.front_whole = 0;
    emptied(&the.front);
    emptied(&the.back);
}

void counted(void) {
    uint64_t frames, sweeps, lost, late, dropped;
    if (!the.playing || frames_since_start() < the.counted_frames) return; /* its clock was slowed down */
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
    faults asked;
    uint32_t width = 1024, height = 768;
    const fate f = begun("open");
    *projector = NULL;
    if (f == FAILS || f == IS_GONE) return no(f, "open", message);
    if (*place != '\0' && strcmp(place, "loopback") != 0)
        return said(ILF_ABSENT, message, "There is no such projector; the only one is called \"loopback\".");
    if (the.open) return said(ILF_BUSY, message, "The loopback projector is open already.");
    asked = wrong;
    if (!understood(getenv("ILF_LOOPBACK_PROJECTOR"), &asked, &width, &height) ||
        !understood(options, &asked, &width, &height))
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
