/* What goes wrong with the loopback projector, when it was asked to, and the clock that all of it goes by. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "devices/plugin/loopback/loopback_machine.h"

enum { MOST_PIXELS_A_SIDE = 16384 };

faults wrong;

static int manual;
static uint64_t manual_ns;
static ilf_loopback_judge judge;
static void* judge_user;

uint64_t now_ns(void) {
    struct timespec t;
    if (manual) return manual_ns;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

void wait_ns(uint64_t ns) {
    struct timespec t;
    if (manual) {
        manual_ns += ns;
        return;
    }
    t.tv_sec = (time_t)(ns / 1000000000u);
    t.tv_nsec = (long)(ns % 1000000000u);
    nanosleep(&t, NULL);
}

void use_clock(int by_hand) {
    manual = by_hand;
    manual_ns = 0;
}

void judge_calls(ilf_loopback_judge how, void* user) {
    judge = how;
    judge_user = user;
}

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

int understood(const char* text, faults* f, uint32_t* width, uint32_t* height) {
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

ilf_code said(ilf_code code, ilf_message* message, const char* text) {
    snprintf(message->text, sizeof message->text, "%s", text);
    return code;
}

fate begun(const char* call) {
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

ilf_code no(fate f, const char* call, ilf_message* message) {
    if (f == IS_GONE) return said(ILF_ABSENT, message, "The loopback projector is unplugged.");
    snprintf(message->text, sizeof message->text, "It failed (%s).", call);
    return ILF_FAILED;
}

ilf_code done(fate f, const char* call, ilf_message* message) {
    return f == FAILS_AFTERWARDS ? no(f, call, message) : ILF_OK;
}
