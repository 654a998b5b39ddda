#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the figures of all kinds of pictures, and uses dct_figures wrongly.
#   dct_figures_test.sh PROGRAM RENDERER FOLDER
# RENDERER is freqsynth_render, which makes the pictures.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/expect_failure.sh"
program=$(realpath "$1")
renderer=$(realpath "$2")
folder=$3
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

# size_of FILE: width and height in the header of a PNG.
size_of() {
  od -An -tu1 -j16 -N8 "$1" | awk '{print ($3 * 256 + $4) "x" ($7 * 256 + $8)}'
}

"$renderer" --scene zoneplate --size 61x45 -o picture.png
"$renderer" --scene zoneplate --size 61x45 --channels gray -o gray.png
"$renderer" --scene zoneplate --size 61x45 -o linear.exr
"$renderer" --scene chess --size 61x45 -o picture.jpg
"$renderer" --scene zoneplate --size 3x2 -o tiny.png

check_damaged() {
  local file pictures=()
  for file in "$@"; do
    if [[ $file == -- ]]; then break; fi
    pictures+=("$file")
  done
  shift $((${#pictures[@]} + 1))
  for file in "${pictures[@]}"; do
    for damage in cut_short huge; do
      "$damage" "$file" || continue
      expect_failure 1 "$damage.${file##*.}" "$damage.${file##*.}" "$@"
    done
  done
}

# What is said on a wrong command line: the option, its value, a usage line.
expect_failure 2 "usage: dct_figures"
expect_failure 2 "usage: dct_figures" picture.png
expect_failure 2 "usage: dct_figures" picture.png -o wrong --no-such-option
expect_failure 2 "gray.png" picture.png gray.png -o wrong
expect_failure 2 "--bits 0" picture.png -o wrong --bits 0
expect_failure 2 "--bits 9" picture.png -o wrong --bits 9
expect_failure 2 "--gain 2x" picture.png -o wrong --gain 2x
expect_failure 2 "--seed -1" picture.png -o wrong --seed -1
expect_failure 1 "missing.png" missing.png -o wrong
expect_failure 1 "said" said -o wrong
[[ ! -e wrong ]] || fail "a refused command made a folder"
expect_failure 1 "said" picture.png -o said

# A device without an end is refused, not read.
status=0
timeout 60 "$program" /dev/zero -o wrong >said 2>&1 || status=$?
[[ $status -eq 1 ]] || fail "/dev/zero: exit code $status"
grep -qF "/dev/zero: not a regular file" said || fail "/dev/zero: says $(cat said)"
[[ ! -e wrong ]] || fail "a refused command made a folder"

# Where the figures go is looked at before the first is written; a full disk leaves what was there.
mkdir -p taken/qualities.png
expect_failure 1 "taken/qualities.png: is a folder" picture.png -o taken
[[ $(ls -A taken) == qualities.png ]] || fail "figures are written before all can be"
mkdir full
echo "an older figure" >full/figure_2_terms_64.png
(
  trap '' XFSZ
  ulimit -f 1
  expect_failure 1 "full/figure_2_terms_64.png" picture.png -o full
)
[[ $(cat full/*) == "an older figure" ]] || fail "a full disk lost an older figure"
check_damaged picture.png picture.jpg linear.exr -- -o wrong
check_damaged picture.jpg -- --pixels -o wrong
[[ ! -e wrong ]] || fail "a damaged picture made a folder"

# All figures, in the sizes that follow from the picture's.
for input in picture.png gray.png linear.exr picture.jpg; do
  "$program" "$input" -o "of_$input" >said
  grep -qF "$input: 61 x 45 pixels" said || fail "$input: says $(cat said)"
  for terms in 01 03 06 10 15 21 36 64; do
    [[ $(size_of "of_$input/figure_2_terms_$terms.png") == 61x45 ]] || fail "$input: $terms terms"
  done
  [[ $(size_of "of_$input/figure_2.png") == 254x96 ]] || fail "$input: figure 2"
  [[ $(size_of "of_$input/figure_3.png") == 42x34 ]] || fail "$input: figure 3"
  [[ $(size_of "of_$input/qualities.png") == 191x49 ]] || fail "$input: qualities"
  cmp "of_$input/figure_4.png" of_picture.png/figure_4.png || fail "figure 4 is not repeatable"
done
"$program" tiny.png -o of_tiny >said
"$program" picture.jpg --pixels -o of_pixels >said
grep -qF "coefficients of its pixels" said || fail "--pixels: says $(cat said)"

# All terms are the picture, whose figures are the same again; fewer terms are another picture.
"$program" of_picture.png/figure_2_terms_64.png -o again >said
for figure in figure_2_terms_64 figure_2_terms_03 figure_3; do
  cmp "of_picture.png/$figure.png" "again/$figure.png" || fail "$figure is another one"
done
! cmp -s again/figure_2_terms_36.png again/figure_2_terms_64.png || fail "36 terms are all"

# A picture of one colour needs one term.
printf 'P3 9 7 255\n' >plain.ppm
for ((i = 0; i < 63; ++i)); do echo "200 100 50"; done >>plain.ppm
"$program" plain.ppm -o plain >said
cmp plain/figure_2_terms_01.png plain/figure_2_terms_64.png || fail "one colour, many terms"

# The options that change a figure do.
"$program" picture.png --gain 9 --bits 2 -o options >said
! cmp -s options/figure_3.png again/figure_3.png || fail "--gain changes nothing"
! cmp -s options/figure_4.png again/figure_4.png || fail "--bits changes nothing"
"$program" picture.png --seed 9 -o seed >said
! cmp -s seed/figure_4.png again/figure_4.png || fail "--seed changes nothing"
[[ -z $(find . -mindepth 1 -name '.*') ]] || fail "unfinished files are left"
echo "dct_figures: all as expected"
