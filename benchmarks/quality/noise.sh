#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Prints how freqsynth and denoisers behind Sobol points compare on the noisy scenes, at 1, 4 and 16
# samples per pixel. Pictures side by side are in out/noise. The first run makes references, which
# take minutes; later ones take one. On Debian, installs what is missing.
#   benchmarks/quality/noise.sh [OPTIONS]     options of freqsynth_quality
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libbenchmark-dev \
  libjpeg62-turbo-dev libopenimageio-dev
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset quality &&
  cmake --build --preset quality -j "$(nproc)" --target freqsynth_quality) >&2
exec "$root/build/quality/benchmarks/quality/freqsynth_quality" --noisy --seeds 3 \
  --cache "$root/out/quality/references" --pictures "$root/out/noise" "$@"
