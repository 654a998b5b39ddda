#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses freqsynth_render as a newcomer does, and as a careless one does.
#   freqsynth_render_test.sh PROGRAM FOLDER
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/expect_failure.sh"
program=$(realpath "$1")
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

small=(--size 64x48 --scene zoneplate)

# What is said on a wrong command line: the option, its value, a usage line.
expect_failure 2 "usage: freqsynth_render"
expect_failure 2 "usage: freqsynth_render" --no-such-option
expect_failure 2 "--size 64" "${small[@]}" --size 64 -o a.png
expect_failure 2 "--size 0x9" --size 0x9 -o a.png
expect_failure 2 "--spp -1" "${small[@]}" --spp -1 -o a.png
expect_failure 2 "--spp nan" "${small[@]}" --spp nan -o a.png
expect_failure 2 "--spp 1/0" "${small[@]}" --spp 1/0 -o a.png
expect_failure 2 "--terms-every 0.5" "${small[@]}" --terms-every 0.5 -o a.png
expect_failure 2 "--pixel-filter lanczos" "${small[@]}" --pixel-filter lanczos -o a.png
expect_failure 2 "--channels cmyk" "${small[@]}" --channels cmyk -o a.png
expect_failure 2 "--threads 0" "${small[@]}" --threads 0 -o a.png
expect_failure 2 "--checkpoint-every 0" "${small[@]}" --checkpoint a --checkpoint-every 0 -o a.png
expect_failure 2 "--checkpoint-every" "${small[@]}" --checkpoint-every 5 -o a.png
expect_failure 2 "--resume" "${small[@]}" --resume a --reference 4 -o a.png
expect_failure 2 "cheese" --scene cheese -o a.png
[[ ! -e a.png ]] || fail "a refused command wrote a picture"

expect_failure 2 "--quality 0" "${small[@]}" --quality 0 -o a.jpg
expect_failure 2 "--quality 101" "${small[@]}" --direct --quality 101 -o a.jpg
expect_failure 2 "--until-quality best" "${small[@]}" --until-quality best -o a.jpg
expect_failure 2 "--subsampling 422" "${small[@]}" --subsampling 422 -o a.jpg
expect_failure 2 "--average median" "${small[@]}" --average median -o a.jpg
expect_failure 2 "--steer seen: not linear, relative or display" "${small[@]}" --steer seen -o a.png
expect_failure 2 "--steer" "${small[@]}" --steer display --average display -o a.png
expect_failure 2 "--steer" "${small[@]}" --steer relative --until-quality 50 -o a.jpg
expect_failure 2 "--tolerance 0" "${small[@]}" --until-quality 50 --tolerance 0 -o a.jpg
expect_failure 2 "--tolerance" "${small[@]}" --tolerance 1 -o a.jpg
expect_failure 2 "--progressive" "${small[@]}" --progressive -o a.jpg
expect_failure 2 "--average light" "${small[@]}" --until-quality 50 --average light -o a.jpg
for option in "--scale 2" "--frames a" "--reference 4" "--pixel-filter none" "--pixel-filter tent"; do
  # shellcheck disable=SC2086
  expect_failure 2 "--direct" "${small[@]}" --direct $option -o a.jpg
done
[[ ! -e a.jpg ]] || fail "a refused command wrote a picture"

# Files.
expect_failure 1 "nowhere/a.png" "${small[@]}" -o nowhere/a.png
expect_failure 1 "a.nosuchformat" "${small[@]}" -o a.nosuchformat
expect_failure 1 "missing.png" --scene image:missing.png -o a.png
expect_failure 1 "said" "${small[@]}" --frames said
echo "an older picture" >old.png
expect_failure 1 "missing/density.png" "${small[@]}" -o ok.png --density missing/density.png
if [[ -e /dev/full ]]; then
  expect_failure 1 "/dev/full" "${small[@]}" -o ok.png --stats /dev/full
fi

