#!/usr/bin/env bash
# Draws time against error from the table of bench_perceived. Usage: perceived_plot.sh TABLE.csv PICTURE.png
set -euo pipefail
table=$1 picture=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# points NAME FILTER: "label ms dB kind known" of each row that passes, and the staircase of the best of them.
points() {
    awk -F, -v want="$2" 'NR > 1 && $6 != "" && $10 != "" {
            section = $1; scene = $2; what = $4; threads = $5
            split(want, w, "|")
            if (section == "scene" && w[1] == "view" && scene == w[2] && what == "full frame" && threads == 2) kind = 0
            else if (section == "baseline" && w[1] == "view" && scene == w[2]) kind = 1
            else if (section == "plane" && w[1] == "plane" && what == w[2]) kind = $3 ~ /^engine/ ? 0 : 1
            else next
            printf "\"%s\" %s %s %d %d\n", $3 ($15 == "floor" ? " (floor)" : ""), $6, ($10 == "inf" ? 150 : $10), kind, $15 == "floor"
        }' "$table" > "$work/$1.dat"
    awk '{ n = split($0, q, "\""); split(q[3], v, " "); print v[1], v[2] }' "$work/$1.dat" | sort -g |
        awk 'NR == 1 || $2 > best { if (NR > 1) print $1, best; best = $2; print $1, $2; last = $1 }
             END { if (NR) print last * 30, best }' > "$work/$1.front"
    # An empty plot is an error to gnuplot.
    [ -s "$work/$1.dat" ] || echo '"not measured" 1 50 1 0' > "$work/$1.dat"
    [ -s "$work/$1.front" ] || echo '1 50' > "$work/$1.front"
}
points seam "view|seam"
points eye "view|four objects; eye"
points camera "view|four objects; camera"
points plane8 "plane|r = 8"
points plane20 "plane|r = 20"
points twice "view|everything lit twice"

panel() { # NAME TITLE FROM TO
    cat <<END
set title "$2"
set yrange [$3:$4]
plot "$work/$1.front" using 1:2 with lines lc rgb "#bbbbbb" lw 2, \
     58.9 with lines dt 2 lc rgb "#999999", \
     "+" using (16.7):(\$0 * ($4 - ($3)) / 99.0 + ($3)) with lines dt 3 lc rgb "#999999", \
     "$work/$1.dat" using (\$4 == 1 ? \$2 : NaN):3 with points pt 5 ps 1.2 lc rgb "#c05a1c", \
     "" using (\$4 == 0 ? \$2 : NaN):3 with points pt 7 ps 1.4 lc rgb "#1f6fc4", \
     "" using 2:3:1 with labels offset 0,0.9 font ",8" tc rgb "#333333"
END
}
{
    cat <<END
set terminal pngcairo size 1400,950 font "Inter,10" background "#ffffff"
set output "$picture"
set multiplot layout 2,3 title "Time against error: engine (blue), libraries (orange), best of all (grey); dashed 8-bit codes, dotted 60 frames/s"
set logscale x
set xrange [0.1:10000]
set xlabel "milliseconds, p50"
set ylabel "PSNR, dB"
set grid x y lc rgb "#eeeeee"
set samples 100
unset key
END
    panel seam "Seam, 1024x768 RGB" 15 95
    panel eye "Four objects, eye" 15 70
    panel camera "Four objects, camera f/1.4" 15 70
    panel twice "Everything lit twice" 15 70
    panel plane8 "One plane, disc of 8 px" 15 175
    panel plane20 "One plane, disc of 20 px" 15 175
    echo "unset multiplot"
} > "$work/plot.gp"
gnuplot "$work/plot.gp"
