#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Kills freqsynth_render at random moments (SIGKILL), goes on from its checkpoint each time, and
# compares the picture with that of a run that nobody disturbed.
#   freqsynth_render_kill_test.sh PROGRAM FOLDER [KILLS]
set -euo pipefail
program=$(realpath "$1")
folder=$2
kills=${3:-6}
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

fail() {
  echo "failed: $*" >&2
  exit 1
}

arguments=(--scene chess --size 320x240 --spp 6 --threads 2)
begin=$(date +%s%N)
"$program" "${arguments[@]}" -o whole.pfm
milliseconds=$((($(date +%s%N) - begin) / 1000000 + 1))

# run: goes on in the background, from what there is.
run() {
  local resume=()
  if [[ -e state ]]; then resume=(--resume state); fi
  "$program" "${arguments[@]}" --checkpoint state --checkpoint-every 0.01 "${resume[@]}" \
    -o resumed.pfm 2>said &
  process=$!
}

killed=0
resumed=0
attempts=0
while [[ $killed -lt $kills ]]; do
  attempts=$((attempts + 1))
  [[ $attempts -le $((20 * kills)) ]] || fail "only $killed of $kills runs were killed"
  if [[ -e state ]]; then resumed=$((resumed + 1)); fi
  run
  # Anywhere from the first moment to about the end.
  delay=$((RANDOM * RANDOM % milliseconds))
  sleep "$(printf '%d.%03d' $((delay / 1000)) $((delay % 1000)))"
  kill -KILL "$process" 2>/dev/null || true
  status=0
  wait "$process" 2>/dev/null || status=$?
  if [[ $status -eq 137 ]]; then
    killed=$((killed + 1))
    continue
  fi
  # It had come to its end.
  [[ $status -eq 0 ]] || fail "exit code $status: $(cat said)"
  cmp whole.pfm resumed.pfm || fail "the picture is another one after $resumed resumed runs"
  rm -f state resumed.pfm
done
run
wait "$process" || fail "$(cat said)"
cmp whole.pfm resumed.pfm || fail "the picture is another one"
[[ $resumed -gt 0 || $kills -lt 4 ]] || fail "no run was resumed"

# The state of the end is one to take more samples from.
"$program" "${arguments[@]}" --spp 7 --resume state --stats stats -o more.pfm
grep -q '"samples": 537600' stats || fail "more samples: $(cat stats)"

# What is no state of this run is refused, and nothing is written.
expect_refusal() {
  local text=$1 status=0
  shift
  "$program" "${arguments[@]}" "$@" -o refused.pfm >said 2>&1 || status=$?
  [[ $status -eq 1 ]] || fail "exit code $status instead of 1: $*"
  grep -qF -- "$text" said || fail "does not say '$text': $* ($(cat said))"
  [[ ! -e refused.pfm ]] || fail "wrote a picture: $*"
}
expect_refusal "cannot read nowhere: No such file" --resume nowhere
expect_refusal "this is no saved synthesis" --resume whole.pfm
expect_refusal "width was 320, and is 160" --resume state --size 160x120
head -c 1000000 state >cut
expect_refusal "cannot read cut: saved synthesis ends too early" --resume cut
echo "$killed runs killed, $resumed resumed"