# Where the results go is looked at before the first sample: these runs would take hours.
# expect_refusal TEXT ARGUMENTS...
expect_refusal() {
  local text=$1 status=0
  shift
  timeout 60 "$program" --size 2048x2048 --spp 4096 "$@" >said 2>&1 || status=$?
  [[ $status -ne 124 ]] || fail "renders before it refuses: $*"
  [[ $status -eq 1 ]] || fail "exit code $status instead of 1: $*"
  grep -qF -- "$text" said || fail "does not say '$text': $* ($(cat said))"
}
mkdir -p taken/contact_sheet.png
expect_refusal "nowhere/a.png" -o nowhere/a.png
expect_refusal "said/a.png" -o said/a.png
expect_refusal "a.nosuchformat" -o a.nosuchformat
expect_refusal "taken: is a folder" -o a.png --stats taken
expect_refusal "nowhere/a.json" -o a.png --stats nowhere/a.json
expect_refusal "nowhere/a.png" -o b.png --density nowhere/a.png
expect_refusal "nowhere/a.png" -o b.png --error nowhere/a.png
expect_refusal "a.nosuchformat" -o a.png --density a.nosuchformat
expect_refusal "said" -o a.png --frames said
expect_refusal "taken/contact_sheet.png: is a folder" --frames taken
"$program" "${small[@]}" -o whole.png
"$program" "${small[@]}" -o whole.jpg
"$program" "${small[@]}" -o whole.exr
for picture in whole.png whole.jpg whole.exr; do
  for damage in cut_short huge; do
    "$damage" "$picture" || continue
    expect_refusal "$damage.${picture##*.}: " -o a.png --scene "image:$damage.${picture##*.}"
  done
done
huge whole.jpg
expect_refusal "huge.jpg: says that it has 65500 x 65500 pixels" -o a.png --scene image:huge.jpg
expect_refusal "a.sgi" -o a.sgi --scale 32
expect_refusal "a.webp: 16384 x 16384 pixels" -o a.webp --scale 8
expect_refusal "a.jpg: 65536 x 65536 pixels" -o a.jpg --scale 32
expect_refusal "nowhere/a.png" --reference 4096 -o nowhere/a.png
expect_refusal "/dev/zero" --scene image:/dev/zero -o a.png
if [[ $(id -u) -ne 0 ]]; then
  echo "kept" >locked.json
  chmod a-w locked.json
  expect_refusal "locked.json" -o a.png --stats locked.json
fi
if "$program" "${small[@]}" --direct -o direct.jpg 2>said; then
  expect_refusal "nowhere/a.jpg" --direct -o nowhere/a.jpg
  expect_refusal "a.jpg: 65501 x 8 pixels" --direct --size 65501x8 -o a.jpg
fi
[[ ! -e a.png && ! -e a.jpg && ! -e b.png ]] || fail "a refused command wrote a picture"

# What does not fit is said in the words of the command line.
(
  ulimit -v 4000000
  expect_failure 1 "--size 65536x65536: does not fit in memory" --size 65536x65536 -o a.png
  expect_failure 1 "--scale 1000" "${small[@]}" --scale 1000 -o a.png
)

# Nothing is touched but the file that is named; its permissions stay, and so does a link to it.
"$program" "${small[@]}" -o expected.png
echo "not for the program" >keep.unfinished.png
echo "an older picture" >keep.png
chmod 640 keep.png
ln -s keep.png link.png
ln -s to_be_made.png dangling.png
"$program" "${small[@]}" -o link.png
"$program" "${small[@]}" -o dangling.png
[[ $(cat keep.unfinished.png) == "not for the program" ]] || fail "a file beside the output is lost"
[[ -L link.png && -L dangling.png ]] || fail "a link was replaced by a file"
[[ ! -L keep.png && $(stat -c %a keep.png) == 640 ]] || fail "permissions are lost"
cmp keep.png expected.png || fail "what the link names is not the picture"
cmp to_be_made.png expected.png || fail "what the dangling link names is not the picture"
# Two runs with one output: both end well, and the picture is that of one of them.
for ((i = 0; i < 8; ++i)); do
  "$program" "${small[@]}" -o shared.png &
  other=$!
  "$program" "${small[@]}" -o shared.png || fail "a run was disturbed by another"
  wait $other || fail "a run was disturbed by another"
  cmp shared.png expected.png || fail "two runs wrote one file"
done
# A full disk leaves the old picture, and nothing else.
for ending in png jpg exr pfm tif sgi; do
  cp expected.png "full.$ending"
  (
    trap '' XFSZ
    ulimit -f 4
    expect_failure 1 "full.$ending" --size 200x200 --scene chess -o "full.$ending"
  )
  cmp "full.$ending" expected.png || fail "a full disk lost the older full.$ending"
