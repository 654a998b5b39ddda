#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures files made straight from samples against files made of pixels, and what a synthesis to a
# quality costs and gives; writes docs/jpeg_results.md. On Debian, installs what is missing.
#   benchmarks/quality/jpeg.sh     fan, chess and two photographs: about ten minutes
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libbenchmark-dev \
  libjpeg62-turbo-dev libopenimageio-dev openimageio-tools
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset quality &&
  cmake --build --preset quality -j "$(nproc)" --target freqsynth_jpeg_quality) >&2
photographs=$root/out/photographs
"$root/examples/photographs.sh" "$photographs" >&2
measured=$("$root/build/quality/benchmarks/quality/freqsynth_jpeg_quality" --size 512 \
  --reference 256 fan chess "image:$photographs/dandelion.png" "image:$photographs/mountains.png")

docs=$root/docs/jpeg_results.md
{
  cat <<'TEXT'
# JPEG files from samples, measured

Written by `benchmarks/quality/jpeg.sh`. Pictures of 512 x 512 pixels, chroma not halved, Huffman
codes made for each file on both ways; references of 256 jittered samples per pixel. Files are read
back by OpenImageIO. PSNR (dB) and SSIM are of display-encoded values, as in
`benchmarks/quality/metrics.h`. Files are in bytes. The photographs are fetched by
`examples/photographs.sh`, which names their authors.

## One sample per pixel, against the scene

*Pixels*: one jittered sample in each pixel, rounded to 8 bits, compressed by libjpeg.
*Coefficients*: the same number of samples, placed by freqsynth, whose fit is quantised by the same
tables. Both average display values, or both average light, and so does the reference that PSNR and
SSIM are against.

TEXT
  printf '%s\n' "${measured%%$'\n\n'*}"
  cat <<'TEXT'

## No number of samples given

`SynthesisSettings::quantization` ends the synthesis by itself. *Converged* is the file that libjpeg
makes of the reference; PSNR and SSIM are against what is decoded from it. *Unweighted*: as many
samples, chosen by the ordinary priority, which knows nothing of the tables. The last two columns
are PSNR against the reference itself: what the quantiser alone loses, and what ours loses with it.

TEXT
  printf '%s\n' "${measured#*$'\n\n'}"
} >"$docs.unfinished"
mv "$docs.unfinished" "$docs"
echo "The tables are in $docs."
