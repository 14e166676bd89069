#!/usr/bin/env bash
# What a frame of the window takes while a stroke is painted on a 1920x1080 picture in the perceived view, under Xvfb.
# Usage: tests/bench/frame_times.sh [BUILD_DIRECTORY] [RUNS]   (default: build/release, 3)
# "own" is the processor time of the window's thread: events, uploads, panels, draw lists, and the calls into GL. "swap" is
# named apart: with software GL the pixels are filled in it. Prints one line a run, then the JSON of the best one.
build=${1:-build/release}
runs=${2:-3}
export ILF_BIN=${ILF_BIN:-$(cd "$build" && pwd)/bin}
ILF_SOURCE_DIR=${ILF_SOURCE_DIR:-$(cd "$(dirname "$0")/../.." && pwd)}
. "$ILF_SOURCE_DIR/tests/window/_display.sh"
command -v convert >/dev/null || fail "convert (ImageMagick) is not installed"

# A page of its own making: a sharp face of a shelf, two blurred things before it, one behind, all on a textured ground.
project="$WORK/page.ilfd"
mkdir -p "$project/masks"
convert -size 1920x1080 -seed 7 plasma:tan-steelblue -fill 'rgb(250,246,235)' -draw 'rectangle 620,140 1300,940' \
    -fill 'rgb(60,40,30)' -pointsize 34 \
    $(for i in $(seq 0 17); do printf -- '-annotate +660+%d line-%02d,-as-fine-as-print-on-a-shelf ' $((200 + 42 * i)) "$i"; done) \
    -depth 8 "PNG24:$project/picture.png" || fail "no picture could be made"
mask() { convert -size 1920x1080 xc:black -fill white -draw "$2" -depth 8 "PNG:$project/masks/$1.png" || fail "no mask"; }
mask page 'rectangle 620,140 1300,940'
mask cup 'ellipse 430,760 190,240 0,360'
mask lamp 'ellipse 1500,420 230,300 0,360'
region() { # ID LOOK DISTANCE
    printf '{"id":"%s","name":"%s","look":"%s","distance":{"kind":"constant","value_m":%s,"tolerance_m":0.0},"mask":"masks/%s.png","visible":true,"locked":false,"solo":false}' \
        "$1" "$1" "$2" "$3" "$1"
}
cat > "$project/project.json" <<JSON
{"format":"illuminatedfocus-project","version":1,"name":"Page",
 "scene":{"picture":"picture.png","source":"made for the measurement","focal_px":1660.0,"focal_source":"typed"},
 "regions":[$(region cup blur 0.5),$(region page focus 0.8),$(region lamp blur 1.2)],
 "background":{"name":"Wall","look":"neutral","distance":{"kind":"constant","value_m":2.0,"tolerance_m":0.0},"visible":true,"locked":false,"solo":false},
 "seam":{"blending":"closed-form","feather_m":0.01},"alpha_D":0.2,"wearer":"wearer.json","rig":"rig.json"}
JSON
cp "$ILF_SOURCE_DIR"/projects/samples/museum-guide.ilfd/{wearer,rig}.json "$project/"

start_display 1920 1080
best=""
for run in $(seq "$runs"); do
    times="$WORK/times-$run.json"
    rm -rf "$ILF_STATE_DIR"  # or the studio would first ask about the stroke of the run before
    start_studio "$project" --size 1920x1080 --view perceived --reset-layout --frame-times "$times"
    sleep 4
    xdotool mousemove --window "$WINDOW" 420 420; sleep 0.5
    keys b
    # Round and round over the cup's rim, six seconds at about 80 positions a second.
    xdotool mousedown 1
    for i in $(seq 480); do
        read -r x y < <(awk -v i="$i" 'BEGIN { t = i / 40 * 3.14159265; r = 60 + i / 6; printf "%d %d\n", 520 + r * 2 * cos(t), 440 + r * sin(t) }')
        printf 'mousemove --window %s %d %d\nsleep 0.0125\n' "$WINDOW" "$x" "$y"
    done | xdotool -
    xdotool mouseup 1
    sleep 3
    keys ctrl+q
    for _ in $(seq 100); do kill -0 "$STUDIO_PID" 2>/dev/null || break; sleep 0.1; done
    [ -s "$times" ] || fail "the studio wrote no frame times"
    [ "$(jq .gestures.frames "$times")" -gt 20 ] || fail "the stroke gave only $(jq .gestures.frames "$times") frames"
    jq -r --arg run "$run" '"run \($run): \(.gestures.frames) frames while painting; own p50 \(.gestures.own_cpu_ms.p50 * 100 | round / 100) ms, p95 \(.gestures.own_cpu_ms.p95 * 100 | round / 100) ms; swap p50 \(.gestures.swap_wall_ms.p50 * 100 | round / 100) ms; views while dragging \(.counts["views while dragging"]), at rest \(.counts["views at rest"]), refined \(.counts["views refined"]), tiles sent \(.counts["view tiles sent"])"' "$times"
    if [ -z "$best" ] || [ "$(jq -n --slurpfile a "$times" --slurpfile b "$best" '$a[0].gestures.own_cpu_ms.p95 < $b[0].gestures.own_cpu_ms.p95')" = true ]; then best=$times; fi
    "$ILF_BIN/illuminatedfocus-core" --runtime-dir "$ILF_RUNTIME_DIR" --stop >/dev/null 2>&1
    STUDIO_PID=""
done
jq .gestures "$best"
