# Sourced by the window tests: a display, a studio and an output core of their own, and the means to drive and read them.
# Everything is removed on exit. Needs Xvfb, xdotool and import (ImageMagick).
set -u
: "${ILF_BIN:?the folder of the built programs}"
: "${ILF_SOURCE_DIR:?the repository}"

for tool in Xvfb xdotool import jq; do
    if ! command -v "$tool" >/dev/null; then
        echo "FAILED: $tool is not installed; ./test.sh installs it (resources/debian-packages.txt, section [test])."
        exit 1
    fi
done

WORK=$(mktemp -d /tmp/ilf-window-XXXXXX)
export ILF_RUNTIME_DIR="$WORK/run" ILF_STATE_DIR="$WORK/state" ILF_CONFIG_DIR="$WORK/config"
export XDG_STATE_HOME="$WORK/state" XDG_CONFIG_HOME="$WORK/config" LIBGL_ALWAYS_SOFTWARE=1
STUDIO_PID=""
STUDIO_LOG="$WORK/state/illuminatedfocus/studio.log"

cleanup() {
    [ -n "$STUDIO_PID" ] && kill -9 "$STUDIO_PID" 2>/dev/null
    "$ILF_BIN/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --stop >/dev/null 2>&1
    [ -n "${XVFB_PID:-}" ] && kill "$XVFB_PID" 2>/dev/null
    rm -rf "$WORK"
}
trap cleanup EXIT

fail() {
    echo "FAILED: $*"
    if [ -n "${ILF_KEEP:-}" ]; then import -window root "$ILF_KEEP" 2>/dev/null; fi
    tail -20 "$STUDIO_LOG" "$WORK/studio.out" 2>/dev/null
    exit 1
}

# -noreset: without it the server forgets everything when its last client leaves.
start_display() { # WIDTH HEIGHT
    Xvfb -displayfd 3 -screen 0 "${1:-1280}x${2:-720}x24" -noreset -nolisten tcp 3>"$WORK/display" 2>/dev/null &
    XVFB_PID=$!
    for _ in $(seq 100); do [ -s "$WORK/display" ] && break; sleep 0.05; done
    [ -s "$WORK/display" ] || fail "Xvfb did not start"
    DISPLAY=":$(cat "$WORK/display")"
    export DISPLAY
}

start_studio() { # ARGUMENTS...
    "$ILF_BIN/illuminatedfocus" "$@" >"$WORK/studio.out" 2>&1 &
    STUDIO_PID=$!
    for _ in $(seq 200); do
        WINDOW=$(xdotool search --onlyvisible --name 'IlluminatedFocus' 2>/dev/null | head -1)
        [ -n "$WINDOW" ] && break
        kill -0 "$STUDIO_PID" 2>/dev/null || fail "the studio ended at once"
        sleep 0.1
    done
    [ -n "$WINDOW" ] || fail "no window appeared"
}

# status FILTER: a value of the JSON that core and devices give, such as .devices.light
status() { "$ILF_BIN/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --status 2>/dev/null | jq -r "$1" 2>/dev/null; }

# wait_for FILTER VALUE: until the status shows it, at most 20 s.
wait_for() {
    for _ in $(seq 100); do
        [ "$(status "$1")" = "$2" ] && return 0
        sleep 0.2
    done
    echo "last status: $(status .)"
    return 1
}

shown_hash() { status .devices.hash_shown; }

# Keys go to the window's focus; there is no window manager, so the pointer must be inside.
keys() { xdotool key --window "$WINDOW" --delay 60 "$@"; sleep 0.3; }

# stroke X0 Y0 X1 Y1: press, move in steps, release (window pixels).
stroke() {
    xdotool mousemove --window "$WINDOW" "$1" "$2"; sleep 0.15
    xdotool mousedown 1; sleep 0.1
    local i
    for i in 1 2 3 4 5 6 7 8; do
        xdotool mousemove --window "$WINDOW" $(( $1 + ($3 - $1) * i / 8 )) $(( $2 + ($4 - $2) * i / 8 )); sleep 0.03
    done
    xdotool mouseup 1; sleep 0.3
}
