#!/usr/bin/env bash
# Runs every benchmark, writes results.csv and results.png, perceived.csv and perceived.png, scene.csv and scene.png here,
# and puts their tables into README.md.
# Usage: tests/bench/run.sh [BUILD_DIRECTORY] [perceived|scene]   (default: build/release, all of them; else that one)
# ILF_BENCH_ARGS are passed to every benchmark but the perceived view's, ILF_PERCEIVED_ARGS to that one.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
only=${2:-}
out=tests/bench
scene="scan warp triangulate solid track scene"
case "$only" in
    "") targets=benches ;;
    perceived) targets=bench_perceived ;;
    scene) targets=$(printf 'bench_%s ' $scene) ;;
    *) sed -n '2,6p' "$0"; exit 2 ;;
esac

for tool in jq gnuplot; do
    command -v "$tool" >/dev/null || { echo "$tool is missing: ./test.sh --full installs it (section [bench])."; exit 1; }
done
# shellcheck disable=SC2086
cmake --build "$build" --target $targets

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# into_readme NAME TABLE: the text between the two markers of that name is replaced.
into_readme() {
    awk -v table="$2" -v name="$1" '
        index($0, "<!-- " name ":begin -->") { print; while ((getline line < table) > 0) print line; skipping = 1; next }
        index($0, "<!-- " name ":end -->") { skipping = 0 }
        !skipping { print }' README.md > "$work/README.md"
    cp "$work/README.md" README.md
}
measured_on() {
    echo "Measured $(date -u +%F) on $(nproc) cores, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)."
}

if [ "$only" != perceived ]; then
    "$out/scene.sh" "$build/bin" "$work/scene.md"
    { cat "$work/scene.md"; echo; measured_on; } > "$work/scene_table.md"
    into_readme scene "$work/scene_table.md"
    echo "wrote $out/scene.csv, $out/scene.png and the table in README.md"
    [ -z "$only" ] || exit 0
fi

echo "== bench_perceived"
# shellcheck disable=SC2086
"$build/bin/bench_perceived" --csv "$out/perceived.csv" --markdown "$work/perceived.md" ${ILF_PERCEIVED_ARGS:-}
"$out/perceived_plot.sh" "$out/perceived.csv" "$out/perceived.png"
{ cat "$work/perceived.md"; echo; measured_on; } > "$work/perceived_table.md"
into_readme perceived "$work/perceived_table.md"
echo "wrote $out/perceived.csv, $out/perceived.png and the table in README.md"
[ -z "$only" ] || exit 0

for bench in "$build"/bin/bench_*; do
    case " perceived $scene " in *" $(basename "$bench" | cut -d_ -f2-) "*) continue ;; esac # they have tables of their own
    echo "== $(basename "$bench")"
    # shellcheck disable=SC2086
    "$bench" ${ILF_BENCH_ARGS:-} --benchmark_out="$work/$(basename "$bench").json" --benchmark_out_format=json >/dev/null
done

# One row a benchmark. Counters every benchmark may give: p50_us, p95_us, whole_us (the cost of the whole frame), ratio
# (whole over p50), error, error_unit as a label. A row without percentiles shows Google Benchmark's mean.
{
    echo "bench,case,p50_us,p95_us,whole_us,skipped_times,error,what"
    for file in "$work"/*.json; do
        name=$(basename "$file" .json)
        jq -r --arg bench "${name#bench_}" '
            .benchmarks[] | select(.run_type == "iteration" and (.error_occurred | not)) |
            (if .time_unit == "ns" then 1e-3 elif .time_unit == "ms" then 1e3 elif .time_unit == "s" then 1e6 else 1 end) as $us |
            [$bench, (.name | sub("/(manual_time|real_time|iterations:[0-9]+)"; ""; "g")),
             (.p50_us // (.real_time * $us)), (.p95_us // ""), (.whole_us // ""),
             (if .whole_us and .p50_us and .p50_us > 0 then .whole_us / .p50_us else (.ratio // "") end),
             (.error // ""), (.label // "")] | @csv' "$file"
    done
} > "$out/results.csv"

# label, p50, p95 (p50 where there is none), whole frame (NaN where there is none)
tail -n +2 "$out/results.csv" | sed 's/"//g' |
    awk -F, '{ gsub("_", " ", $2); printf "\"%s: %s\" %s %s %s\n", $1, $2, $3, $4 == "" ? $3 : $4, $5 == "" ? "NaN" : $5 }' \
        > "$work/plot.dat"
gnuplot <<EOF
set terminal pngcairo size 1100,1250 font "Inter,10" background "#ffffff"
set output "$out/results.png"
set logscale x
set xlabel "time, microseconds: p50, a bar to p95, in grey the whole frame that was skipped"
set grid x
set offsets 0,0,0.6,0.6
unset key
set lmargin 46
plot "$work/plot.dat" using 2:0:2:3:yticlabels(1) with xerrorbars pt 7 ps 1.1 lc rgb "#1f6fc4", \
     "" using 4:0 with points pt 5 ps 1.0 lc rgb "#999999"
EOF

# The table of the README, between its two markers.
{
    echo "| case | p50 | p95 | whole frame | skipped | error |"
    echo "| --- | ---: | ---: | ---: | ---: | --- |"
    tail -n +2 "$out/results.csv" | sed 's/"//g' | awk -F, '
        function t(us) { return us == "" ? "" : us >= 1000 ? sprintf("%.2f ms", us / 1000) : us >= 1 ? sprintf("%.1f us", us) : us >= 0.01 ? sprintf("%.0f ns", us * 1000) : sprintf("%.2f ns", us * 1000) }
        { gsub("/process_time", "", $2); printf "| %s: %s | %s | %s | %s | %s | %s %s |\n", $1, $2, t($3), t($4), t($5), $6 == "" ? "" : sprintf("%.0fx", $6), $7 == "" ? "" : sprintf("%.3g", $7), $8 }'
    echo
    echo "$(measured_on) Simulated devices."
} > "$work/table.md"
into_readme bench "$work/table.md"
echo "wrote $out/results.csv, $out/results.png and the table in README.md"
