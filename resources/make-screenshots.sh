#!/usr/bin/env bash
# Makes the README's screenshots anew from the real window under Xvfb:
# resources/make-screenshots.sh [BUILD_DIRECTORY [samples|devices|registering]]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=${1:-build/release}/bin
part=${2:-all}
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
if [ "$part" = all ] || [ "$part" = samples ]; then
shot museum museum-guide scene
shot desk-perceived study-desk perceived
shot four-objects-compare four-objects compare
shot tools-light tutorial-recording light
fi

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
if [ "$part" = all ] || [ "$part" = devices ]; then
panel 1 "$work/gallery.json" steady
panel 2 emulated slotted
panel 3 emulated slotted projector:unplug
panel 4 emulated slotted projector:wrong-mode:0:1
convert "$work"/panel-[1234].png +append "$out/devices.png"
echo "$out/devices.png"
fi
[ "$part" = all ] || [ "$part" = registering ] || exit 0

# What the README's section "Set up a real scene" shows, by clicks on the emulated desk.
stop_core() { "$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --stop >/dev/null 2>&1 || true; }
log="$work/state-register/illuminatedfocus/studio.log"
click() { # X Y
    xdotool mousemove "$1" "$2"
    sleep 0.3
    xdotool mousedown 1 sleep 0.15 mouseup 1
    sleep 0.4
}
# held KEY...: for a while, as a slow frame sees no key that goes down and up within it.
held() { xdotool keydown "$@" sleep 0.3 keyup "$@" sleep 0.2; }
typed() { # X Y WORDS
    click "$1" "$2"
    xdotool keydown ctrl
    held a
    xdotool keyup ctrl
    xdotool type --delay 40 "$3"
    sleep 0.3
    held Return
}
lines=0
until_log() { # WORDS: in a line of the studio's log after those seen before
    until tail -n "+$((lines + 1))" "$log" 2>/dev/null | grep -q -- "$1"; do sleep 0.3; done
    lines=$(wc -l <"$log")
}
# A palette will do: 250 KB are asked of each picture.
picture() { # NAME
    xdotool mousemove "${2:-640}" "${3:-790}"
    sleep 1
    import -window root -crop 1280x800+0+0 +repage "$work/$1.png"
    convert "$work/$1.png" +dither -colors 255 "PNG8:$out/$1.png"
    echo "$out/$1.png"
}
stop_core
XDG_STATE_HOME="$work/state-register" ILF_STATE_DIR="$work/state-register" \
    "$bin/illuminatedfocus" --rig simulated --size 1280x800 >/dev/null 2>&1 &
studio=$!
until "$bin/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --status 2>/dev/null |
    jq -e '.core.light == "steady"' >/dev/null; do sleep 0.3; done
sleep 3
xdotool mousemove 600 500
held F4
sleep 2
scene() { typed 233 142 "$1"; }
scan() { click 52 299; }

scene binning=2
click 321 185 # Calibrate
click 60 354  # Scan pose 1: the words above the button go away with it
until_log "registering by calibration"
for pose in 2 3 4 5; do
    sleep 1
    click 60 304
    until_log "calibration: $pose poses"
done
picture calibrate
click 52 455 # Accept
until_log "a calibration went into the rig"
sleep 1
click 60 290 # To the scan
sleep 1
scan
until_log "registering by scan: found"
picture register
click 300 337 # Its +-
picture depth 620 300
scene binning=2,turn=0.3,after=70
scan
until_log "Something moved while it was scanned"
sleep 4 # until the camera's picture is live again
picture fault
kill "$studio"
wait "$studio" 2>/dev/null || true
