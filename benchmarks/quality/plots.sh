#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws the error against samples per pixel, a panel for each scene and a curve for each method. On
# Debian, installs what is missing.
#   benchmarks/quality/plots.sh [RESULTS.csv [PICTURE.png]]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
results=${1:-$root/out/quality/results.csv}
picture=${2:-${results%.csv}.png}
"$root/.ci/install_missing" gnuplot-nox

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# A file of two columns, rate and error, for each curve.
sort -t, -k3,3g "$results" | awk -F, -v folder="$folder" '
  $1 == "scene" { next }
  { print $3, $8 >(folder "/" $1 "," $2) }'
mapfile -t scenes < <(awk -F, 'NR > 1 && !seen[$1]++ { print $1 }' "$results")
mapfile -t methods < <(awk -F, 'NR > 1 && !seen[$2]++ { print $2 }' "$results")
[[ ${#scenes[@]} -gt 0 ]] || {
  echo "plots.sh: $results has no results" >&2
  exit 1
}

# The two that the text is about stand out; the others differ in colour and mark.
colours=(1f77b4 2ca02c 9467bd 8c564b e377c2 17becf bcbd22 ff9f1c 5577aa 66aa99 aa7744 7f7f7f)
style() {
  case ${methods[$1]} in
    freqsynth) echo 'lw 3 lc rgb "#d02020" pt 7 ps 0.9' ;;
    freqsynth-paper) echo 'lw 2 lc rgb "#f09070" pt 6 ps 0.7' ;;
    jittered-box) echo 'lw 3 lc rgb "#000000" pt 5 ps 0.8' ;;
    *) echo "lw 1.3 lc rgb '#${colours[$1 % ${#colours[@]}]}' pt $((1 + $1 % 13)) ps 0.7" ;;
  esac
}

panels=$((${#scenes[@]} + 1))  # the last one is the key
columns=$((panels < 4 ? panels : 4))
rows=$(((panels + columns - 1) / columns))
{
  echo "set terminal pngcairo size $((400 * columns)),$((360 * rows)) font 'sans,10'"
  echo "set output '$folder/picture.png'"
  echo "set multiplot layout $rows,$columns"
  echo 'set logscale xy; set grid; set key off'
  echo 'set xtics ("1/16" .0625, "1/4" .25, "1" 1, "4" 4, "16" 16, "64" 64)'
  echo 'set xlabel "samples per pixel"; set ylabel "RMSE"; set format y "%.3g"'
  echo 'set xrange [.05:80]; set autoscale yfix'
  # Fewer than two decades need more than their powers of ten.
  echo 'set ytics ()'
  echo 'do for [e=-8:4] { set ytics add (10.0**e, 2 * 10.0**e, 5 * 10.0**e) }'
  for scene in "${scenes[@]}"; do
    echo "set title '${scene//[_\']/ }'"
    curves=()
    for i in "${!methods[@]}"; do
      file=$folder/$scene,${methods[$i]}
      [[ -e $file ]] && curves+=("'$file' with linespoints $(style "$i")")
    done
    (IFS=,; echo "plot ${curves[*]}")
  done
  echo 'unset title; unset tics; unset grid; unset xlabel; unset ylabel; unset border'
  echo 'set key center center Left reverse; set yrange [1:2]'
  curves=()
  for i in "${!methods[@]}"; do
    curves+=("NaN with linespoints $(style "$i") title '${methods[$i]}'")
  done
  (IFS=,; echo "plot ${curves[*]}")
} >"$folder/script"
gnuplot "$folder/script"
mv "$folder/picture.png" "$picture"
