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

# The device panel: nothing attached, emulated and playing, unplugged, in the wrong mode; side by side.
jq '.name = "Gallery 3" | .projector = {width_px: 912, height_px: 1140} | .projector_kind = "lightcrafter-4500" | .bits = 4
    | .slot_rate_Hz = 360 | .sweep_rate_Hz = 60 | .provenance = "typed" | .devices = {projector_at: "1-2", lenses_at: "1-3",
      display: {connector: "HDMI-2", maker: "TXN", model: "DLP4500", serial: ""}}' \
    projects/samples/museum-guide.ilfd/rig.json >"$work/gallery.json"
panel() { # NAME RIG LIGHT [MISHAP]
    "$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --stop >/dev/null 2>&1 || true
    ILF_STATE_DIR="$work/state-$1" "$bin/illuminatedfocus" projects/samples/museum-guide.ilfd --rig "$2" --size 1440x920 >/dev/null 2>&1 &
    local studio=$! asked=0
    until "$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --status 2>/dev/null |
        jq -e ".core.light == \"$3\" and (.core.devices | length > 0)" >/dev/null; do
        sleep 0.5
        asked=$((asked + 1))
        [ "$asked" -lt 80 ] || { echo "the rig $2 is not $3" >&2; exit 1; }
    done
    sleep 1
    xdotool mousemove 1320 298 click 1 # the page "Rig"
    if [ $# -gt 3 ]; then
        "$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --mishap "$4"
        sleep 4
    fi
    sleep 1
    import -window root -crop 316x400+1124+288 +repage "$work/panel-$1.png"
    kill "$studio"
    wait "$studio" 2>/dev/null || true
}
panel 1 "$work/gallery.json" steady
panel 2 emulated slotted
panel 3 emulated slotted projector:unplug
panel 4 emulated slotted projector:wrong-mode:0:1
convert "$work"/panel-[1234].png +append "$out/devices.png"
echo "$out/devices.png"

# The registering page after a scan of the emulated scene: no project, F4, Scan, and a light that is steady again.
"$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --stop >/dev/null 2>&1 || true
ILF_STATE_DIR="$work/state-register" "$bin/illuminatedfocus" --rig simulated --size 1600x1000 >/dev/null 2>&1 &
studio=$!
until_light() {
    until "$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --status 2>/dev/null |
        jq -e ".core.light == \"$1\"" >/dev/null; do sleep 0.3; done
}
until_light steady
sleep 3
xdotool mousemove 600 500 key F4
sleep 6
xdotool mousemove 104 287
sleep 0.5
xdotool mousedown 1 sleep 0.2 mouseup 1
until_light slotted
until_light steady
xdotool mousemove 800 940
sleep 8 # the camera is opened again meanwhile
import -window root -crop 1600x1000+0+0 +repage "$out/register.png"
kill "$studio"
wait "$studio" 2>/dev/null || true
echo "$out/register.png"
