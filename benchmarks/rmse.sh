#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Root mean square error of linear values against 256 jittered samples per pixel, for the paper's scenes at
# 512 x 512. On Debian, installs what is missing.
#   benchmarks/rmse.sh [SCENE...]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/.ci/install_missing" openimageio-tools

out=$root/out/rmse
mkdir -p "$out"
render() { "$root/examples/run.sh" --size 512x512 "$@" 2>/dev/null; }
# idiff calls any difference a failure.
error() { { idiff "$1" "$2" || true; } | sed -n "s/^ *RMS error = //p"; }

printf '%-10s %8s %12s %12s %8s\n' scene spp jittered freqsynth ratio
for scene in "${@:-fan chess}"; do
  for name in $scene; do
    render --scene "$name" --reference 256 --seed 1 -o "$out/reference.exr"
    for spp in 1 2 4; do
      render --scene "$name" --reference $spp --seed 2 -o "$out/jittered.exr"
      render --scene "$name" --spp $spp -o "$out/ours.exr"
      jittered=$(error "$out/reference.exr" "$out/jittered.exr")
      ours=$(error "$out/reference.exr" "$out/ours.exr")
      awk -v name="$name" -v spp="$spp" -v j="$jittered" -v o="$ours" \
        'BEGIN { printf "%-10s %8s %12.5f %12.5f %8.3f\n", name, spp, j, o, o / j }'
    done
  done
done
