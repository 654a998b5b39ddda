#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses freqsynth_tune as a newcomer does, and as a careless one does.
#   freqsynth_tune_test.sh PROGRAM FOLDER
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../programs/expect_failure.sh"
program=$(realpath "$1")
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

# What is said on a wrong command line: the option, its value, what there is.
expect_failure 2 "usage: freqsynth_tune" --no-such-option
expect_failure 2 "--size 0" --size 0
expect_failure 2 "--size 5000" --size 5000
expect_failure 2 "--reference 15" --reference 15
expect_failure 2 "--parameters cheese: not one of samples_per_term" --parameters slack,cheese

"$program" --help | grep -q -- --reference || fail "--help does not tell the options"
# Each parameter has one default among its values; else the program refuses to do anything.
"$program" --list >list
[[ $(wc -l <list) -eq $(grep -c '^[a-z_]*:.* (default)' list) ]] || fail "--list: $(cat list)"

# The default is as good as itself. Which value is better such small pictures cannot tell.
"$program" --size 16 --reference 4 --parameters slack,noisy_doubt >a.md
for row in "slack | 0.4" "noisy_doubt | 1"; do
  grep -qxF "| $row (default) | 1.000 | 1.000 |" a.md || fail "no default '$row': $(cat a.md)"
done
for row in "slack | 0" "slack | off" "noisy_doubt | 4"; do
  grep -q "^| $row | [0-9]*\.[0-9]* | [0-9]*\.[0-9]* |$" a.md || fail "no row '$row': $(cat a.md)"
done
! grep -q "^| wave" a.md || fail "a parameter that was not wanted: $(cat a.md)"

# The same on every run, and whatever else is measured.
"$program" --size 16 --reference 4 --parameters slack >b.md
cmp <(grep "^| slack" a.md) <(grep "^| slack" b.md) || fail "the figures differ between two runs"
