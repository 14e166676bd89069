// The boundary between the output core and a projector whose SDK is not free: a plugin in C, loaded at run time.
#pragma once

// C99. Copy this one file next to your plugin; it needs nothing else of the project. README.md in this folder says step
// by step how to write a plugin, loopback/loopback_projector.c is a whole one.
//
// Where it is loaded from. The rig file names the plugin by its absolute path, and nothing is ever searched for: a
// plugin runs with all the rights of the program and with its hands on the room's light, so a file that somebody could
// put into a search path (a temporary folder, a download folder, LD_LIBRARY_PATH) must never become one. A file or
// folder that everybody may write is refused for the same reason. A plugin is never unloaded: its SDK's threads may
// outlive its last call.
//
// Threads. All calls come from one thread, one after the other, from `ilf_projector_plugin` on. The plugin may have
// threads of its own, which never call back: there is nothing to call. It leaves the process as it found it: no signal
// handlers, no locale, no working folder, nothing on standard output, no `exit`, no exception across a call.
//
// Time. Every call has a limit, written with it; one that takes longer is told to the operator and counts as failed
// (steady white and close excepted: they still did what they should). A call that does not return within five seconds
// more ends the player, as one that crashes does; its supervisor starts another, which begins in steady white.
//
// Safe light. The projector is the room's light: the safe state is STEADY WHITE, all pixels fully lit all the time,
// never black. It is what a projector shows after `open`, after `stop`, after `steady_white`, after `close`, and by
// itself whenever its triggers or its pictures stay away.
//
// Light. A slot's picture is lit evenly for the whole of its slot, and light is linear in its values: 255 is full, 0 is
// none. No gamma, no dither, no scaling, no overlay.
//
// Sizes. Every structure begins with `struct_size`, which the host sets to the size it knows. A plugin never reads or
// writes beyond that, and need not fill what it does not know: the host has set everything to 0 before.

#include <stdint.h>

// NOLINTBEGIN: this is C, which the rules for C++ would turn into C++.

