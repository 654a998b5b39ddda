#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of this folder. On Debian, installs what is missing.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/.ci/install_missing" openimageio-tools

out=$root/out/docs
mkdir -p "$out"
render() { "$root/examples/run.sh" --size 512x512 "$@"; }
for scene in fan chess; do
  render --scene "$scene" --spp 1 -o "$out/$scene.png" --density "$out/${scene}_density.png" \
    --frames "$out/${scene}_frames"
  render --scene "$scene" --reference 1 -o "$out/${scene}_jittered.png"
  # Jittered samples, freqsynth, and where freqsynth took its samples, side by side.
  oiiotool "$out/${scene}_jittered.png" "$out/$scene.png" \
    "$out/${scene}_density.png" --ch 0,0,0 --chnames R,G,B \
    --mosaic:pad=8 3x1 --compression jpeg:90 -o "$root/docs/$scene.jpg"
  oiiotool "$out/${scene}_frames/contact_sheet.png" --resize 1044x0 --compression jpeg:90 \
    -o "$root/docs/${scene}_frames.jpg"
done

# Pieces of a larger chess board, pixel for pixel: a few men and a corner of the board. Jittered
# samples, freqsynth with as many, and 256 times as many jittered ones as the truth.
large() { "$root/examples/run.sh" --scene chess --size 1024x1024 "$@"; }
large --reference 1 -o "$out/large_jittered.png"
large --spp 1 -o "$out/large.png"
large --reference 256 -o "$out/large_truth.png"
for piece in 264x176+610+570 264x176+720+680; do
  oiiotool "$out/large_jittered.png" --cut $piece "$out/large.png" --cut $piece \
    "$out/large_truth.png" --cut $piece --mosaic:pad=8 3x1 -o "$out/piece_$piece.png"
done
oiiotool "$out/piece_264x176+610+570.png" "$out/piece_264x176+720+680.png" --mosaic:pad=8 1x2 \
  --compression jpeg:92 -o "$root/docs/chess_pieces.jpg"

# The same samples averaged as display values and as light.
for average in display light; do
  "$root/examples/run.sh" --scene fan --size 128x128 --spp 16 --direct --quality 95 \
    --average $average -o "$out/average_$average.jpg"
done
oiiotool "$out/average_display.jpg" --resize:filter=box 512x512 \
  "$out/average_light.jpg" --resize:filter=box 512x512 \
  --mosaic:pad=8 2x1 --compression jpeg:90 -o "$root/docs/averaging.jpg"
