#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Prints what the engine costs a renderer on Embree and what it is worth: its share of the time at
# 1920 x 1080, and errors at equal seconds against the renderer's own samplers. CPU times; about ten
# minutes of them. On Debian, installs what is missing.
#   benchmarks/embree/run.sh
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libbenchmark-dev \
  libjpeg62-turbo-dev libopenimageio-dev libembree-dev libtinyobjloader-dev libtbb-dev
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset quality &&
  cmake --build --preset quality -j "$(nproc)" --target freqsynth_embree_benchmark) >&2
measure=$root/build/quality/benchmarks/embree/freqsynth_embree_benchmark
"$measure" --measure share
for paths in 1 8; do
  printf '\n%s paths a sample:\n\n' "$paths"
  "$measure" --measure errors --light-samples "$paths" --reference $((paths == 1 ? 1024 : 256))
done
