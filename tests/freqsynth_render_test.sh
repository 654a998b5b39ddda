#!/usr/bin/env bash
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
expect_failure 2 "--pixel-filter tent" "${small[@]}" --pixel-filter tent -o a.png
expect_failure 2 "--channels cmyk" "${small[@]}" --channels cmyk -o a.png
expect_failure 2 "--threads 0" "${small[@]}" --threads 0 -o a.png
expect_failure 2 "cheese" --scene cheese -o a.png
[[ ! -e a.png ]] || fail "a refused command wrote a picture"

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

# The same picture whatever the number of threads; another one with another seed.
"$program" "${small[@]}" --threads 1 -o one.pfm
"$program" "${small[@]}" --threads 4 -o four.pfm
cmp one.pfm four.pfm || fail "the picture depends on the number of threads"
"$program" "${small[@]}" --seed 7 -o seven.pfm
! cmp -s one.pfm seven.pfm || fail "the seed changes nothing"

# The options that change the picture do.
for option in "--wave 1" "--terms-every 3" "--cutoff 0.4" "--order 1" "--no-butterworth" \
    "--pixel-filter none" "--no-residuals" "--channels gray" "--scale 2" "--zone-frequency 0.1" "--reference 4"; do
  # shellcheck disable=SC2086
  "$program" "${small[@]}" $option -o option.pfm
  ! cmp -s one.pfm option.pfm || fail "$option changes nothing"
done

# Eight pictures of one run and their contact sheet; a picture as the function.
"$program" "${small[@]}" --frames frames
[[ $(find frames -name '?_spp_*.png' | wc -l) -eq 8 ]] || fail "not eight frames"
[[ -s frames/contact_sheet.png ]] || fail "no contact sheet"
"$program" --scene image:picture.png --size 40x40 -o again.png
[[ $(find . -name '.*unfinished*' | wc -l) -eq 0 ]] || fail "unfinished files are left"
echo "freqsynth_render: all as expected"
