#!/usr/bin/env bash
# Measures registration, distances, models and tracking, each beside a plain way of doing it in the same run: writes
# scene.csv, scene.png and a Markdown table.
# Usage: scene.sh DIRECTORY_OF_PROGRAMS TABLE.md   (ILF_BENCH_ARGS are passed to every benchmark)
set -euo pipefail
bin=$1 table=$2
out=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# What is measured | program | case (its time, or CASE@COUNTER) | figure to reach, ms | beside it | its case | error's counter | its unit; no commas.
rows=$(cat <<'ROWS'
42 pictures of 1280 x 1024 decoded|scan|decodeOurs|120|OpenCV at white > black + 5|decodeOpenCv/5/5|rms_px|px rms
42 pictures beside its users' setting|scan|decodeOurs|120|OpenCV at white > black + 40|decodeOpenCv/40/5|rms_px|px rms
42 pictures: share decoded|scan|decodeOurs|120|OpenCV at white > black + 40|decodeOpenCv/40/5|decoded_pct|% of the board
mask onto a 1024 x 768 slot|warp|warpSlot|2|OpenCV: remap|warpRemap|error|of coverage rms
mask of a dab|warp|warpDab|0.2|the whole slot|warpSlot||as the slot
depth from a scan of 1280 x 1024|triangulate|depthFromScan/whole:0||OpenCV: triangulatePoints|depthByOpenCv|error_percent|% of depth rms
ToyCar: file to depth|solid|toycar/load-and-depth/1280x1024|300|loaded with its pictures|toycar/load/textures||as drawn below
ToyCar: drawn to depth|solid|toycar/depth/tiles||a loop over boxes|toycar/depth/plain-loop|error|um at the worst ray
marker in its window|track|markerInWindow|8|OpenCV in the whole frame|openCvInWholeFrame|worst_corner_mean_px|px worst corner
lost marker: the longest part|track|markerLostPart@worst_ms|8|OpenCV in the whole frame|openCvInWholeFrame|worst_corner_mean_px|px worst corner
lost flat target: the longest look|track|planarLostLook@worst_ms|8|all looks at once|planarFoundAnywhere|worst_corner_mean_px|px worst corner
flat target followed|track|planarFollowed|8|found anywhere|planarFoundAnywhere|worst_corner_mean_px|px worst corner
surface by a click on 640 x 480|scene|selectByDepth||flood by 2 % of depth|selectFlood|error|% of pixels
bump check of 1280 x 720|scene|bumpCheck||optical flow|bumpFlow|error|px farthest corner
a frame of the emulated camera|scene|emulatedFrame||its rays cast anew|emulatedRays||the same light
ROWS
)

# The least of three: others use this machine, too.
for bench in $(cut -d'|' -f2 <<<"$rows" | sort -u); do
    echo "== bench_$bench"
    # shellcheck disable=SC2086
    "$bin/bench_$bench" --benchmark_repetitions=3 --benchmark_min_time=0.3 ${ILF_BENCH_ARGS:-} \
        --benchmark_out="$work/$bench.json" --benchmark_out_format=json >/dev/null
done

# value PROGRAM CASE COUNTER: of the repetition that took least; `ms` is its time.
value() {
    jq -r --arg case "$2" --arg counter "$3" '
        [.benchmarks[] | select(.run_type == "iteration" and (.error_occurred | not)) |
         select((.name | gsub("/(manual_time|real_time|process_time|min_time:[0-9.]+|iterations:[0-9]+)"; "")) == $case) |
         .ms = .real_time * (if .time_unit == "ns" then 1e-6 elif .time_unit == "us" then 1e-3 else 1 end)] |
        if length == 0 then "" else (min_by(.ms)[$counter] // "") end' "$work/$1.json"
}
{
    echo "what,ms,figure_ms,beside,beside_ms,ratio,error,beside_error,unit"
    while IFS='|' read -r what program name figure beside other counter unit; do
        field=ms
        case $name in *@*) field=${name#*@} name=${name%@*} ;; esac
        ms=$(value "$program" "$name" "$field") least=$(value "$program" "$other" ms)
        error='' theirs=''
        [ -z "$counter" ] || error=$(value "$program" "$name" "$counter") theirs=$(value "$program" "$other" "$counter")
        awk -v OFS=, -v what="$what" -v ms="$ms" -v figure="$figure" -v beside="$beside" -v other="$least" -v error="$error" \
            -v theirs="$theirs" -v unit="$unit" 'function short(v) { return v == "" ? "" : sprintf("%.4g", v) }
            BEGIN {
                ratio = ""
                if (ms != "" && other != "") ratio = sprintf("%.3g", other / ms)
                print what, short(ms), figure, beside, short(other), ratio, short(error), short(theirs), unit
            }'
    done <<<"$rows"
} > "$out/scene.csv"

tail -n +2 "$out/scene.csv" | awk -F, '{ printf "\"%s\" %s %s %s\n", $1, $2 == "" ? "NaN" : $2, $5 == "" ? "NaN" : $5, $3 == "" ? "NaN" : $3 }' \
    > "$work/plot.dat"
gnuplot <<END
set terminal pngcairo size 1000,560 font "Inter,10" background "#ffffff"
set output "$out/scene.png"
set logscale x
set xlabel "time, ms"
set grid x
set offsets 0,0,0.7,0.7
set key outside top center horizontal
set lmargin 40
set yrange [] reverse
plot "$work/plot.dat" using 4:0:yticlabels(1) with points pt 2 ps 1.4 lw 2 lc rgb "#c0392b" title "figure to reach", \
     "" using 3:0 with points pt 5 ps 1.0 lc rgb "#999999" title "beside it", \
     "" using 2:0 with points pt 7 ps 1.2 lc rgb "#1f6fc4" title "ours"
END

{
    echo "| what | time | figure | beside it | time | ratio | error | beside it |"
    echo "| --- | ---: | ---: | --- | ---: | ---: | --- | --- |"
    tail -n +2 "$out/scene.csv" | awk -F, '
        function t(ms) { return ms == "" ? "" : ms >= 100 ? sprintf("%.0f ms", ms) : ms >= 1 ? sprintf("%.1f ms", ms) : sprintf("%.0f us", 1000 * ms) }
        function e(v, unit) { return v == "" ? "" : sprintf("%.3g %s", v, unit) }
        { printf "| %s | %s | %s | %s | %s | %sx | %s | %s |\n", $1, t($2), $3 == "" ? "" : "<= " t($3), $4, t($5), $6,
                 $7 == "" ? $9 : e($7, $9), e($8, $9) }'
} > "$table"
