#!/usr/bin/env bash
# A stroke in the real window's perceived view is seen coarsely while it is drawn, then at rest, then refined; the frame
# times that the window writes at its end tell.
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

start_display 1280 720
times="$WORK/times.json"
start_studio "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd" --size 1280x720 --view perceived --frame-times "$times"
wait_for .devices.light slotted || fail "the sample does not play at the start"
sleep 2
xdotool mousemove --window "$WINDOW" 500 300; sleep 0.3
keys b
for _ in 1 2 3; do
    stroke 420 260 520 330
    sleep 2
done
sleep 4
keys ctrl+q
for _ in $(seq 100); do kill -0 "$STUDIO_PID" 2>/dev/null || break; sleep 0.1; done
[ -s "$times" ] || fail "the window wrote no frame times"
for rung in "views while dragging" "views at rest" "views refined"; do
    [ "$(jq --arg rung "$rung" '.counts[$rung]' "$times")" -gt 0 ] || fail "no $rung: $(jq -c .counts "$times")"
done
[ "$(jq .gestures.frames "$times")" -gt 0 ] || fail "no frame of a stroke was timed"
echo "$(jq -c .counts "$times")"
