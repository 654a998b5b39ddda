#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of embree.md: about four minutes of CPU time, on all cores. On Debian, installs
# what is missing.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/.ci/install_missing" openimageio-tools

out=$root/out/embree
mkdir -p "$out"
render() { "$root/examples/run.sh" --embree "$@"; }
render --spp 4 -o "$out/picture.exr"
shown=(--ch R,G,B --colorconvert linear sRGB)
small=(--resize:filter=box 240x135 --ch 0,0,0 --chnames R,G,B)
colours=(--resize:filter=box 240x135 --chnames R,G,B)
# The light, and below it colour, normal, the sun and depth.
oiiotool "$out/picture.exr" "${shown[@]}" -o "$out/light.png"
oiiotool "$out/picture.exr" --ch albedo.R,albedo.G,albedo.B "${colours[@]}" \
  --colorconvert linear sRGB \
  "$out/picture.exr" --ch normal.X,normal.Y,normal.Z --mulc 0.5 --addc 0.5 "${colours[@]}" \
  "$out/picture.exr" --ch sun "${small[@]}" \
  "$out/picture.exr" --ch Z --powc -1 --mulc 6 "${small[@]}" \
  --mosaic 4x1 -o "$out/channels.png"
oiiotool "$out/channels.png" "$out/light.png" --create 960x675 3 --paste +0+0 --paste +0+540 \
  --compression jpeg:88 -o "$root/docs/embree.jpg"

# Pieces: as much time with Sobol points, freqsynth, and the truth.
render --spp 8 --sampler sobol -o "$out/sobol.exr"
render --spp 2 -o "$out/two.exr"
render --spp 256 --sampler sobol -o "$out/truth.exr"
for piece in 320x180+330+190 320x180+60+310; do
  oiiotool "$out/sobol.exr" "${shown[@]}" --cut $piece "$out/two.exr" "${shown[@]}" --cut $piece \
    "$out/truth.exr" "${shown[@]}" --cut $piece --mosaic:pad=6 3x1 -o "$out/piece_$piece.png"
done
oiiotool "$out/piece_320x180+330+190.png" "$out/piece_320x180+60+310.png" --mosaic:pad=6 1x2 \
  --compression jpeg:88 -o "$root/docs/embree_pieces.jpg"
