#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Renders on 1 to 4 ranks, with delays and failures, and uses freqsynth_mpi wrongly.
#   freqsynth_mpi_test.sh PROGRAM FREQSYNTH_RENDER MPIEXEC FOLDER [FREQSYNTH_EMBREE]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/expect_failure.sh"
program=$(realpath "$1")
render=$(realpath "$2")
mpiexec=$3
folder=$4
embree=${5:+$(realpath "$5")}
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
# More ranks than cores, and containers have no other user.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
# on RANKS ARGUMENTS...
on() { "$mpiexec" -n "$1" "$program" "${@:2}"; }
# figure NAME: the first of that name in s.json
figure() { sed -n "s/.*\"$1\": \([0-9.e+]*\).*/\1/p" s.json | head -n 1; }

small=(--size 61x43 --wave 16)

# Alone, without mpirun.
expect_failure 2 "usage: mpirun -n RANKS freqsynth_mpi"
expect_failure 2 "usage: mpirun" --no-such-option
expect_failure 2 "--size 64" --size 64 -o a.png
expect_failure 2 "--spp -1" "${small[@]}" --spp -1 -o a.png
expect_failure 2 "--uniform 0" "${small[@]}" --uniform 0 -o a.png
expect_failure 2 "--uniform 99999999" "${small[@]}" --uniform 99999999 -o a.png
expect_failure 2 "--uniform: has no --spp" "${small[@]}" --uniform 4 --spp 1 -o a.png
expect_failure 2 "--windows 4" "${small[@]}" --windows 4 -o a.png
expect_failure 2 "--threads 0" "${small[@]}" --threads 0 -o a.png
expect_failure 1 "cut into more" --size 65536x65536 --windows 1x1 -o a.pfm
expect_failure 2 "cheese" "${small[@]}" --scene cheese -o a.png
expect_failure 2 "--scene colonnade" "${small[@]}" --frame 3 -o a.png
expect_failure 2 "--scene colonnade" "${small[@]}" --light-samples 2 -o a.png
expect_failure 2 "--checkpoint-every" "${small[@]}" --checkpoint-every 3 -o a.png
expect_failure 1 "nowhere/a.png" "${small[@]}" -o nowhere/a.png
expect_failure 1 "missing.png" "${small[@]}" --scene image:missing.png -o a.png
[[ ! -e a.png ]] || fail "a refused command wrote a picture"
"$program" --help >said
grep -qF -- "--windows" said || fail "--help says $(cat said)"
# On several ranks it ends as well, and is said once.
! on 3 "${small[@]}" --scene cheese -o a.png >said 2>&1 || fail "cheese is a scene"
[[ $(grep -cF "unknown scene 'cheese'" said) == 1 ]] || fail "says $(cat said)"
! timeout 60 "$mpiexec" -n 3 "$program" "${small[@]}" -o nowhere/a.png >said 2>&1 ||
  fail "there is a folder"

# One process and many make the same picture.
for scene in chess cornell; do
  one=(--scene $scene "${small[@]}" --spp 2 --seed 5)
  "$render" "${one[@]}" -o "$scene.pfm"
  for ranks in 1 2 3 4; do
    on $ranks "${one[@]}" --delays $ranks -o ranks.pfm --stats s.json >said
    cmp "$scene.pfm" ranks.pfm || fail "$scene: another picture on $ranks ranks"
    grep -qF "ranks.pfm: 2 samples per pixel" said || fail "says $(cat said)"
    [[ $(figure samples) == $((2 * 61 * 43)) ]] || fail "$(figure samples) samples"
  done
done
on 3 "${one[@]}" --threads 2 -o ranks.pfm >said
cmp "$scene.pfm" ranks.pfm || fail "another picture with two threads on each rank"

# Who is slower gets less: a sample takes rank 3 three times as long as rank 1.
on 4 --scene chess --size 61x43 --wave 48 --spp 1/2 --sleep 300 --uneven -o ranks.pfm \
  --stats s.json >said
