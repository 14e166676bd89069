#!/usr/bin/env bash
# The wizard in the real window against the emulated scene: from a bare rig to a registered project by clicks, a camera
# that is bumped and followed by one click, then every fault of the README's table (section "Set up a real scene"), each
# by its own words: it has to be named, and nothing may be written.
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

clicks=0
click() { # X Y
    xdotool mousemove --window "$WINDOW" "$1" "$2"; sleep 0.2
    xdotool mousedown 1; sleep 0.1; xdotool mouseup 1; sleep 0.2
    clicks=$((clicks + 1))
}
# held KEY...: for a while, as a slow frame sees no key that goes down and up within it.
held() { xdotool keydown "$@"; sleep 0.3; xdotool keyup "$@"; sleep 0.2; }
# typed X Y WORDS: in place of what the field there says.
typed() {
    click "$1" "$2"; sleep 0.3
    xdotool keydown ctrl; sleep 0.1; held a; xdotool keyup ctrl; sleep 0.2
    xdotool type --delay 25 "$3"; sleep 0.2
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
scene() { typed 233 142 "$1"; held Return; sleep 0.3; }
scan() { click 52 299; }
since() { echo "$(date +%s.%N) - $1" | bc; }
rig() { jq -S . "$WORK/desk.ilfd/rig.json"; }

start_display 1280 720
start_studio --rig simulated --size 1280x720
wait_for .devices.light steady || fail "there is no steady light at the start"
xdotool mousemove --window "$WINDOW" 600 400; sleep 0.5

begun=$(date +%s.%N)
all=$begun
keys F4
scene binning=2
scan
wait_log "registering by scan: found" || fail "the scan found nothing"
click 52 486 # Accept
wait_log "a registration went into the rig" 30 || fail "what was found was not accepted"
click 52 290 # Close
keys ctrl+s
sleep 0.5
typed 500 560 "$WORK/desk.ilfd"
click 838 560 # Save
for _ in $(seq 50); do [ -s "$WORK/desk.ilfd/rig.json" ] && break; sleep 0.2; done
echo "from a bare rig to a registered project: $clicks clicks, $(since "$begun") s"
[ "$(jq -r .registration.method "$WORK/desk.ilfd/rig.json")" = scan ] || fail "the project's rig has no registration"
[ "$(jq -r .registration.provenance "$WORK/desk.ilfd/rig.json")" = emulated ] || fail "it does not say that it is emulated"
wait_for .devices.light steady || fail "the light is not steady after the scan"
rig >"$WORK/registered.json"

# The camera stays open, so that a bump is noticed; one click moves picture and map along.
sleep 1
printf 'binning=2,turn=0.25\n' >"$ILF_RUNTIME_DIR/emulated-camera"
begun=$(date +%s.%N)
wait_log "the camera was moved" 40 || fail "nobody noticed that the camera was moved"
echo "bump to alarm: $(since "$begun") s, the emulated camera's new rays among them"
click 355 168 # Move along
keys ctrl+s
changed() { ! rig | cmp -s "$WORK/registered.json" -; }
for _ in $(seq 50); do changed && break; sleep 0.2; done
changed || fail "the registration did not follow the camera"
rig >"$WORK/registered.json"
rm -f "$ILF_RUNTIME_DIR/emulated-camera"

# What goes wrong is named, with what helps.
keys F4
diagnosed() { # WORDS SENTENCE
    scene "binning=4,$1"
    scan
    wait_log "registering by scan: " || return 1
    said=$(tail -n "+$logged" "$STUDIO_LOG" | head -1 | sed 's/.*registering by scan: //')
    grep -q -- "$2" <<<"$said"
}
while read -r words sentence; do
    begun=$(date +%s.%N)
    if ! diagnosed "$words" "$sentence"; then
        # A machine that is very busy may have lost a key: then these were other words, and no diagnosis of them.
        grep -q "The emulated scene does not know" <<<"$said" && diagnosed "$words" "$sentence" ||
            fail "$words was not diagnosed: \"$sentence\" was not said but \"$said\""
    fi
    echo "$words ($(since "$begun") s): $said"
done <<'FAULTS'
dark It is too dark: what is shown can hardly be seen, even in white. Open the lens's aperture
saturated the end of the camera's range: shorten the exposure or close the aperture
ambient=900 of the light is the projector's: dim the room
wrong-screen What the camera sees does not follow what is shown: the light in its view is another screen's
frozen is frozen: it gives the same picture again and again, whatever is shown
delay=20 The camera gives previous frames: what is shown reaches its pictures only
turn=0.3,after=70 Something moved while it was scanned: .* Keep camera, projector and things still
FAULTS
wait_for .devices.light steady || fail "the light is not steady after a fault"
keys ctrl+s
sleep 1
changed && fail "a scan that was refused changed the rig"
echo "all of it: $(since "$all") s"
exit 0
