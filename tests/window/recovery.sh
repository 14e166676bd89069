#!/usr/bin/env bash
# kill -9 of the studio with unsaved work: the next start offers it, and Recover brings the stroke back to the devices.
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

cp -r "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd" "$WORK/"
start_display 1280 720
start_studio "$WORK/museum-guide.ilfd" --size 1280x720
wait_for .devices.light slotted || fail "the sample does not play at the start"
before=$(shown_hash)
xdotool mousemove --window "$WINDOW" 500 300; sleep 0.3
keys b
stroke 420 260 520 330
keys ctrl+Return
for _ in $(seq 50); do [ "$(shown_hash)" != "$before" ] && break; sleep 0.2; done
painted=$(shown_hash)
[ "$painted" != "$before" ] || fail "the stroke did not reach the devices"
keys ctrl+Return
for _ in $(seq 100); do
    find "$WORK/state/autosave" -name project.json 2>/dev/null | grep -q . && break
    sleep 0.1
done
find "$WORK/state/autosave" -name project.json | grep -q . || fail "nothing was autosaved before the take"
kill -9 "$STUDIO_PID"; wait "$STUDIO_PID" 2>/dev/null; STUDIO_PID=""

"$ILF_BIN/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --stop >/dev/null 2>&1
start_studio "$WORK/museum-guide.ilfd" --size 1280x720
sleep 2
keys Return # nothing may happen by itself while the question stands
[ "$(status .devices.light)" = steady ] || fail "something was put on show before the question was answered"
# The Recover button: the first of the sheet in the middle of the window.
xdotool mousemove --window "$WINDOW" 455 375; sleep 0.3
[ -n "${ILF_SHOW:-}" ] && import -window root "$ILF_SHOW"
xdotool click 1; sleep 1
keys ctrl+Return
for _ in $(seq 50); do [ "$(shown_hash)" = "$painted" ] && break; sleep 0.2; done
[ "$(shown_hash)" = "$painted" ] || fail "the recovered project is not the painted one: $(shown_hash), not $painted"
echo "a killed studio's stroke was recovered and played again"
