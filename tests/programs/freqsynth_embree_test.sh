#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Renders the colonnade by all samplers and an OBJ file, and uses freqsynth_embree wrongly.
#   freqsynth_embree_test.sh PROGRAM FOLDER
set -euo pipefail
script=$(realpath "${BASH_SOURCE[0]}")
source "$(dirname "$script")/expect_failure.sh"
program=$(realpath "$1")
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

# A reader can copy the glue: the documents say how long it is.
root=$(cd "$(dirname "$script")/../.." && pwd)
lines=$(wc -l <"$root/examples/embree/glue.h")
[[ $lines -lt 60 ]] || fail "glue.h has $lines lines"
for document in README.md docs/embree.md; do
  tr '\n' ' ' <"$root/$document" | grep -q "embree/glue.h\`, $lines lines" ||
    fail "$document does not say that glue.h has $lines lines"
done

small=(--size 43x30 --spp 2)
expect_failure 2 "usage: freqsynth_embree"
expect_failure 2 "usage: freqsynth_embree" --no-such-option
expect_failure 2 "-o: no output file is named" "${small[@]}"
expect_failure 2 "--size 43" --size 43 -o a.png
expect_failure 2 "--spp -1" --spp -1 -o a.png
expect_failure 2 "--sampler halton" "${small[@]}" --sampler halton -o a.png
expect_failure 2 "--spp 1/2" "${small[@]}" --spp 1/2 --sampler sobol -o a.png
expect_failure 2 "--threads 0" "${small[@]}" --threads 0 -o a.png
expect_failure 2 "--light-samples 0" "${small[@]}" --light-samples 0 -o a.png
expect_failure 2 "--eye 1,2" "${small[@]}" --eye 1,2 -o a.png
expect_failure 2 "--eye 1,2,x" "${small[@]}" --eye 1,2,x -o a.png
expect_failure 2 "--target" "${small[@]}" --eye 1,2,3 --target 1,2,9 -o a.png
expect_failure 2 "--field 171" "${small[@]}" --field 171 -o a.png
expect_failure 2 "--sun-size 0" "${small[@]}" --sun-size 0 -o a.png
expect_failure 2 "--checkpoint" "${small[@]}" --sampler sobol --checkpoint a.state -o a.png
expect_failure 2 "--checkpoint-every" "${small[@]}" --checkpoint-every 3 -o a.png
expect_failure 1 "none.state" "${small[@]}" --resume none.state -o a.png
expect_failure 1 "no/folder" "${small[@]}" -o no/folder/a.png
expect_failure 1 "a.unknown" "${small[@]}" -o a.unknown
expect_failure 1 "none.obj" "${small[@]}" --obj none.obj -o a.png
[[ -z $(ls -A | grep -v '^said$') ]] || fail "a refused command wrote a picture"

for sampler in freqsynth jittered sobol; do
  "$program" "${small[@]}" --sampler $sampler -o $sampler.png >said
  grep -qF "$sampler.png: 113114 triangles, 2 samples per pixel" said || fail "says $(cat said)"
  "$program" "${small[@]}" --sampler $sampler --threads 1 -o again.png >said
  cmp $sampler.png again.png || fail "$sampler: another picture with one thread"
  for other in "--frame 1" "--light-samples 2" "--sun-size 20" "--field 30" \
    "--eye 2,-18,2 --target 0,0,3"; do
    read -ra words <<<"$other"
    "$program" "${small[@]}" --sampler $sampler "${words[@]}" -o again.png >said
    ! cmp -s $sampler.png again.png || fail "$sampler: $other changes nothing"
  done
done
! cmp -s jittered.png sobol.png || fail "--sampler changes nothing"
"$program" --help >said
grep -qF -- "--light-samples" said || fail "--help says $(cat said)"

# EXR has all channels.
"$program" "${small[@]}" --spp 1/2 -o picture.exr >said
for channel in R G B albedo.R normal.Z sun; do
  grep -qaF "$channel" picture.exr || fail "picture.exr: no channel $channel"
done

# A triangle on a line of its own; without tinyobjloader that is said.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >triangle.obj
if "$program" "${small[@]}" --obj triangle.obj -o obj.png >said 2>&1; then
  grep -qF "obj.png: 1 triangles" said || fail "says $(cat said)"
else
  grep -qF "triangle.obj: built without tinyobjloader" said || fail "says $(cat said)"
fi

# What there is by an interrupt is written, and it goes on from there.
long=(--size 320x180 --spp 16 --threads 1)
"$program" "${long[@]}" --checkpoint a.state -o stopped.png >said 2>&1 &
sleep 1
kill -INT $!
code=0
wait $! || code=$?
if [[ $code == 130 ]]; then  # not so on a machine that has done it all by then
  [[ -s stopped.png && -s a.state ]] || fail "interrupted: no picture or no state"
  "$program" "${long[@]}" --resume a.state -o resumed.png >said
  "$program" "${long[@]}" -o whole.png >said
  cmp resumed.png whole.png || fail "another picture after an interruption"
else
  [[ $code == 0 ]] || fail "interrupted: exit code $code, says $(cat said)"
fi
[[ -z $(find . -mindepth 1 -name '.*') ]] || fail "unfinished files are left"
echo "freqsynth_embree: all as expected"
