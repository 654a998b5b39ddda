#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The tables of the report for results whose answer is known.
#   report_test.sh REPORT.AWK FOLDER
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../programs/expect_failure.sh"
report=$(realpath "$1")
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

# line SCENE METHOD SPP RMSE PSNR RELATIVE_MSE SSIM WORST MISSED REFERENCE_ERROR [RELMSE]
line() { echo "$1,$2,$3,128,128,1,16384,$4,0,$5,$6,$7,$8,$9,1,0,256,${10},${11:-0},0.9,1.25,0.125,0.01638400,0.03276800"; }
{
  echo "scene,method,spp,and so on"
  # The yardstick: error 0.1 / sqrt(spp), so that an error e needs (0.1 / e)^2 samples per pixel.
  line fan jittered-box 0.25 0.2 14 0.04 0.80 0.5 0 0.0001
  line fan jittered-box 1 0.1 20 0.02 0.85 0.4 0 0.0001
  line fan jittered-box 4 0.05 26 0.01 0.90 0.3 0 0.0001
  line fan jittered-box 64 0.0125 38 0.001 0.99 0.1 0 0.0001
  # A fixed pattern needs (0.08 / e)^2 at up to 4 samples per pixel.
  line fan rotated-grid 1 0.08 22 0.02 0.85 0.4 0 0.0001
  line fan rotated-grid 4 0.04 28 0.01 0.90 0.3 0 0.0001
  line fan rotated-grid 64 0.01 40 0.001 0.99 0.1 0 0.0001
  line fan freqsynth 0.25 0.0707106781 23 0.04 0.85 0.45 2 0.0001
  line fan freqsynth 1 0.025 32 0.04 0.9 0.3 0 0.01
  line fan freqsynth 4 0.01 40 0.005 0.95 0.2 0 0.0001
  line fan freqsynth-paper 1 0.00001 99 0.000001 0.9999 0.0001 0 0.0001
  line fan other 0.25 0.3 10 0.09 0.7 0.6 0 0.0001
  line fan other 1 0.05 26 0.01 0.95 0.35 0 0.0001
  line fan other 4 0.008 42 0.009 0.93 0.19 0 0.0001
  line sun jittered-box 1 5 10 1 0.5 9 0 0.0001
  line sun freqsynth 1 7 10 1 0.5 9 0 0.0001
} >results.csv
part() { awk -v part="$1" -v sheets="${2:-}" -f "$report" results.csv >"$1"; }
has() { grep -qxF -- "$2" "$1" || fail "$1 has no line '$2': $(cat "$1")"; }

part headline
has headline '| fan | 1/4 | 0.0707 | 2 | 8 | jittered-box | 0.35 |'
has headline '| fan | 1 | 0.025 (*) | 16 | 16 | other | 0.50 |'
has headline '| fan | 4 | 0.01 | >64 | >16 | other | 1.25 |'
has headline '| sun | 1 | 7 | <1 | <1 | jittered-box | 1.40 |'
has headline '* At 1/4 sample per pixel: the least RMSE of all systems in 1 of 1 scenes;'
has headline '* At 1 sample per pixel: the least RMSE of all systems in 1 of 2 scenes;'
# sqrt(0.5 * 1.4); the median of 16 and 1.
has headline '  0.84 times that of the best other system (geometric mean over the scenes);'
has headline '  the jittered box needs 8 times as many samples (median; bounds count as they are).'
# (0.08 / 0.025)^2 and (0.08 / 0.01)^2 / 4, where it is known; nothing is told where it is not.
has headline '  the jittered box needs 8.5 times as many samples (median; bounds count as they are);'
has headline '  the rotated grid, the same in each pixel, needs 10.2 times as many.'
has headline '  the rotated grid, the same in each pixel, needs 16 times as many.'
has headline '  times that of the jittered box (sun at 1 sample per pixel).'

part losses
has losses '| fan | RMSE | | | | 1.25 | other |'
has losses '| fan | PSNR | | | | 1.26 | other |'                     # 2 dB
has losses '| fan | relative MSE | | | 2.00 | | other |'             # the root of 4
has losses '| fan | SSIM | | | 2.00 | | other |'                     # 0.1 and 0.05
has losses '| fan | worst block | | | | 1.05 | other |'
has losses '| sun | RMSE | | | 1.40 | | jittered-box |'
! grep -q '^| sun | PSNR' losses || fail "an equal error is a loss"
has losses '* fan at 1/4 sample per pixel: 2'

part best
has best $'fan\tfan\tother'
printf 'fan\tfan.jpg\n' >sheets
part scenes sheets
has scenes '![fan](quality/fan.jpg)'
has scenes '*From the left: freqsynth, jittered-box, other, reference.*'
has scenes '| other | 0.05 | 0 | 26 | 0.01 | 0.9500 | 0.35 | 0 | 1 | 1.00 |'
has scenes 'The reference is off by 0.01; a call of the scene takes 2.00 us.'

# Only what a denoiser has made as well, at the rates that are shown.
{
  line lens freqsynth 1 0.05 10 1 0.5 9 0 0.03 0.006
  line lens nlm 1 0.02 10 1 0.75 9 0 0.03 0.004
  line lens freqsynth 2 0.05 10 1 0.5 9 0 0.03 0.006
} >>results.csv
part noise
has noise '| lens | 1 | freqsynth | 0.04 | 0.006 | 0.5000 | 0.900 | 1.25 | 0.12 |'
has noise '| lens | 1 | nlm | 0 | 0.004 | 0.7500 | 0.900 | 1.25 | 0.12 |'
[[ $(wc -l <noise) -eq 4 ]] || fail "noise has other lines: $(cat noise)"
