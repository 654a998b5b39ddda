#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Programs that have an option in common say the same of it: in the help, and when its value is wrong.
#   shared_options_test.sh FOLDER PROGRAM...
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/expect_failure.sh"
folder=$1
shift
programs=()
for program in "$@"; do programs+=("$(realpath "$program")"); done
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
for program in "${programs[@]}"; do "$program" --help >"${program##*/}.help"; done

# help_of OPTION PROGRAM
help_of() {
  awk -v option="$1" '
    $1 == option { found = 1; print; next }
    found && !/^ {9}/ { exit }
    found { print }' "${2##*/}.help" | tr -s ' \n' ' '
}

for case in "--size 3" "--spp -1" "--wave 0" "--seed -1" "--frame x" "--threads 1025" \
  "--sampler halton" "--checkpoint-every 7" "-o -" "--stats -" "--checkpoint -" "--resume -"; do
  read -r option value <<<"$case"
  first=''
  for program in "${programs[@]}"; do
    # Without what holds where it is not given, and without other channels: these may differ.
    described=$(help_of "$option" "$program" | sed -E 's/; EXR has.*//; s/ \((all|[0-9][^()]*)\) *$//; s/ *$//')
    [[ -n $described ]] || continue
    said=''
    if [[ $value != - ]]; then # the others may have any value
      ! "$program" "$option" "$value" -o a.exr >said 2>&1 || fail "${program##*/} takes $case"
      said=$(head -n 1 said | sed 's/^[a-z_]*: //')
      [[ $said == "$option"* ]] || fail "${program##*/} $case: says '$said'"
    fi
    if [[ -z $first ]]; then
      first=${program##*/} says=$said describes=$described
    fi
    [[ $said == "$says" ]] || fail "$case: $first says '$says', ${program##*/} '$said'"
    [[ $described == "$describes" ]] ||
      fail "$option: of $first '$describes', of ${program##*/} '$described'"
  done
  [[ -n $first ]] || fail "no program has $option"
done
echo "shared options: all as expected"