#ifdef __cplusplus
extern "C" {
#endif

#define ILF_PROJECTOR_PLUGIN_VERSION 1u

#if defined(_WIN32)
#define ILF_PLUGIN_EXPORT __declspec(dllexport)
#else
#define ILF_PLUGIN_EXPORT __attribute__((visibility("default")))
#endif

/// What a call returns. After anything but ILF_OK the host takes nothing for granted and calls `steady_white`; if that
/// fails as well, `close`, and `open` again a second later.
typedef int32_t ilf_code;
enum {
    ILF_OK = 0,
    ILF_REFUSED = 1,    ///< it cannot be done as asked; nothing has changed
    ILF_ABSENT = 2,     ///< not there, unplugged, or without power
    ILF_BUSY = 3,       ///< another program has it
    ILF_DENIED = 4,     ///< this user may not open it
    ILF_TIMED_OUT = 5,  ///< it did not answer in time
    ILF_FAILED = 6,     ///< anything else the device or its SDK complains of
    ILF_NOT_NOW = 7     ///< the call does not belong here: the host's mistake
};

#define ILF_MESSAGE_BYTES 512u
/// One sentence for the operator in UTF-8, ended with a 0 byte: what, where, what would help. Written by a call that
/// does not return ILF_OK; may stay empty.
typedef struct ilf_message {
    char text[ILF_MESSAGE_BYTES];
} ilf_message;

/// An open projector; the plugin's own.
typedef struct ilf_projector ilf_projector;

typedef struct ilf_place {
    char id[64];     ///< for `open`; the same for the same projector tomorrow
    char name[128];  ///< for people
} ilf_place;

/// Who gives the time of the slots; bits, since a projector may know several.
enum {
    ILF_TRIGGER_OWN_CLOCK = 1,  ///< the projector: it gives a pulse at each start of a sweep, which the lens follows
    ILF_TRIGGER_EACH_SLOT = 2,  ///< a pulse from outside starts each slot
    ILF_TRIGGER_EACH_SWEEP = 4  ///< a pulse from outside starts each sweep, slots follow at `slot_rate_hz`
};

typedef struct ilf_depth {
    uint32_t bits;      ///< 1 to 8
    uint32_t reserved;  ///< 0
    double slowest_hz;  ///< slots a second of pictures of that many bits
    double fastest_hz;
} ilf_depth;

#define ILF_DEPTHS_MOST 8u
typedef struct ilf_description {
    uint32_t struct_size;
    uint32_t width_px, height_px;
    uint32_t triggers;    ///< ILF_TRIGGER_..., or'ed
    uint32_t slots_most;  ///< pictures its buffer holds: the longest sweep
    uint32_t depth_count;
    ilf_depth depths[ILF_DEPTHS_MOST];
    uint32_t makes_no_light;  ///< 1: a stand-in, and to be called so
    char name[128];           ///< maker and model
    char serial[64];          ///< may be empty
} ilf_description;

typedef struct ilf_configuration {
    uint32_t struct_size;
    uint32_t trigger;  ///< one ILF_TRIGGER_...
    uint32_t slots;    ///< of one sweep
    uint32_t bits;     ///< of one slot's picture
    double slot_rate_hz;
    /// With triggers from outside: once none has come for this long, the projector goes to steady white by itself and
    /// says ILF_ERROR_NO_TRIGGER.
    uint64_t trigger_timeout_ns;
} ilf_configuration;

/// Greys of `ilf_configuration.bits` bits: the value's upper bits; the lower ones are 0.
typedef struct ilf_frame {
    uint32_t struct_size;
    uint32_t slot;  ///< in the order of light, from 0
    uint32_t width_px, height_px;
    uint32_t row_pitch_bytes;  ///< from one row to the next; may be more than the width
    uint32_t reserved;         ///< 0
    const uint8_t* pixels;     ///< top left first; not to be kept after the call
} ilf_frame;

enum {
    ILF_STATE_UNKNOWN = 0,
    ILF_STATE_STEADY_WHITE = 1,
    ILF_STATE_PLAYING = 2,
    ILF_STATE_DARK = 3  ///< neither: parked, cooling, starting, or its light source failed
};

/// What is wrong, now or since the last `status`; or'ed. The numbers are the DynaFlash's where it has them.
enum {
    ILF_ERROR_LIGHT_SOURCE = 0x1,
    ILF_ERROR_TOO_HOT = 0x2,
    ILF_ERROR_DMA_TIMEOUT = 0x400,
    ILF_ERROR_NO_TRIGGER = 0x800,
    ILF_ERROR_RATE_OVERFLOW = 0x8000  ///< slots come faster than it can show them
};

/// Counters begin at 0 with `open` and never go back. A frame is one slot's light in one sweep: a program of 16 slots
/// counts 960 a second at 60 Hz, whether the projector repeats its pictures or the plugin sends them anew.
typedef struct ilf_status {
    uint32_t struct_size;
    uint32_t state;           ///< ILF_STATE_...
    uint32_t errors;          ///< ILF_ERROR_...
    uint32_t vendor_error;    ///< as the SDK numbers it; 0: none
    uint64_t program;         ///< whose light it is, as `swap` named it; 0 unless playing
    uint64_t frames_in;       ///< given to the projector (sent)
    uint64_t frames_out;      ///< that became light (shown)
    uint64_t frames_waiting;  ///< given, and still to come. Dropped are frames_in - frames_out - frames_waiting.
    uint64_t underruns;       ///< times it had no picture for a slot
    uint64_t triggers_lost;   ///< pulses that should have come, or been given, and were not
    double slot_rate_hz;      ///< measured; 0: nobody measures it
    double light_source_c;    ///< temperatures; 0: not known
    double electronics_c;
} ilf_status;

/// What a plugin is: a table that lives as long as the process. None of the calls may be null, no pointer given to them
/// is.
typedef struct ilf_projector_plugin_v1 {
    uint32_t struct_size;
    uint32_t version;            ///< 1
    const char* name;            ///< "DynaFlash through its SDK 2.0"
    const char* plugin_version;  ///< its own
    const char* tried_on;        ///< hardware it was tried on, in words; empty: none. Shown to the operator as it is.

    /// Writes up to `capacity` projectors and how many there are. Opens none. Within 10 s.
    ilf_code (*list)(ilf_place* places, uint32_t capacity, uint32_t* count, ilf_message* message);

    /// Opens the projector at `place` (empty: the only one there is; ILF_REFUSED if there are several) and shows steady
    /// white, whatever an earlier program left on. `options` is the rig file's text for this plugin, which may be empty
    /// and is the plugin's own business. `*projector` is null unless ILF_OK. Within 40 s: some boot for 30.
    ilf_code (*open)(const char* place, const char* options, ilf_projector** projector, ilf_message* message);

    /// Leaves steady white on and lets go, whatever state it is in; `projector` is never used again, even if this
    /// fails. Within 2 s.
    ilf_code (*close)(ilf_projector* projector, ilf_message* message);

    /// What the projector can do; the same as long as it is open. Within 1 s.
    ilf_code (*describe)(ilf_projector* projector, ilf_description* description, ilf_message* message);

    /// How slots are timed from the next `start` on. Only in steady white; forgets all pictures. Within 2 s.
    ilf_code (*configure)(ilf_projector* projector, const ilf_configuration* configuration, ilf_message* message);

    /// Puts a slot's picture into the back buffer, beside what plays, which goes on undisturbed. A slot may be given
    /// again; the last one counts. Within 0.25 s.
    ilf_code (*upload)(ilf_projector* projector, const ilf_frame* frame, ilf_message* message);

    /// Makes the back buffer what plays, at the next start of a sweep and in all slots at once: no sweep ever shows
    /// pictures of two programs. Returns once that sweep has begun; while nothing plays, at once. The new back buffer
    /// is empty. ILF_REFUSED if a slot has no picture. `program` is the host's name for it, never 0. Within 0.25 s
    /// and three sweeps.
    ilf_code (*swap)(ilf_projector* projector, uint64_t program, ilf_message* message);

    /// Plays what was swapped in, from slot 0 on, sweep after sweep without gaps. Within 2 s.
    ilf_code (*start)(ilf_projector* projector, ilf_message* message);

    /// Ends playing after a whole sweep: steady white. Configuration and pictures may be kept or forgotten. Within 2 s.
    ilf_code (*stop)(ilf_projector* projector, ilf_message* message);

    /// THE SAFE STATE, from any state, after any error, any number of times: all pixels fully lit, all the time. No
    /// slot, no black, no fade, no wait for a sweep's end or for a trigger. Returns once it is on; from then on nothing
    /// but `start` ends it. Forgets all pictures. Within 0.5 s.
    ilf_code (*steady_white)(ilf_projector* projector, ilf_message* message);

    /// How it is. Called every 100 ms and after every `swap`, so it must neither wait for a sweep nor disturb one.
    /// Within 0.25 s.
    ilf_code (*status)(ilf_projector* projector, ilf_status* status, ilf_message* message);
} ilf_projector_plugin_v1;

/// The one name a plugin exports. Null if it knows no version up to `host_version`.
///
///     ILF_PLUGIN_EXPORT const ilf_projector_plugin_v1* ilf_projector_plugin(uint32_t host_version);
typedef const ilf_projector_plugin_v1* (*ilf_projector_plugin_entry)(uint32_t host_version);
#define ILF_PROJECTOR_PLUGIN_ENTRY "ilf_projector_plugin"

#ifdef __cplusplus
}
#endif

// NOLINTEND