done
# A disk that is really full, where one may be made.
mkdir disk
if mount -t tmpfs -o size=64k tmpfs disk 2>/dev/null; then
  trap 'umount disk' EXIT
  head -c 61000 /dev/zero >disk/filler
  for ending in png jpg exr pfm tif sgi ppm json; do
    echo "older" >"disk/x.$ending"
    output=(-o "disk/x.$ending")
    [[ $ending != json ]] || output=(-o ok.png --stats disk/x.json)
    if [[ $ending == json ]]; then head -c 9000 /dev/zero >>disk/filler 2>/dev/null || true; fi
    expect_failure 1 "disk/x.$ending: " --size 200x200 --scene fan "${output[@]}"
    grep -q "^freqsynth_render: " said || fail "$ending: does not name itself: $(cat said)"
    [[ $(cat "disk/x.$ending") == older ]] || fail "a full disk lost the older x.$ending"
    rm "disk/x.$ending"
  done
  [[ $(ls -A disk) == filler ]] || fail "a full disk keeps unfinished files"
  umount disk
  trap - EXIT
else
  echo "no disk could be mounted: not tried when it is full"
fi
[[ -z $(find . -mindepth 1 -name '.*') ]] || fail "unfinished files are left"

# All formats, in the size that was asked for.
for ending in png jpg exr pfm tif; do
  "$program" "${small[@]}" --spp 1/4 -o "picture.$ending"
  [[ -s picture.$ending ]] || fail "picture.$ending is empty"
done
"$program" "${small[@]}" -o old.png
[[ $(head -c 4 old.png | tail -c 3) == PNG ]] || fail "old.png was not replaced"

# The number of samples, also as a fraction, and the figures.
"$program" "${small[@]}" --spp 1/64 -o a.exr --stats a.json --density a_density.png
grep -q '"samples": 48,' a.json || fail "1/64 sample per pixel of 64 x 48 is not 48 samples"
for field in samples absorbed blocks bad_samples sampler_seconds core_seconds wall_seconds \
    peak_rss_bytes; do
  grep -q "\"$field\": [0-9]" a.json || fail "a.json has no $field"
done
[[ -s a_density.png ]] || fail "no density"

# The expected errors, smaller with more samples.
"$program" "${small[@]}" --spp 1 -o a.exr --error a_error.pfm
"$program" "${small[@]}" --spp 16 -o a.exr --error b_error.pfm
[[ -s a_error.pfm ]] || fail "no errors"
! cmp -s a_error.pfm b_error.pfm || fail "the expected errors do not change"

# The same picture whatever the number of threads; another one with another seed.
"$program" "${small[@]}" --threads 1 -o one.pfm
"$program" "${small[@]}" --threads 4 -o four.pfm
cmp one.pfm four.pfm || fail "the picture depends on the number of threads"
"$program" "${small[@]}" --seed 7 -o seven.pfm
! cmp -s one.pfm seven.pfm || fail "the seed changes nothing"

# The options that change the picture do.
for option in "--wave 8" "--terms-every 3" "--cutoff 0.4" "--order 1" "--no-butterworth" \
    "--pixel-filter none" "--pixel-filter gaussian" "--pixel-filter mitchell" "--no-residuals" "--channels gray" "--average display" "--steer relative" "--steer display" "--scale 2" "--zone-frequency 0.1" "--reference 4"; do
  # shellcheck disable=SC2086
  "$program" "${small[@]}" $option -o option.pfm
  ! cmp -s one.pfm option.pfm || fail "$option changes nothing"
done

