#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds and runs the library with other compilers, standard libraries and processors, in
# build/portability. On Debian, installs what is missing. Not part of tests/run.sh: it takes longer.
#   tests/portability/run.sh [PART]...    without arguments all of:
#     gcc      unit tests with g++ and libstdc++
#     clang    unit tests with clang++ and libstdc++
#     libc++   unit tests with clang++ and libc++
#     aarch64  results on record, cross-compiled and run by qemu, compiled and header-only
#     mingw    the same programs for Windows, compiled and linked; run where Wine is installed. The
#              component for JPEG files is compiled only
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$root/build/portability
record=$root/tests/recorded/recorded_results.cpp
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi

need() { "$root/.ci/install_missing" cmake ninja-build "$@"; }

# unit_tests NAME [OPTIONS of cmake]
unit_tests() {
  local folder=$build/$1
  shift
  (cd "$root" && cmake --preset tests -B "$folder" \
    -DFREQSYNTH_BUILD_EXAMPLES=OFF -DFREQSYNTH_BUILD_BENCHMARKS=OFF "$@")
  cmake --build "$folder" -j "$(nproc)"
  ctest --test-dir "$folder" --output-on-failure -j "$(nproc)" --no-tests=error -L unit
}

# results_on_record NAME COMPILER SUFFIX LAUNCHER [OPTIONS of cmake]: builds the library, and with
# and without it the program that compares results with those on record; runs both.
results_on_record() {
  local folder=$build/$1 compiler=$2 suffix=$3 launcher=$4
  shift 4
  (cd "$root" && cmake --preset library -B "$folder" "-DCMAKE_CXX_COMPILER=$compiler" \
    -DFREQSYNTH_WARNINGS_AS_ERRORS=ON -DFREQSYNTH_JPEG=OFF "$@")
  cmake --build "$folder" -j "$(nproc)"
  # Contraction to fused multiply-add would change bits where the processor has that instruction.
  local flags=(-std=c++20 -O2 -static -ffp-contract=off -Wall -Wextra -Wpedantic -Werror
    "-I$root/include")
  "$compiler" "${flags[@]}" "$record" "$folder/libfreqsynth.a" -o "$folder/compiled$suffix"
  "$compiler" "${flags[@]}" -DFREQSYNTH_HEADER_ONLY "$record" -o "$folder/header_only$suffix"
  for mode in compiled header_only; do
    if [[ $launcher == none ]]; then
      echo "$folder/$mode$suffix: linked, not run"
    else
      echo "$mode:"
      $launcher "$folder/$mode$suffix"
    fi
  done
}

part_gcc() {
  need g++ libgtest-dev libgmock-dev libjpeg62-turbo-dev
  unit_tests gcc -DCMAKE_CXX_COMPILER=g++
}

part_clang() {
  need clang libgtest-dev libgmock-dev libjpeg62-turbo-dev
  unit_tests clang -DCMAKE_CXX_COMPILER=clang++
}

part_libcxx() {
  need clang libc++-dev libc++abi-dev googletest libjpeg62-turbo-dev
  # Debian's GoogleTest is made for libstdc++.
  local options=(-DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS=-stdlib=libc++)
  cmake -S /usr/src/googletest -B "$build/googletest" -DCMAKE_BUILD_TYPE=Release \
    "${options[@]}" "-DCMAKE_INSTALL_PREFIX=$build/googletest/prefix"
  cmake --build "$build/googletest" -j "$(nproc)" --target install
  unit_tests libc++ "${options[@]}" "-DGTest_ROOT=$build/googletest/prefix"
}

part_aarch64() {
  need g++-aarch64-linux-gnu qemu-user
  results_on_record aarch64 aarch64-linux-gnu-g++ "" qemu-aarch64 \
    -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64
}

part_mingw() {
  need g++-mingw-w64-x86-64-posix libjpeg62-turbo-dev
  # Debian has no libjpeg for Windows, but its headers are enough to compile the component.
  mkdir -p "$build/mingw/jpeg_headers"
  for header in jpeglib.h jmorecfg.h jerror.h jconfig.h; do
    cp "$(find /usr/include -name "$header" | head -n 1)" "$build/mingw/jpeg_headers"
  done
  for source in jpeg jpeg_file; do
    x86_64-w64-mingw32-g++-posix -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror \
      "-I$root/include" "-I$root/src" -isystem "$build/mingw/jpeg_headers" \
      "$root/src/jpeg/$source.cpp"
  done
  local launcher=none
  if command -v wine >/dev/null; then launcher=wine; fi
  results_on_record mingw x86_64-w64-mingw32-g++-posix .exe "$launcher" -DCMAKE_SYSTEM_NAME=Windows
}

parts=("$@")
if [[ ${#parts[@]} -eq 0 ]]; then parts=(gcc clang libc++ aarch64 mingw); fi
for part in "${parts[@]}"; do
  if ! declare -F "part_${part//+/x}" >/dev/null; then
    echo "unknown part $part; see $0" >&2
    exit 2
  fi
done
for part in "${parts[@]}"; do
  echo "== $part"
  "part_${part//+/x}"
done
echo "Good: ${parts[*]}"
