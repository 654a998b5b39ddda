#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Prints what the engine costs a renderer on Embree and what it is worth: its share of the time at
# 1920 x 1080, and errors at equal seconds against the renderer's own samplers. About nine minutes of
# CPU time, most of it on all cores. On Debian, installs what is missing.
#   benchmarks/embree/run.sh [--fix]      --fix: writes the tables of docs/embree.md
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
fix=${1-}
if [[ -n $fix && $fix != --fix ]]; then
  echo "usage: benchmarks/embree/run.sh [--fix]" >&2
  exit 2
fi

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libbenchmark-dev \
  libjpeg62-turbo-dev libopenimageio-dev libembree-dev libtinyobjloader-dev libtbb-dev
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset quality &&
  cmake --build --preset quality -j "$(nproc)" --target freqsynth_embree_benchmark) >&2
measure=$root/build/quality/benchmarks/embree/freqsynth_embree_benchmark

# put NAME: shows a table, and with --fix writes it
put() {
  local table
  table=$(cat)
  printf '%s\n\n' "$table"
  if [[ -n $fix ]]; then "$root/docs/put_table.sh" "$root/docs/embree.md" "$1" <<<"$table"; fi
}

{
  echo "On $(nproc) cores, load $(cut -d' ' -f1 /proc/loadavg):"
  echo
  "$measure" --measure share
} | put "shares of the time"
"$measure" --measure errors --light-samples 1 --reference 1024 | put "errors with one path"
"$measure" --measure errors --light-samples 8 --reference 256 | put "errors with eight paths"
