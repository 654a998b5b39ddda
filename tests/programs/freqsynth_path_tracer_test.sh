#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Renders both scenes by all samplers, and uses freqsynth_path_tracer wrongly.
#   freqsynth_path_tracer_test.sh PROGRAM FOLDER
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/expect_failure.sh"
program=$(realpath "$1")
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

# size_of FILE: width and height in the header of a PNG.
size_of() {
  od -An -tu1 -j16 -N8 "$1" | awk '{print ($3 * 256 + $4) "x" ($7 * 256 + $8)}'
}

small=(--size 43x30 --spp 2)
expect_failure 2 "usage: freqsynth_path_tracer"
expect_failure 2 "usage: freqsynth_path_tracer" --no-such-option
expect_failure 2 "-o: no output file is named" "${small[@]}"
expect_failure 2 "--size 43" --size 43 -o a.png
expect_failure 2 "--spp -1" --spp -1 -o a.png
expect_failure 2 "kitchen" "${small[@]}" --scene kitchen -o a.png
expect_failure 2 "--sampler halton" "${small[@]}" --sampler halton -o a.png
expect_failure 2 "--spp 1/2" "${small[@]}" --spp 1/2 --sampler sobol -o a.png
expect_failure 2 "--spp 1e12" "${small[@]}" --spp 1e12 --sampler sobol -o a.png
expect_failure 2 "--frame -1" "${small[@]}" --frame -1 -o a.png
expect_failure 2 "--threads 0" "${small[@]}" --threads 0 -o a.png
expect_failure 1 "no/folder" "${small[@]}" -o no/folder/a.png
expect_failure 1 "a.unknown" "${small[@]}" -o a.unknown
[[ -z $(ls -A | grep -v '^said$') ]] || fail "a refused command wrote a picture"

for scene in cornell spheres; do
  for sampler in freqsynth jittered sobol; do
    name=${scene}_$sampler
    "$program" "${small[@]}" --scene $scene --sampler $sampler -o "$name.png" >said
    grep -qF "$name.png: 2 samples per pixel" said || fail "$name: says $(cat said)"
    [[ $(size_of "$name.png") == 43x30 ]] || fail "$name: size"
    "$program" "${small[@]}" --scene $scene --sampler $sampler --threads 1 -o again.png >said
    cmp "$name.png" again.png || fail "$name: another picture with one thread"
    "$program" "${small[@]}" --scene $scene --sampler $sampler --frame 1 -o again.png >said
    ! cmp -s "$name.png" again.png || fail "$name: the same noise in another frame"
  done
done
! cmp -s cornell_jittered.png cornell_sobol.png || fail "--sampler changes nothing"
"$program" --help >said
grep -qF -- "--sampler" said || fail "--help says $(cat said)"

# EXR has the features.
"$program" "${small[@]}" --spp 1/2 -o picture.exr >said
for channel in R G B colour.R normal.Z nearness; do
  grep -qaF "$channel" picture.exr || fail "picture.exr: no channel $channel"
done
[[ -z $(find . -mindepth 1 -name '.*') ]] || fail "unfinished files are left"
echo "freqsynth_path_tracer: all as expected"
