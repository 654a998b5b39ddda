#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What #include "freqsynth/freqsynth.h" costs: preprocessed lines that are not blank, and CPU
# seconds (median of 5) to check a file that has nothing else and to compile it with -O2; compiled mode and
# header-only.
#   tests/portability/compile_cost.sh [COMPILER]                    prints a table
#   tests/portability/compile_cost.sh --at-most LINES [COMPILER]    fails when the compiled mode has more
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

most=
if [[ ${1:-} == --at-most ]]; then
  most=$2
  shift 2
fi
compiler=${1:-g++}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
echo '#include "freqsynth/freqsynth.h"' >"$scratch/user.cpp"
compile() { "$compiler" -std=c++20 "-I$root/include" "$scratch/user.cpp" "$@"; }
lines() { compile -E "$@" | grep -c '[^[:space:]]'; }

if [[ -n $most ]]; then
  count=$(lines)
  echo "$count preprocessed lines, at most $most are allowed"
  [[ $count -le $most ]]
  exit
fi

median_seconds() {
  local TIMEFORMAT=%U
  for _ in 1 2 3 4 5; do
    { time compile "$@" -o "$scratch/user.o"; } 2>&1
  done | sort -g | sed -n 3p
}

printf '%-12s %8s %15s %10s\n' mode lines -fsyntax-only '-O2 -c'
for mode in compiled header-only; do
  flags=()
  if [[ $mode == header-only ]]; then flags=(-DFREQSYNTH_HEADER_ONLY); fi
  printf '%-12s %8d %13s s %8s s\n' "$mode" "$(lines "${flags[@]}")" \
    "$(median_seconds -fsyntax-only "${flags[@]}")" "$(median_seconds -O2 -c "${flags[@]}")"
done
