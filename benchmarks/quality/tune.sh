#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures what each free parameter of the method does to the error and writes docs/tuning.md. What
# stands there below the line <!-- conclusions --> is kept. On Debian, installs what is missing.
#   benchmarks/quality/tune.sh [OPTIONS]     options of freqsynth_tune; none: a few minutes
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

"$root/.ci/install_missing" cmake g++ ninja-build pkg-config libbenchmark-dev \
  libjpeg62-turbo-dev libopenimageio-dev
if command -v ninja >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi
(cd "$root" && cmake --preset quality &&
  cmake --build --preset quality -j "$(nproc)" --target freqsynth_tune) >&2
program=$root/build/quality/benchmarks/quality/freqsynth_tune

for option in "$@"; do
  if [[ $option == --help || $option == --list ]]; then
    exec "$program" "$@"
  fi
done
docs=$root/docs/tuning.md
marker='<!-- conclusions -->'
# Told before the work, not after it.
if [[ -e $docs ]] && ! grep -qxF -- "$marker" "$docs"; then
  echo "tune.sh: $docs: no line $marker, below which to keep the text" >&2
  exit 1
fi
measured=$("$program" "$@")
command="benchmarks/quality/tune.sh${*:+ $*}"
{
  cat <<TEXT
# The free parameters

This file is written by

    $command

which needs nothing but this repository on a Debian system. The figures are the same on every run.

## What is measured

One parameter at a time is moved away from its default; all others keep theirs. The parameters are
fields of \`SynthesisSettings\` and of \`InverseListSettings\`, \`PrioritySettings\`,
\`FinishSettings\` and \`ButterworthSettings\`, where the headers explain them. The picture is
looked at after 1/4, 1 and 4 samples per pixel, and its RMSE of linear values is divided by that
with the defaults. A figure is the geometric mean of these quotients over the scenes of a half and
the three rates: below 1 the value is better than the default, above 1 it is worse.

The first half of the scenes is there to choose by, the second to check the choice with scenes that
had no part in it: a value that is better in the first half alone fits those scenes, not the method.

${measured%%$'\n\n'*}

How to read the rows:

* \`seed\` is no parameter but other positions, and in noisy scenes other noise: what chance alone
  does. A difference no greater than that between its rows says nothing.
* \`weight\` acts on the priority by change, so that its rows are with that measure and relative to
  its default.
* \`wave\` is the number of blocks sampled between two choices, one or a share of all; 1/32 is what
  0 stands for.
* \`doubt\`, \`shrinkage\` and \`slack\` are measured on the scenes without noise. Noisy scenes
  (\`softshadow\` and \`glossy\` in the first half, \`dof\` alone in the second) have defaults of
  their own: the rows \`noisy_...\`.

What this does not tell: what parameters do together, at other rates, or to other measures than
RMSE. The mean hides that a value may help some scenes and harm others, and a single scene with a
large change may carry it. References have errors of their own, which pull figures towards 1 where
the pictures are best.

## Figures

${measured#*$'\n\n'}

$marker
TEXT
  if [[ -e $docs ]]; then
    sed "0,/^$marker\$/d" "$docs"
  fi
} >"$docs.unfinished"
mv "$docs.unfinished" "$docs"
echo "$docs is written."
