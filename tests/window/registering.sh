#!/usr/bin/env bash
# The wizard in the real window against the emulated scene: from a bare rig to a registered project by clicks, then
# faults that each have to be named, then a camera that is bumped and registered along by one click.
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

clicks=0
click() { # X Y
    xdotool mousemove --window "$WINDOW" "$1" "$2"; sleep 0.2
    xdotool mousedown 1; sleep 0.1; xdotool mouseup 1; sleep 0.2
    clicks=$((clicks + 1))
}
# wait_log WORDS [SECONDS]: until the studio's log has them in a line after those seen before.
logged=0
wait_log() {
    local line
    for _ in $(seq $((5 * ${2:-60}))); do
        line=$(tail -n "+$((logged + 1))" "$STUDIO_LOG" 2>/dev/null | grep -n -m1 -- "$1" | cut -d: -f1)
        if [ -n "$line" ]; then
            logged=$((logged + line))
            return 0
        fi
        sleep 0.2
    done
    return 1
}
# What the emulated scene shall be, typed into the page's field.
scene() {
    click 285 129; sleep 0.4
    xdotool key --delay 60 ctrl+a; sleep 0.2
    xdotool type --delay 25 "$1"
    sleep 0.2
    # Held for a while: a slow frame sees no key that goes down and up within it.
    xdotool keydown Return; sleep 0.3; xdotool keyup Return; sleep 0.5
}
scan() { click 104 287; }

start_display 1280 720
start_studio --rig simulated --size 1280x720
wait_for .devices.light steady || fail "there is no steady light at the start"
xdotool mousemove --window "$WINDOW" 600 400; sleep 0.5

begun=$(date +%s.%N)
keys F4
scene binning=2
scan
wait_log "registering by scan: found" || fail "the scan found nothing"
click 104 474 # Accept
wait_log "a registration went into the rig" 20 || fail "what was found was not accepted"
click 104 236 # Close
keys ctrl+s
sleep 0.5
click 500 560 # the name
sleep 0.4
xdotool key --delay 60 ctrl+a; sleep 0.2
xdotool type --delay 25 "$WORK/desk.ilfd"
sleep 0.3
click 838 560 # Save
for _ in $(seq 50); do [ -s "$WORK/desk.ilfd/rig.json" ] && break; sleep 0.2; done
echo "from a bare rig to a registered project: $clicks clicks, $(echo "$(date +%s.%N) - $begun" | bc) s"
[ "$(jq -r .registration.method "$WORK/desk.ilfd/rig.json")" = scan ] || fail "the project's rig has no registration"
[ "$(jq -r .registration.provenance "$WORK/desk.ilfd/rig.json")" = emulated ] || fail "it does not say that it is emulated"
wait_for .devices.light steady || fail "the light is not steady after the scan"
cp "$WORK/desk.ilfd/rig.json" "$WORK/registered.json"

# The camera stays open, so that a bump is noticed; one click moves picture and map along.
sleep 1
printf 'binning=2,turn=0.25\n' >"$ILF_RUNTIME_DIR/emulated-camera"
bumped=$(date +%s.%N)
wait_log "the camera was moved" 40 || fail "nobody noticed that the camera was moved"
echo "bump to alarm: $(echo "$(date +%s.%N) - $bumped" | bc) s, the emulated camera's new rays among them"
click 355 168 # Move along
keys ctrl+s
moved() { ! cmp -s "$WORK/registered.json" "$WORK/desk.ilfd/rig.json"; }
for _ in $(seq 50); do moved && break; sleep 0.2; done
moved || fail "the registration did not follow the camera"
rm -f "$ILF_RUNTIME_DIR/emulated-camera"

# What goes wrong is named, with what helps.
keys F4
while read -r words sentence; do
    scene "binning=4,$words"
    scan
    wait_log "registering by scan: .*$sentence" || fail "$words was not diagnosed: \"$sentence\" was not said"
    echo "$words: $(tail -n "+$logged" "$STUDIO_LOG" | head -1 | sed 's/.*registering by scan: //')"
done <<'FAULTS'
dark too dark
wrong-screen does not follow what is shown
turn=0.4,after=70 Something moved while it was scanned
FAULTS
wait_for .devices.light steady || fail "the light is not steady after a fault"
