#!/usr/bin/env bash
# kill -9 of the core's player while somebody paints: the light becomes steady and the lens rests within a second, the
# studio says so, and what was painted plays again after the next TAKE.
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

start_display 1280 720
start_studio "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd" --size 1280x720
wait_for .devices.light slotted || fail "the sample does not play at the start"
xdotool mousemove --window "$WINDOW" 500 300; sleep 0.3
keys b
stroke 420 260 520 330
keys ctrl+Return
sleep 1
painted=$(shown_hash)

player=$(status .core.pid)
[ -n "$player" ] || fail "the status names no player: $(status .)"
kill -9 "$player"
sleep 1
[ "$(status .devices.light)" = steady ] || fail "no steady light 1 s after the core died: $(status .)"
[ "$(status .devices.lens)" = rest ] || fail "the lens does not rest 1 s after the core died: $(status .)"
for _ in $(seq 50); do grep -q "safe light" "$STUDIO_LOG" && break; sleep 0.2; done
grep -qi "safe light" "$STUDIO_LOG" || fail "the studio does not say so: $(cat "$STUDIO_LOG")"
kill -0 "$STUDIO_PID" || fail "the studio died with the core"

keys ctrl+Return
for _ in $(seq 50); do [ "$(shown_hash)" = "$painted" ] && break; sleep 0.2; done
[ "$(shown_hash)" = "$painted" ] || fail "what was painted does not play again: $(status .)"
echo "the core's death gave safe light, and nothing painted was lost"