samples=($(sed -n 's/.*{"samples": \([0-9]*\).*/\1/p' s.json))
((samples[1] > samples[3])) || fail "ranks of different speed have traced ${samples[*]}"
# Each goes on to a second packet while the values of the first travel.
[[ $(grep -cF '"most_under_way": 2' s.json) == 3 ]] || fail "not two: $(cat s.json)"

# Ranks that fail now and then, and ranks that always do.
for share in 1/20 1; do
  on 4 "${one[@]}" --failures $share -o ranks.pfm --stats s.json >said 2>&1
  cmp "$scene.pfm" ranks.pfm || fail "another picture when ranks fail"
  grep -qF "fails on trial" said || fail "says $(cat said)"
  grep -q '"errors": [1-9]' s.json || fail "no rank has failed"
done
# Then rank 0 has traced all, with those that are asked twice.
awk '/"packets"/ { gsub(/[^0-9. ]/, " "); n += $1; if (!first) first = $1 }
     END { exit !(first == n && n > 0) }' s.json || fail "rank 0 has not traced all: $(cat s.json)"

# Where blocks have equal samples there is no seam: windows are the whole, to the bit.
for samples in 1 13 81; do
  even=(--scene chess --size 61x43 --uniform $samples)
  on 1 "${even[@]}" -o whole.pfm >said
  for ranks in 1 3; do
    on $ranks "${even[@]}" --windows 3x2 -o windows.pfm >said
    cmp whole.pfm windows.pfm || fail "a seam with $samples samples in each block"
  done
done
# Otherwise they depend on neither the ranks nor what happens to them.
windows=(--scene chess --size 136x104 --spp 1 --windows 3x2)
on 1 "${windows[@]}" -o windows.pfm --stats s.json >said
awk -v n="$(figure samples_per_pixel)" 'BEGIN { exit !(n > 0.99 && n < 1.01) }' ||
  fail "$(figure samples_per_pixel) samples per pixel in windows"
on 4 "${windows[@]}" --delays 1 -o again.pfm >said
cmp windows.pfm again.pfm || fail "other windows on 4 ranks"
on 3 "${windows[@]}" --failures 1/100 -o again.pfm >said 2>&1
cmp windows.pfm again.pfm || fail "other windows when ranks fail"

# The scene of the host on Embree, with all its channels, is that host's picture.
if [[ -n $embree ]]; then
  # same A.exr B.exr: but for the time at which they were made
  same() { cmp <(sed -E 's/[0-9]{4}(:[0-9]{2}){2} [0-9]{2}(:[0-9]{2}){2}//' "$1") \
    <(sed -E 's/[0-9]{4}(:[0-9]{2}){2} [0-9]{2}(:[0-9]{2}){2}//' "$2"); }
  scene=(--size 93x61 --frame 3 --eye 2,-18,2 --light-samples 2 --spp 1/4)
  "$embree" "${scene[@]}" -o colonnade.exr >said
  for ranks in 1 3; do
    on $ranks --scene colonnade "${scene[@]}" -o ranks.exr >said
    same colonnade.exr ranks.exr || fail "colonnade: another picture on $ranks ranks"
  done
  on 4 --scene colonnade "${scene[@]}" --failures 1/10 -o ranks.exr >said 2>&1
  same colonnade.exr ranks.exr || fail "colonnade: another picture when ranks fail"
  "$embree" "${scene[@]}" --frame 4 -o other.exr >said
  ! same colonnade.exr other.exr >said || fail "pictures of other frames are the same"
  # In windows, too, and whatever the ranks.
  on 1 --scene colonnade "${scene[@]}" --windows 2x2 -o windows.exr >said
  on 3 --scene colonnade "${scene[@]}" --windows 2x2 -o again.exr >said
  same windows.exr again.exr || fail "colonnade: other windows on 3 ranks"
  # A triangle in a file, where such files are read.
  printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >triangle.obj
  if "$embree" --size 32x24 --spp 1 --obj triangle.obj -o obj.exr >said 2>&1; then
    on 2 --size 32x24 --spp 1 --scene obj:triangle.obj -o ranks.exr >said
    same obj.exr ranks.exr || fail "obj: another picture on 2 ranks"
  fi
  expect_failure 1 "none.obj" --size 32x24 --scene obj:none.obj -o a.exr
  expect_failure 2 "--field 171" --size 32x24 --scene colonnade --field 171 -o a.exr
