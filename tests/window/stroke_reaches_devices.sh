#!/usr/bin/env bash
# A stroke painted with the mouse in the real window reaches the simulated devices, and undo takes it back:
# compared by the content the devices show.
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

start_display 1280 720
start_studio "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd" --size 1280x720
wait_for .devices.light slotted || fail "the sample does not play at the start"
before=$(shown_hash)
[ -n "$before" ] || fail "the devices tell no content hash"

xdotool mousemove --window "$WINDOW" 500 300; sleep 0.3
keys b
stroke 420 260 520 330
keys ctrl+Return
sleep 1
painted=$(shown_hash)
[ "$painted" != "$before" ] || fail "the stroke did not reach the devices (content $painted)"

keys ctrl+z
keys ctrl+Return
for _ in $(seq 50); do
    [ "$(shown_hash)" = "$before" ] && break
    sleep 0.2
done
[ "$(shown_hash)" = "$before" ] || fail "undo did not take the stroke back: $(shown_hash) is not $before"
echo "a stroke changed what the devices show from $before to $painted, and undo brought $before back"
