// The loopback projector's insides, shared by its three files: its state, its clock and what is to go wrong.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "devices/plugin/illuminatedfocus_projector.h"
#include "devices/plugin/loopback/loopback_projector.h"

// NOLINTBEGIN: this is C, which the rules for C++ would turn into C++.

enum { MOST_SLOTS = 256 };

typedef struct buffer {
    uint8_t* slot[MOST_SLOTS]; /* null: no picture */
} buffer;

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
/* There is one. */
extern ilf_projector the;

/* Steady white, without pictures. */
void white(void);
/* Brings the counters up to now. */
void counted(void);

/* ---- loopback_faults.c ---- */

typedef struct faults {
    char refused[24], slowed[24];
    long refuse_at, gone_at, slow_ms, drop_every, underrun_every, lose_every, ppm;
    int stuck, hot, dark;
    long calls, refusable; /* since they were set */
} faults;
extern faults wrong;

/* 0 if the options are not understood; those before are taken over all the same. A null width refuses sizes. */
int understood(const char* options, faults* f, uint32_t* width, uint32_t* height);

/* CLOCK_MONOTONIC, or a test's. */
uint64_t now_ns(void);
void wait_ns(uint64_t ns);
void use_clock(int manual);

/* What becomes of a call; asked at its beginning, with its name. */
typedef enum fate { GOES, FAILS, FAILS_AFTERWARDS, IS_GONE } fate;
fate begun(const char* call);
/* What a call returns that failed before it did anything, and one that did all it should. */
ilf_code no(fate f, const char* call, ilf_message* message);
ilf_code done(fate f, const char* call, ilf_message* message);
ilf_code said(ilf_code code, ilf_message* message, const char* text);
void judge_calls(ilf_loopback_judge judge, void* user);

// NOLINTEND
