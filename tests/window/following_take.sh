#!/usr/bin/env bash
# Poses by OSC move a region in the real window's light; an edit that waits for TAKE is not in it, and what is on show
# goes on following all the same. Compared by the content the devices show.
. "$ILF_SOURCE_DIR/tests/window/_display.sh"

PORT=$((20000 + RANDOM % 20000))
# pose HIGH HIGH: x and y as the first two bytes of big-endian floats, sent until the thing counts as standing there.
pose() {
    sleep 0.8 # what was seen before is forgotten
    local i
    for i in $(seq 15); do
        printf '/pose/1\0,ff\0'"$1"'\0\0'"$2"'\0\0' >"/dev/udp/127.0.0.1/$PORT"
        sleep 0.05
    done
}
# settled: the content shown once it stays the same for a second.
settled() {
    local last now same=0
    last=$(shown_hash)
    for _ in $(seq 60); do
        sleep 0.25
        now=$(shown_hash)
        if [ "$now" = "$last" ]; then same=$((same + 1)); else same=0; fi
        [ "$same" -ge 4 ] && break
        last=$now
    done
    echo "$now"
}

cp -r "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd" "$WORK/guide.ilfd"
jq '(.regions[] | select(.name == "Hands")).follow =
    {"target": "stream", "address": "/pose/1", "when_lost": "blur", "hold_s": 60, "fade_s": 0.5}' \
    "$ILF_SOURCE_DIR/projects/samples/museum-guide.ilfd/project.json" >"$WORK/guide.ilfd/project.json"

start_display 1280 720
start_studio "$WORK/guide.ilfd" --size 1280x720 --osc-port "$PORT"
wait_for .devices.light slotted || fail "the project does not play at the start"
painted=$(shown_hash)
xdotool mousemove --window "$WINDOW" 500 300; sleep 0.3

pose '\x3f\x00' '\x3f\x00' # 0.5, 0.5
here=$(settled)
[ "$here" != "$painted" ] || fail "the light did not follow the first pose ($here)"
pose '\x3f\x20' '\x3e\x80' # 0.625, 0.25
there=$(settled)
[ "$there" != "$here" ] || fail "the light did not follow the second pose ($there)"

keys b
stroke 420 260 520 330
[ "$(settled)" = "$there" ] || fail "the stroke reached the light without TAKE"
pose '\x3f\x00' '\x3f\x00'
[ "$(settled)" = "$here" ] || fail "what is on show does not follow while the edit waits: $(shown_hash), not $here"
keys ctrl+Return
for _ in $(seq 50); do
    [ "$(shown_hash)" != "$here" ] && break
    sleep 0.2
done
taken=$(settled)
[ "$taken" != "$here" ] || fail "TAKE did not put the stroke on show"
pose '\x3f\x20' '\x3e\x80'
again=$(settled)
[ "$again" != "$taken" ] && [ "$again" != "$there" ] || fail "after TAKE the light does not follow with the stroke"
echo "painted $painted, followed to $here and $there; with the edit waiting back to $here; taken $taken, followed to $again"
