#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures how well predicted errors agree with the true ones; writes docs/error.md, docs/error.png
# and docs/error_maps.jpg. On Debian, installs what is missing. The first run makes references,
# which takes minutes; later ones take three.
#   benchmarks/quality/error.sh
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libbenchmark-dev \
  libjpeg62-turbo-dev libopenimageio-dev openimageio-tools gnuplot-nox
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset quality &&
  cmake --build --preset quality -j "$(nproc)" --target freqsynth_error) >&2
program=$root/build/quality/benchmarks/quality/freqsynth_error
out=$root/out/error
mkdir -p "$out"
"$program" --cache "$root/out/quality/references" --csv "$out/results.csv" \
  --pictures "$out/pictures" >"$out/scenes.md"
"$program" --functions 100 >"$out/functions.md"

# One point for each scene and rate.
{
  cat <<'TEXT'
set terminal pngcairo size 900,760 font "sans,11" background "#ffffff"
set logscale xy
set format xy "%.0e"
set xlabel "true root mean square error"
set ylabel "predicted"
set key left top
set grid lc rgb "#dddddd"
set xrange [5e-6:10]
set yrange [5e-6:10]
set datafile separator ","
TEXT
  printf 'plot x w l lc rgb "#000000" t "equal", 1.5*x w l dt 2 lc rgb "#777777" t "1.5 times", '
  printf 'x/1.5 w l dt 2 lc rgb "#777777" notitle'
  marks=(1 7 5 9)
  rates=(0.25 1 4 16)
  names=("1/4 sample per pixel" 1 4 16)
  for i in 0 1 2 3; do
    printf ', "<awk -F, '"'"'$2 == %s'"'"' %s" using 4:3 w p pt %s ps 1.2 t "%s"' \
      "${rates[i]}" "$out/results.csv" "${marks[i]}" "${names[i]}"
  done
  echo
} | gnuplot >"$root/docs/error.png"

# Picture, prediction, truth.
maps=()
for each in chess_1 star_4 dot_4 softshadow_1 cornell_4; do maps+=("$out/pictures/$each.png"); done
oiiotool "${maps[@]}" --mosaic:pad=4 1x5 --compression jpeg:90 -o "$root/docs/error_maps.jpg"

read -r rows within < <(awk -F, 'NR > 1 { ++n; if ($5 > 0.67 && $5 < 1.5) ++w } END { print n, w }' \
  "$out/results.csv")
outside=$(awk -F, 'NR > 1 && !($5 > 0.67 && $5 < 1.5) {
  printf "%s%s at %s (%.2f)", (n++ ? ", " : ""), $1, ($2 == 0.25 ? "1/4" : $2), $5 }' \
  "$out/results.csv")
{
  cat <<TEXT
# How good predicted errors are

Written by \`benchmarks/quality/error.sh\`. \`Synthesizer::predicted_rmse()\` and \`error_image()\`
against the truth: the scenes of [quality.md](quality.md) at 256 x 256 pixels, means over three
seeds. What is predicted is the root mean square error of linear values of \`finished_image()\`;
that of the reference is taken off the true one.

Of $rows pictures $within are predicted within a factor of 1.5; those that are not: $outside.

![Predicted against true errors](error.png)

TEXT
  cat "$out/scenes.md"
  cat <<'TEXT'

* *ratio*: predicted over true, both root mean squares over the seeds; *of single runs*: the least and
  the greatest.
* *blocks' ranks*: Spearman's correlation of the predicted and the true errors of blocks. It is low
  where nearly all blocks are right to the last digit (edge, corner), where all errors are in what
  no sample has hit (dot), and within one texture (zoneplate).
* *worst tenth*: how much of all squared errors is in the tenth of the pixels of which most error is
  predicted, and how much is in the tenth that has most.

## Functions that no constant was chosen on

The estimate has a dozen constants. They were first chosen on every other scene of the table, from
`fan` on; after a look at the other half the form of the estimate was changed in three places (what
the filter takes away, how much smooth functions profit, how the noise of each term is counted), and
the constants were set with all scenes in view. So the table above is no test. This is one: a hundred
random functions of edges, discs, bars and gratings of 64 x 64 pixels, whose averages are exact, one
run of each; with noise they are seen with a probability of 1/4, four times as bright.

TEXT
  cat "$out/functions.md"
  cat <<'TEXT'

With noise, pictures of 1/4 sample per pixel are better than predicted, and those of 16 are worse:
noise at sharp bars is smoothed less than elsewhere.

## What it looks like

Pictures, their predicted and their true errors, in units of twice the true root mean square error:
chess with 1 sample per pixel, star and dot with 4, softshadow with 1, cornell with 4.

![Pictures, predicted errors, true errors](error_maps.jpg)

## What to know of it

* What is predicted is the error of linear values, in which bright parts decide: a lamp of 250 in a
  room of 1 is most of it. For errors as they are seen, sample encoded values.
* What no sample has hit is known by what happened elsewhere: how often blocks turned out to hide
  something, and how much. What is in one place only, such as the caustics of spheres with 1/4 sample
  per pixel, nobody can predict before it is seen.
* Where there is noise, and light comes by few rare paths, the same holds until they are found.
* A grating that is smooth and finer than pixels is better than predicted from 4 samples per pixel on
  (zoneplate-high); bars that are as fine are worse. Residuals do not tell them apart.
TEXT
} >"$root/docs/error.md"
echo "The page is $root/docs/error.md." >&2