else
  expect_failure 1 "built without Embree" "${small[@]}" --scene colonnade -o a.exr
fi

# All ranks are lost, and others go on from what is on the disk, or one process.
rm -f state
on 3 --scene chess "${small[@]}" --spp 40 --seed 5 --sleep 20 --checkpoint state --checkpoint-every 0.2 \
  -o lost.pfm >said 2>&1 &
for ((i = 0; i < 300; ++i)); do
  [[ ! -e state ]] || break
  sleep 0.1
done
kill -KILL $(ps -o pid= --ppid $!) # mpiexec, and with it its ranks
wait $! || true
[[ -e state && ! -e lost.pfm ]] || fail "nothing was lost: $(cat said)"
cp state state_then
"$render" --scene chess "${small[@]}" --spp 40 --seed 5 -o whole.pfm
for ranks in 1 3; do
  on $ranks --scene chess "${small[@]}" --spp 40 --seed 5 --resume state_then -o resumed.pfm >said
  cmp whole.pfm resumed.pfm || fail "another picture on $ranks ranks after the loss of all"
done
expect_failure 1 "no state of windows" "${small[@]}" --windows 2x2 --resume state_then -o a.png
expect_failure 1 "missing" "${small[@]}" --resume missing -o a.png

# The same in windows, when the first of them is done.
windows=(--scene cornell --size 136x104 --spp 1 --windows 4x3)
on 1 "${windows[@]}" -o windows.pfm >said
rm -f state state_then
on 3 "${windows[@]}" --sleep 500 --checkpoint state --checkpoint-every 0.1 -o lost.pfm >said 2>&1 &
for ((i = 0; i < 600; ++i)); do
  if [[ ! -e state_then && -e state ]]; then cp state state_then; fi
  [[ ! -e state_then ]] || cmp -s state state_then || break
  sleep 0.1
done
kill -KILL $(ps -o pid= --ppid $!)
wait $! || true
[[ -e state && ! -e lost.pfm ]] || fail "nothing was lost: $(cat said)"
for ranks in 1 3; do
  on $ranks "${windows[@]}" --resume state -o resumed.pfm --stats s.json >said
  cmp windows.pfm resumed.pfm || fail "other windows on $ranks ranks after the loss of all"
  left=($(sed -n 's/.*"windows": \[\(.*\)\].*/\1/p' s.json | tr -d ,))
  ((${#left[@]} < 12)) || fail "all windows are made again"
done
# Of a run that has ended nothing is left to do.
on 3 "${windows[@]}" --checkpoint state -o again.pfm >said
on 3 "${windows[@]}" --resume state -o again.pfm --stats s.json >said
cmp windows.pfm again.pfm || fail "other windows from those that were done"
! grep -q '"packets": [1-9]' s.json || fail "windows that were done are made again"
expect_failure 1 "was made with other options" --scene cornell --size 136x104 --spp 2 \
  --windows 4x3 --resume state -o a.png

# An interrupt: what there is is written.
rm -f state
"$program" --scene chess --size 256x256 --spp 100 --sleep 100 --checkpoint state --checkpoint-every 0.5 \
  -o part.pfm >said 2>&1 &
for ((i = 0; i < 300; ++i)); do
  [[ ! -e state ]] || break
  sleep 0.1
done
kill -INT $!
status=0
wait $! || status=$?
[[ $status -eq 130 && -e part.pfm ]] || fail "exit code $status after SIGINT: $(cat said)"
[[ -z $(find . -mindepth 1 -name '.*') ]] || fail "unfinished files are left"
echo "freqsynth_mpi: all as expected"
