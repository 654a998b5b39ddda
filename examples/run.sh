#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the examples in build/examples. On Debian, installs what they need and is missing.
#   examples/run.sh                        renders the two scenes into out/
#   examples/run.sh ARGUMENTS...           runs freqsynth_render with these arguments
#   examples/run.sh --embree ARGUMENTS...  runs freqsynth_embree; without arguments, into out/
#   examples/run.sh --mpi [RANKS [ARGUMENTS...]]  runs freqsynth_mpi on so many ranks of this
#                                   machine, one more than it has cores: one of them only leads
#   examples/run.sh --live ARGUMENTS...  runs freqsynth_live, a picture that grows in the browser;
#                                   without arguments, chess, which stores into out/ at its end
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

packages=(cmake g++ ninja-build pkg-config libjpeg62-turbo-dev libopenimageio-dev)
program=freqsynth_render
case ${1-} in
  --embree)
    program=embree/freqsynth_embree
    packages+=(libembree-dev libtinyobjloader-dev libtbb-dev)
    shift
    ;;
  --mpi)
    program=freqsynth_mpi
    packages+=(libopenmpi-dev openmpi-bin)
    shift
    ;;
  --live)
    program=live/freqsynth_live
    packages+=(libcpp-httplib-dev nlohmann-json3-dev)
    shift
    ;;
esac
"$root/.ci/install_missing" "${packages[@]}"
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset examples && cmake --build build/examples -j "$(nproc)") >&2

out=$root/out
name=${program##*/}
program=$root/build/examples/examples/$program
if [[ ! -x $program ]]; then
  echo "$name was not built: CMake says above what is missing" >&2
  exit 1
fi
mkdir -p "$out"
if [[ $name == freqsynth_mpi ]]; then
  ranks=${1:-$(($(nproc) + 1))}
  shift || true
  if [[ $# -eq 0 ]]; then
    set -- --scene chess --size 1024x1024 --spp 2 -o "$out/chess_mpi.exr"
  fi
  # Containers have no other user than root, and ranks may be more than cores.
  if [[ $EUID -eq 0 ]]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  fi
  exec mpirun --oversubscribe -n "$ranks" "$program" "$@"
fi
if [[ $# -gt 0 ]]; then
  exec "$program" "$@"
fi
if [[ $name == freqsynth_embree ]]; then
  for picture in embree.exr embree.png; do
    "$program" -o "$out/$picture"
  done
  exit
fi
if [[ $name == freqsynth_live ]]; then
  exec "$program" -o "$out/live"
fi
for scene in fan chess; do
  mkdir -p "$out/${scene}_frames"
  "$program" --scene "$scene" --size 512x512 --spp 2 \
    --frames "$out/${scene}_frames" --density "$out/${scene}_density.png" \
    --stats "$out/$scene.json" -o "$out/$scene.exr"
done
echo "The pictures are in $out: fan.exr and chess.exr; *_frames/ show how they came to be,"
echo "*_density.png where the samples went, *.json the figures."
