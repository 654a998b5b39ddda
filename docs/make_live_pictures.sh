#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of live.md: the page as Chromium shows it. On Debian, installs what is missing.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libgtest-dev libjpeg62-turbo-dev \
  libopenimageio-dev libcpp-httplib-dev nlohmann-json3-dev chromium openimageio-tools

out=$root/out/live_pictures
mkdir -p "$out"
export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
(cd "$root" && cmake --preset tests &&
  cmake --build build/tests --target freqsynth_live_pictures) >&2
"$root/build/tests/tests/freqsynth_live_pictures" "$out"
# At its beginning, and with a frame.
oiiotool "$out/early.png" --ch R,G,B "$out/framed.png" --ch R,G,B --mosaic:pad=12 2x1 \
  --resize:filter=lanczos3 1180x0 --compression jpeg:90 -o "$root/docs/live.jpg"
