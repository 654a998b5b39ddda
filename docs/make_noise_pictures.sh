#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of noise of this folder from those of benchmarks/quality/noise.sh, which is run
# where they are not there. On Debian, installs what is missing.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/.ci/install_missing" openimageio-tools

for scene in cornell spheres; do
  sheet=$root/out/noise/$scene.png
  [[ -e $sheet ]] || "$root/benchmarks/quality/noise.sh" >/dev/null
  oiiotool "$sheet" --compression jpeg:90 -o "$root/docs/noise_$scene.jpg"
done
