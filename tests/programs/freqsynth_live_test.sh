#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Starts and ends freqsynth_live, and uses it wrongly. What it serves is tested by tests/live.
#   freqsynth_live_test.sh PROGRAM FOLDER
set -euo pipefail
script=$(realpath "${BASH_SOURCE[0]}")
source "$(dirname "$script")/expect_failure.sh"
program=$(realpath "$1")
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

# A reader can copy the glue: the documents say how long it is.
root=$(cd "$(dirname "$script")/../.." && pwd)
lines=$(wc -l <"$root/examples/live/glue.h")
for document in README.md docs/live.md; do
  tr '\n' ' ' <"$root/$document" | grep -q "live/glue.h\`, $lines lines" ||
    fail "$document does not say that glue.h has $lines lines"
done

expect_failure 2 "--scene" --scene none
expect_failure 2 "--size 43" --size 43
expect_failure 2 "--spp 0" --spp 0
expect_failure 2 "--threads 0" --threads 0
expect_failure 2 "--port 65536" --port 65536
expect_failure 2 "-o: is empty" -o ""
expect_failure 2 "--measure: needs --spp" --measure 1
expect_failure 1 "no/folder" -o no/folder/a
expect_failure 1 "none.state" --resume none.state
expect_failure 1 "cannot listen there" --host 192.0.2.1 --port 0
[[ -z $(ls -A | grep -v '^said$') ]] || fail "a refused command left a file"
"$program" --help >said
grep -qF -- "--resume" said || fail "--help says $(cat said)"

# Starts it, waits for a picture to be there, and ends it with a signal.
#   interrupt SIGNAL ARGUMENTS...
interrupt() {
  local signal=$1 process code=0
  shift
  "$program" --size 64x48 --port 0 "$@" >said 2>&1 &
  process=$!
  for ((i = 0; i < 600; ++i)); do
    ! grep -q "^http://127.0.0.1:" said || break
    sleep 0.1
  done
  sleep 1
  kill -"$signal" $process
  wait $process || code=$?
  [[ $code == 0 ]] || fail "$signal: exit code $code, says $(cat said)"
}
for signal in INT TERM; do
  rm -f picture.*
  interrupt $signal -o picture
  for ending in jpg exr state; do
    [[ -s picture.$ending ]] || fail "$signal: no picture.$ending; says $(cat said)"
    grep -qx "picture.$ending" said || fail "$signal: does not say picture.$ending"
  done
done
# Progressive: the marker of such a frame.
[[ $(head -c 2 picture.jpg | od -An -tx1) == " ff d8" ]] || fail "picture.jpg is no JPEG file"
od -An -v -tx1 picture.jpg | tr -d ' \n' | grep -q "ffc2" || fail "picture.jpg is not progressive"

# It goes on from there, and from there only.
interrupt INT --resume picture.state -o resumed
[[ -s resumed.exr ]] || fail "not resumed: $(cat said)"
expect_failure 1 "picture.state" --size 65x48 --port 0 --resume picture.state

# Figures.
"$program" --size 128x128 --scene softshadow --spp 30 --measure 1 >said
[[ $(wc -l <said) == 1 ]] || fail "--measure says $(cat said)"
grep -qE "^\| softshadow \| 128 x 128 (\| [0-9.]+ (s |us |)){7}\|$" said ||
  fail "--measure says $(cat said)"
[[ -z $(find . -mindepth 1 -name '.*') ]] || fail "unfinished files are left"
echo "freqsynth_live: all as expected"
