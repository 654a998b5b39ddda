#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the examples in build/examples. On Debian, installs what they need and is missing.
#   examples/run.sh                 renders the two scenes into out/
#   examples/run.sh ARGUMENTS...    runs freqsynth_render with these arguments
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libjpeg62-turbo-dev \
  libopenimageio-dev
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset examples && cmake --build build/examples -j "$(nproc)") >&2

render=$root/build/examples/examples/freqsynth_render
if [[ $# -gt 0 ]]; then
  exec "$render" "$@"
fi

out=$root/out
for scene in fan chess; do
  mkdir -p "$out/${scene}_frames"
  "$render" --scene "$scene" --size 512x512 --spp 2 \
    --frames "$out/${scene}_frames" --density "$out/${scene}_density.png" \
    --stats "$out/$scene.json" -o "$out/$scene.exr"
done
echo "The pictures are in $out: fan.exr and chess.exr; *_frames/ show how they came to be,"
echo "*_density.png where the samples went, *.json the figures."
