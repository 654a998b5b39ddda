#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures the field cases, inputs on which adaptive samplers were seen to fail, and tells them in
# docs/field_cases.md, beside the figures of an earlier version in before.txt. On Debian, installs
# what is missing. A minute or two.
#   benchmarks/field_cases/run.sh                  writes docs/field_cases.md
#   benchmarks/field_cases/run.sh --pictures DIR   writes pictures of some cases to look at
# The figures of the version at hand are in out/field_cases/values.txt, in the form of before.txt.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
here=$root/benchmarks/field_cases

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libbenchmark-dev \
  libjpeg62-turbo-dev libopenimageio-dev
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset quality &&
  cmake --build build/quality --target field_cases -j "$(nproc)") >&2
program=$root/build/quality/benchmarks/field_cases/field_cases

if [[ ${1:-} == --pictures ]]; then
  "$program" --pictures "${2:?a folder is missing}"
  echo "The pictures are in $2."
  exit
fi

out=$root/out/field_cases
mkdir -p "$out"
"$program" --before "$here/before.txt" --values "$out/values.txt" >"$out/tables.md"
cat "$here/introduction.md" "$out/tables.md" "$here/programs.md" >"$out/field_cases.md"
mv "$out/field_cases.md" "$root/docs/field_cases.md"
echo "The tables are in docs/field_cases.md."
