#!/usr/bin/env bash
# F12 gives steady light whatever plays; a take brings the program back; killing the studio changes nothing.
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

start_display 1280 720
start_studio "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd" --size 1280x720
wait_for .devices.light slotted || fail "the sample does not play at the start"
before=$(shown_hash)
xdotool mousemove --window "$WINDOW" 500 300; sleep 0.3
keys F12
wait_for .devices.light steady || fail "F12 did not give safe light"
keys ctrl+Return
wait_for .devices.light slotted || fail "TAKE did not end safe light"
[ "$(shown_hash)" = "$before" ] || fail "another program plays than before"

kill -9 "$STUDIO_PID"; wait "$STUDIO_PID" 2>/dev/null; STUDIO_PID=""
sleep 1
[ "$(status .devices.light)" = slotted ] || fail "killing the studio changed the light: $(status .)"
[ "$(shown_hash)" = "$before" ] || fail "killing the studio changed the program"
echo "safe light, take, and a killed studio behave as promised"
