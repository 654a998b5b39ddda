#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses freqsynth_quality as a newcomer does, and as a careless one does.
#   freqsynth_quality_test.sh PROGRAM FOLDER
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../programs/expect_failure.sh"
program=$(realpath "$1")
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

small=(--scenes fan,zoneplate --methods freqsynth,jittered-box --spp 1/4,1 --size 40x32
  --reference 16)

# What is said on a wrong command line: the option, its value, what there is.
expect_failure 2 "usage: freqsynth_quality" --no-such-option
expect_failure 2 "cheese" --scenes fan,cheese
expect_failure 2 "zoneplate" --scenes fan,cheese
expect_failure 2 "'crystal-ball' (known are freqsynth, " --scenes fan --methods crystal-ball
expect_failure 2 "--methods a,,b" --methods a,,b
expect_failure 2 "--spp 0" "${small[@]}" --spp 1,0
expect_failure 2 "--spp 1/x" "${small[@]}" --spp 1/x
expect_failure 2 "--spp 5000" "${small[@]}" --spp 5000
expect_failure 2 "--size 10x32" "${small[@]}" --size 10x32
expect_failure 2 "--size 40" "${small[@]}" --size 40
expect_failure 2 "--seeds 0" "${small[@]}" --seeds 0
expect_failure 2 "--reference 15" "${small[@]}" --reference 15
expect_failure 2 "--threads 0" "${small[@]}" --threads 0

# Files, before any work is done.
expect_failure 1 "nowhere/a.csv" "${small[@]}" --csv nowhere/a.csv
expect_failure 1 "missing.png" --scenes image:missing.png
expect_failure 1 "said" "${small[@]}" --pictures said
expect_failure 1 "said" "${small[@]}" --cache said

"$program" --help | grep -q -- --reference || fail "--help does not tell the options"
"$program" --list >list
for name in fan chess zoneplate image:FILE freqsynth freqsynth-paper jittered-box; do
  grep -q "^  $name" list || fail "--list has no $name"
done

# The table: names, a line for each scene, method and rate, as many numbers as names.
"$program" "${small[@]}" --seeds 2 --csv a.csv --cache cache --pictures pictures
[[ $(head -1 a.csv) == scene,method,spp,width,height,seeds,samples,rmse,rmse_deviation,psnr,* ]] ||
  fail "unexpected names: $(head -1 a.csv)"
[[ $(wc -l <a.csv) -eq 9 ]] || fail "$(wc -l <a.csv) lines instead of 9"
awk -F, 'NR == 1 { names = NF }
  NF != names { print "line " NR " has " NF " fields"; exit 1 }
  NR > 1 && !($3 > 0 && $7 <= $3 * 1280 && $8 > 0 && $8 < 1 && $12 <= 1) { print; exit 1 }' a.csv ||
  fail "not a usable table"
for line in fan,freqsynth,0.25 fan,jittered-box,1 zoneplate,freqsynth,1; do
  grep -q "^$line,40,32,2," a.csv || fail "no line $line"
done

# Pictures.
for picture in reference freqsynth_1_4 freqsynth_1 jittered-box_1_4 jittered-box_1; do
  [[ $(head -c 4 "pictures/fan/$picture.png" | tail -c 3) == PNG ]] || fail "no picture $picture"
done
grep -q '^40x32+0+0$' pictures/zoneplate/window.txt || fail "no window"

# The same figures on every run but for times, whatever the number of threads, with and without
# kept references.
[[ $(find cache -name '*.exr' | wc -l) -eq 4 ]] || fail "the cache does not hold two halves each"
figures() { sed 's/\(,[^,]*\)\{2\}$//' "$1"; }
"$program" "${small[@]}" --seeds 2 --csv b.csv --cache cache --threads 1
"$program" "${small[@]}" --seeds 2 --threads 3 >c.csv
cmp <(figures a.csv) <(figures b.csv) || fail "kept references change the figures"
cmp <(figures a.csv) <(figures c.csv) || fail "the number of threads changes the figures"

# A reference that is broken is made anew; other settings have references of their own.
for file in cache/fan_*_a.exr; do echo broken >"$file"; done
"$program" "${small[@]}" --seeds 2 --csv d.csv --cache cache
cmp <(figures a.csv) <(figures d.csv) || fail "a broken reference was taken"
"$program" "${small[@]}" --reference 36 --csv e.csv --cache cache
[[ $(find cache -name '*.exr' | wc -l) -eq 8 ]] || fail "references of two settings share a file"

# Each option counts.
"$program" "${small[@]}" --seeds 1 --csv f.csv
! cmp -s <(figures a.csv) <(figures f.csv) || fail "--seeds changes nothing"
"$program" --quick --scenes zoneplate --methods freqsynth --spp 1/2 --csv g.csv
# Of 8192 calls; with those that are asked for twice it may be one less.
grep -q '^zoneplate,freqsynth,0.5,128,128,1,819[12],' g.csv || fail "--quick: $(tail -1 g.csv)"

# Path-traced scenes have references of four times as many samples.
"$program" "${small[@]}" --scenes cornell --csv h.csv
[[ $(awk -F, 'NR == 2 { print $17 }' h.csv) == 64 ]] || fail "the reference of cornell: $(tail -1 h.csv)"

# What is made for noise is measured with noisy scenes alone.
"$program" "${small[@]}" --scenes fan,glossy --methods nlm,sobol-box --spp 1 --csv i.csv
[[ $(sed 1d i.csv | cut -d, -f1-2 | xargs) == "fan,sobol-box glossy,nlm glossy,sobol-box" ]] ||
  fail "unexpected lines: $(cat i.csv)"

# The table of noise, and pictures side by side: five methods and the reference, at two rates.
"$program" --noisy --spp 1/2,1 --size 40x32 --reference 4 --pictures sheets >j
for scene in softshadow dof glossy cornell spheres; do
  grep -qE "^\\| $scene +\\| +1 \\| nfor " j || fail "--noisy has no $scene: $(cat j)"
  grep -q "^$scene: the reference is off by " j || fail "--noisy says nothing of the reference"
done
[[ $(grep -c '^| [a-z]* *| ' j) -eq $((1 + 6 * 8)) ]] || fail "--noisy: $(cat j)"
# 6 columns of 40 pixels and 2 rows of 32, with gaps of 2: big-endian, from byte 16 on.
size=$(od -An -tu1 -j16 -N8 sheets/dof.png | xargs)
[[ $size == "0 0 0 254 0 0 0 70" ]] || fail "the sheet has another size: $size"
