#!/usr/bin/env bash
# Makes the README's screenshots anew from the real window under Xvfb: resources/make-screenshots.sh [BUILD_DIRECTORY]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=${1:-build/release}/bin
out=resources/screenshots
work=$(mktemp -d)
export ILF_RUNTIME_DIR="$work/run" ILF_STATE_DIR="$work/state" ILF_CONFIG_DIR="$work/config" LIBGL_ALWAYS_SOFTWARE=1

cleanup() {
    "$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --stop >/dev/null 2>&1 || true
    kill "$display" 2>/dev/null || true
    rm -rf "$work"
}
trap cleanup EXIT
Xvfb -displayfd 3 -screen 0 1920x1200x24 -noreset -nolisten tcp 3>"$work/display" 2>/dev/null &
display=$!
while [ ! -s "$work/display" ]; do sleep 0.05; done
DISPLAY=":$(cat "$work/display")"
export DISPLAY

shot() { # NAME SAMPLE VIEW
    "$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --stop >/dev/null 2>&1 || true
    "$bin/illuminatedfocus" "projects/samples/$2.ilfd" --size 1440x900 --view "$3" --screenshot "$out/$1.png" 2>/dev/null
    echo "$out/$1.png"
}
shot museum museum-guide scene
shot desk-perceived study-desk perceived
shot four-objects-compare four-objects compare
shot tools-light tutorial-recording light
