#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds and runs the tests in build/. On Debian, installs what they need and is missing.
#   tests/run.sh [--sanitize | --threads] [--clang] [arguments of ctest]
#     --sanitize  the unit tests but the longest, with AddressSanitizer and UndefinedBehaviorSanitizer;
#                 with clang++ also fuzzing of all that is read, 20 s each
#     --threads   the tests with several threads only, with ThreadSanitizer
#     --clang     with clang++
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

preset=tests
clang=
while [[ $# -gt 0 ]]; do
  case $1 in
    --sanitize | --threads)
      if [[ $preset != tests ]]; then
        echo "--sanitize and --threads exclude each other" >&2
        exit 2
      fi
      preset=${1#--}
      ;;
    --clang) clang=1 ;;
    *) break ;;
  esac
  shift
done

packages=(cmake g++ ninja-build libgtest-dev libgmock-dev libjpeg62-turbo-dev)
targets=(all)
selection=()
launcher=()
case $preset in
  tests)
    # clang also for the consumers among the tests.
    packages+=(clang clang-format doxygen libbenchmark-dev libeigen3-dev libfftw3-dev
      libopenblas-dev libjpeg-turbo-progs libopenimageio-dev libopenmpi-dev openmpi-bin
      pkg-config libembree-dev libtinyobjloader-dev libtbb-dev
      libcpp-httplib-dev nlohmann-json3-dev)
    # Otherwise the test that each header compiles alone would build them, one by one.
    targets+=(all_verify_interface_header_sets)
    ;;
  sanitize) selection=(-L unit -LE long) ;;
  threads)
    selection=(-L concurrent)
    # ThreadSanitizer wants memory where it expects it.
    if setarch "$(uname -m)" -R true 2>/dev/null; then
      launcher=(setarch "$(uname -m)" -R)
    fi
    ;;
esac
if [[ -n $clang ]]; then
  packages+=(clang libclang-rt-dev)
  if [[ $preset == tests ]]; then preset=clang; else preset+=-clang; fi
fi
"$root/.ci/install_missing" "${packages[@]}"

if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi

cd "$root"
cmake --preset "$preset"
"${launcher[@]}" cmake --build "build/$preset" -j "$(nproc)" --target "${targets[@]}"
exec "${launcher[@]}" ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" \
  --no-label-summary --no-tests=error "${selection[@]}" "$@"
