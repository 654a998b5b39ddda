#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures the error of this library and of others, scene by scene. On Debian, installs what is
# missing. Then benchmarks/quality/report tells it in docs/quality.md.
#   benchmarks/quality/run.sh             all scenes: ten minutes or more
#   benchmarks/quality/run.sh SCENE...    these scenes; what is known of the others is kept
#   benchmarks/quality/run.sh --quick [SCENE...]   small pictures, in out/quality_quick: a minute
# Writes out/quality/results.csv, a line for each scene, method and rate, and out/quality/pictures.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

out=$root/out/quality
settings=(--size 256x256 --seeds 3 --reference 1024)
rates=1/16,1/8,1/4,1/2,1,2,4
# freqsynth, the yardsticks and what is made for noise are measured further, to tell whether it stays better, and the
# yardsticks further still, to tell how many of their samples are as good.
more_rates=8,16
most_rates=32,64
if [[ ${1:-} == --quick ]]; then
  shift
  out=$root/out/quality_quick
  settings=(--size 128x128 --seeds 1 --reference 256)
  rates=1/16,1/4,1,4
  more_rates=16
  most_rates=64
fi

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libbenchmark-dev \
  libjpeg62-turbo-dev libopenimageio-dev
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset quality && cmake --build --preset quality -j "$(nproc)") >&2
program=$root/build/quality/benchmarks/quality/freqsynth_quality

mkdir -p "$out/parts"
"$program" --list >"$out/list.txt"
sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -1 >"$out/machine.txt" || true
mapfile -t all < <(awk '/^Methods:/ { exit } /^  [^:]*$/ { print $1 }' "$out/list.txt")
scenes=("$@")
if [[ ${#scenes[@]} -eq 0 ]]; then
  scenes=("${all[@]}")
fi
part_of() { printf '%s' "$out/parts/${1//[^A-Za-z0-9.-]/_}"; }
for scene in "${scenes[@]}"; do
  echo "$scene" >&2
  part=$(part_of "$scene")
  run=("$program" --scenes "$scene" "${settings[@]}" --cache "$out/references")
  "${run[@]}" --spp "$rates" --pictures "$out/pictures" --csv "$part.csv"
  "${run[@]}" --spp "$more_rates" --csv "$part.more.csv" \
    --methods freqsynth,freqsynth-plain,jittered-box,rotated-grid,sobol-box,nlm,nfor
  "${run[@]}" --spp "$most_rates" --methods jittered-box,rotated-grid --csv "$part.most.csv"
done
# All parts that there are, in the order of the list, under one line of names.
files=()
for scene in "${all[@]}"; do
  for part in "" .more .most; do files+=("$(part_of "$scene")$part.csv"); done
done
for file in "$out"/parts/*.csv; do
  [[ " ${files[*]} " == *" $file "* ]] || files+=("$file")
done
for file in "${files[@]}"; do
  [[ ! -e $file ]] || cat "$file"
done | awk 'NR == 1 || !/^scene,method,/' >"$out/results.unfinished"
mv "$out/results.unfinished" "$out/results.csv"
echo "The results are in $out/results.csv, the pictures in $out/pictures."
