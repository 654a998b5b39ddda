#!/usr/bin/env bash
# Builds and runs the tests in build/. On Debian, installs what they need and is missing.
#   tests/run.sh [--sanitize] [--clang] [arguments of ctest]
#     --sanitize  the unit tests only, with AddressSanitizer and UndefinedBehaviorSanitizer
#     --clang     with clang++
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

sanitize=
clang=
while [[ $# -gt 0 ]]; do
  case $1 in
    --sanitize) sanitize=1 ;;
    --clang) clang=1 ;;
    *) break ;;
  esac
  shift
done

packages=(cmake g++ ninja-build libgtest-dev libgmock-dev libjpeg62-turbo-dev)
if [[ -z $sanitize ]]; then
  packages+=(clang-format libbenchmark-dev libeigen3-dev libfftw3-dev libopenblas-dev
    libjpeg-turbo-progs libopenimageio-dev pkg-config)
fi
if [[ -n $clang ]]; then
  packages+=(clang)
fi
"$root/.ci/install_missing" "${packages[@]}"

case $sanitize/$clang in
  /) preset=tests ;;
  /1) preset=clang ;;
  1/) preset=sanitize ;;
  1/1) preset=sanitize-clang ;;
esac
targets=(all)
selection=()
if [[ -n $sanitize ]]; then
  selection=(-L unit)
else
  # Otherwise the test that each header compiles alone would build them, one by one.
  targets+=(all_verify_interface_header_sets)
fi
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi

cd "$root"
cmake --preset "$preset"
cmake --build "build/$preset" -j "$(nproc)" --target "${targets[@]}"
exec ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" --no-label-summary \
  --no-tests=error "${selection[@]}" "$@"