# Coefficients straight to JPEG: an independent decoder finds the pixels of the other route.
decode() { djpeg -pnm -dct float "$1" 2>/dev/null; }
# largest_difference A B: of two PNM files of one size.
largest_difference() {
  [[ $(head -n 3 "$1" | tr '\n' ' ') == "$(head -n 3 "$2" | tr '\n' ' ')" ]] || fail "$1 is not like $2"
  { cmp -l "$1" "$2" || true; } |
    awk 'function octal(t) { return 64 * int(t / 100) + 8 * int(t % 100 / 10) + t % 10 }
         { d = octal($2) - octal($3); if (d < 0) d = -d; if (d > most) most = d }
         END { print most + 0 }'
}
if "$program" "${small[@]}" --direct -o direct.jpg 2>said; then
  for options in "" "--channels gray" "--average light" "--progressive" "--size 41x23"; do
    # shellcheck disable=SC2086
    "$program" "${small[@]}" --direct --quality 100 $options -o direct.jpg
    # shellcheck disable=SC2086
    "$program" "${small[@]}" --average display ${options/--progressive/} -o pixels.ppm
    decode direct.jpg >direct.ppm
    # Steps of 1: each coefficient is off by up to 1/2, a pixel by 0.3 in the root mean square.
    difference=$(largest_difference pixels.ppm direct.ppm)
    [[ $difference -le 4 ]] || fail "--direct $options decodes to pixels that differ by $difference"
  done
  # Coarser, and smaller.
  "$program" "${small[@]}" --direct -o q75.jpg
  "$program" "${small[@]}" --direct --quality 20 -o q20.jpg
  "$program" "${small[@]}" --direct --subsampling 420 -o half.jpg
  for smaller in q20.jpg half.jpg; do
    [[ $(stat -c %s $smaller) -lt $(stat -c %s q75.jpg) ]] || fail "$smaller is no smaller than q75.jpg"
    decode $smaller >decoded.ppm
  done
  # No number of samples: more for a finer quantiser, and no more than allowed.
  for quality in 20 80; do
    "$program" "${small[@]}" --until-quality $quality -o until.jpg --stats until_$quality.json
    decode until.jpg >decoded.ppm
    grep -q '"ended_by": "target"' until_$quality.json || fail "quality $quality was not reached"
  done
  samples() { sed -n 's/^ *"samples": \([0-9]*\),/\1/p' "$1"; }
  [[ $(samples until_20.json) -lt $(samples until_80.json) ]] || fail "quality 20 costs as much as 80"
  "$program" "${small[@]}" --until-quality 80 --spp 1/8 -o until.jpg --stats until.json
  [[ $(samples until.json) -eq 384 ]] || fail "--spp does not limit --until-quality"
  grep -q '"ended_by": "samples"' until.json || fail "the limit is not said"
  # What cannot be written leaves what was there.
  expect_failure 1 "nowhere/a.jpg" "${small[@]}" --direct -o nowhere/a.jpg
  if [[ -e /dev/full ]]; then
    expect_failure 1 "/dev/full" "${small[@]}" --direct -o /dev/full
  fi
else
  grep -q "without libjpeg" said || fail "--direct fails otherwise than for want of libjpeg"
fi

# Eight pictures of one run and their contact sheet; a picture as the function.
"$program" "${small[@]}" --frames frames
[[ $(find frames -name '?_spp_*.png' | wc -l) -eq 8 ]] || fail "not eight frames"
[[ -s frames/contact_sheet.png ]] || fail "no contact sheet"
"$program" --scene image:picture.png --size 40x40 -o again.png

# Signals end a run of hours within seconds, and what there is is written.
# interrupt SIGNAL ARGUMENTS...
interrupt() {
  local signal=$1 status=0 begin
  shift
  "$program" --size 256x256 "$@" >said 2>&1 &
  sleep 2
  begin=$SECONDS
  kill -"$signal" $!
  wait $! || status=$?
  [[ $status -eq $((128 + $(kill -l "$signal"))) ]] || fail "$signal: exit code $status: $(cat said)"
  [[ $((SECONDS - begin)) -le 20 ]] || fail "$signal: took $((SECONDS - begin)) s"
  grep -q "interrupted" said || fail "$signal: says $(cat said)"
}
interrupt INT --spp 4096 -o stopped.png --density stopped_density.png --stats stopped.json
grep -q '"ended_by": "interrupted"' stopped.json || fail "the figures do not say it"
interrupt TERM --spp 4096 -o stopped.jpg
interrupt INT --reference 100000 -o stopped.exr --stats stopped_reference.json
grep -q '"ended_by": "interrupted"' stopped_reference.json || fail "the figures do not say it"
for picture in stopped.png stopped_density.png stopped.jpg stopped.exr; do
  "$program" --scene "image:$picture" --size 40x40 -o again.png || fail "$picture is not whole"
done
if [[ -s direct.jpg ]]; then
  interrupt TERM --spp 4096 --direct -o stopped_direct.jpg
  [[ $(decode stopped_direct.jpg | head -n 2 | tail -n 1) == "256 256" ]] || fail "--direct: not whole"
fi
interrupt INT --spp 4096 -o late.png --frames late
[[ -s late.png && -s late/contact_sheet.png && -s late/1_spp_1_64.png ]] || fail "frames are lost"
[[ -z $(find . -mindepth 1 -name ".*") ]] || fail "unfinished files are left"
echo "freqsynth_render: all as expected"
