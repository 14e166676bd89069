#!/usr/bin/env bash
# kill -9 of the studio at random moments while a program plays: the light does not change, and the restarted studio
# finds it playing. ILF_KILLS times (10, or 100 in the full test).
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

kills=${ILF_KILLS:-10}
start_display 1280 720
start_studio "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd" --size 1280x720
wait_for .devices.light slotted || fail "the sample does not play at the start"
shown=$(shown_hash)
swaps=$(status .devices.swaps)
RANDOM=20260101  # the same moments every time
for n in $(seq "$kills"); do
    sleep "0.$(( RANDOM % 10 ))"
    kill -9 "$STUDIO_PID"; wait "$STUDIO_PID" 2>/dev/null; STUDIO_PID=""
    [ "$(status .devices.light)" = slotted ] || fail "kill $n changed the light: $(status .)"
    [ "$(shown_hash)" = "$shown" ] || fail "kill $n changed the program"
    start_studio "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd" --size 1280x720
done
sleep 2
[ "$(status .devices.light)" = slotted ] || fail "the restarted studio changed the light"
[ "$(shown_hash)" = "$shown" ] || fail "the restarted studio changed the program"
[ "$(status .devices.swaps)" = "$swaps" ] || fail "a restarted studio sent a program unasked"
grep -q "plays already" "$STUDIO_LOG" || fail "the restarted studio does not say what plays: $(cat "$STUDIO_LOG")"
echo "$kills kills of the studio changed nothing"
