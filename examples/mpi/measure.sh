#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures freqsynth_mpi on this machine, and predicts from that what 64 and 1,024 ranks would do: the
# tables of docs/mpi.md. About three minutes of CPU time, some of it on all cores. Builds in
# build/examples; on Debian, installs what is missing.
#   examples/mpi/measure.sh [--fix] [FOLDER]
# --fix: writes the tables of docs/mpi.md. FOLDER: with the programs there instead.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
fix=
if [[ ${1-} == --fix ]]; then
  fix=$1
  shift
fi
programs=${1:-$root/build/examples/examples}
if [[ $# -eq 0 ]]; then "$root/examples/run.sh" --mpi 1 --help >/dev/null; fi
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
out=$root/out/mpi
mkdir -p "$out"

# Assumed of the network between the machines.
latency=20e-6     # seconds of a letter
bandwidth=1.25e9  # bytes in a second, of rank 0: 10 Gbit/s
# As in PacketSettings.
least_packet=3e-4 # seconds
windows_per_rank=4

# put NAME: shows a table, and with --fix writes it
put() {
  local table
  table=$(cat)
  printf '%s\n\n' "$table"
  if [[ -n $fix ]]; then "$root/docs/put_table.sh" "$root/docs/mpi.md" "$1" <<<"$table"; fi
}

# on RANKS ARGUMENTS...: the run's figures are in s.json then
on() {
  mpirun --oversubscribe -n "$1" "$programs/freqsynth_mpi" "${@:2}" -o "$out/m.pfm" \
    --stats "$out/s.json" >/dev/null 2>"$out/errors" || { cat "$out/errors" >&2; exit 1; }
}
figure() { sed -n "s/.*\"$1\": \([0-9.e+-]*\).*/\1/p" "$out/s.json" | head -n 1; }
traced() { awk -F'tracing_seconds": ' '/tracing_seconds/ { sum += $2 } END { print sum }' "$out/s.json"; }

# Seconds of a sample with one engine: one_engine(a: choosing and absorbing, m: mail, t: tracing, w:
# samples of a wave, p: ranks that trace, b: bytes).
model='
function least(x, y) { return x < y ? x : y }
function most(x, y) { return x > y ? x : y }
function one_engine(a, m, t, w, p, b,   smallest, busy) {
  smallest = most(least_packet / t, 1)
  busy = most(least(p, w / smallest), 1)
  return a + most(most(t / busy, m), b / bandwidth) + (2 * latency + most(smallest * t, t) / 2) / w
}'
predict() {
  awk -v least_packet=$least_packet -v latency=$latency -v bandwidth=$bandwidth "$@"
}

size=(--scene gradient --size 512x512 --wave 1024)
# row NAME RANKS
row() {
  predict -v name="$1" -v ranks="$2" -v n="$(figure samples)" -v waves="$(figure waves)" \
    -v wall="$(figure wall_seconds)" -v traced="$(traced)" -v choosing="$(figure choosing_seconds)" \
    -v absorbing="$(figure absorbing_seconds)" -v mailing="$(figure mailing_seconds)" \
    -v finishing="$(figure finishing_seconds)" -v b="$(figure request_bytes)" "$model"'
    BEGIN {
      t = traced / n; a = (choosing + absorbing) / n; m = mailing / n; p = ranks - 1
      if (p == 0) {
        printf "| %s | 1 | %.2f | %.1f us | | | | |\n", name, wall, 1e6 * t
        exit
      }
      printf "| %s | %d | %.2f | %.1f us | %.2f us | %.2f us | %.0f %% | %.0f %% |\n", name, ranks, wall,
             1e6 * t, 1e6 * a, 1e6 * m, 100 * traced / (wall - finishing) / p,
             100 * t / p / one_engine(a, m, t, n / waves, p, b)
    }'
}
times() {
  echo "Load of this machine with $(nproc) cores: $(cut -d' ' -f1-3 /proc/loadavg)."
  echo
  echo "| sampler | ranks | seconds | a sample as traced | choose + absorb | mail | at work | as predicted |"
  echo "|---|---|---|---|---|---|---|---|"
  for microseconds in 1 10 100; do
    spp=$(awk -v t=$microseconds 'BEGIN { print (t > 50 ? 0.0625 : 0.25) }')
    for ranks in 1 2 4; do
      on $ranks "${size[@]}" --spp "$spp" --busy $microseconds
      row "$microseconds us, computes" $ranks
    done
  done
  for ranks in 5 9 17; do
    on $ranks "${size[@]}" --spp 0.25 --sleep 100
    row "100 us, sleeps" $ranks
  done
  # With eleven channels, where there is Embree.
  if [[ -x $programs/embree/freqsynth_embree ]]; then
    for ranks in 1 2 4; do
      on $ranks --scene colonnade --size 512x512 --wave 1024 --spp 1
      row "the colonnade" $ranks
    done
  fi
}
times | put "times"

# What an engine and a picture take by themselves, per sample and pixel.
on 2 "${size[@]}" --spp 4 --wave 8192
a=$(awk -v c="$(figure choosing_seconds)" -v d="$(figure absorbing_seconds)" -v n="$(figure samples)" 'BEGIN { print (c + d) / n }')
m=$(awk -v c="$(figure mailing_seconds)" -v n="$(figure samples)" 'BEGIN { print c / n }')
f=$(awk -v c="$(figure finishing_seconds)" 'BEGIN { print c / 512 / 512 }')
# Windows of a chess board, those first that have most samples, to the rank that has least.
on 3 --scene chess --size 1024x1024 --spp 0.25 --windows 16x16
balance=$(sed -n 's/.*"windows": \[\(.*\)\].*/\1/p' "$out/s.json" | tr -d ' ' | tr ',' '\n' | sort -rn |
  awk '{ least = 1; for (r = 2; r <= 63; ++r) if (load[r] < load[least]) least = r
         load[least] += $1; sum += $1; if (load[least] > most) most = load[least] }
       END { print sum / 63 / most }')

predicted() {
  awk -v a=$a -v m=$m -v f=$f -v balance="$balance" 'BEGIN {
    printf "Rank 0: %.3f us for choosing and absorbing a sample, %.3f us for its mail, %.3f us for finishing a pixel. 16 x 16 windows of a chess board, 4 for each rank, keep 63 ranks at work for %.0f %% of the time.\n", 1e6 * a, 1e6 * m, 1e6 * f, 100 * balance }'
  echo
  echo "| picture | sampler | ranks | one engine, 1/32 a wave | one engine, 1/4 a wave | windows |"
  echo "|---|---|---|---|---|---|"
  for picture in 3840x2160 15360x8640; do
    for microseconds in 1 10 100; do
      for ranks in 64 1024; do
        predict -v picture=$picture -v us=$microseconds -v ranks=$ranks -v a="$a" -v m="$m" -v f="$f" \
          -v balance="$balance" -v windows=$windows_per_rank "$model"'
          BEGIN {
            split(picture, side, "x"); pixels = side[1] * side[2]; blocks = pixels / 64
            spp = 4; n = spp * pixels; t = us * 1e-6; p = ranks - 1; b = 16; v = 12
            alone = n * (t + a) + f * pixels
            printf "| %d x %d | %d us | %d |", side[1], side[2], us, ranks
            for (i = 0; i < 2; ++i) {
              w = blocks / (i ? 4 : 32)
              time = n * one_engine(a, m, t, w, p, b) + f * pixels
              printf " %.0f |", alone / time
            }
            # A coarse pass with a 64th of the samples; the engines; their pixels to rank 0.
            coarse = n / 64 * one_engine(a, m, t, blocks / 64 / 4, p, b)
            time = coarse + (n * 63 / 64 * (t + a) + f * pixels) / p / balance + v * pixels / bandwidth
            printf " %.0f |\n", alone / time
          }'
      done
    done
  done
}
predicted | put "predicted"

# What windows cost: the same number of samples in one piece and in windows.
windows() {
  echo "| scene | samples | windows | all, whole | windows | near borders, whole | windows | steps across, whole | windows |"
  echo "|---|---|---|---|---|---|---|---|---|"
  for scene in chess fan zoneplate softshadow; do
    picture=(--scene $scene --size 512x512)
    truth=$out/truth_$scene.exr
    [[ -e $truth ]] || "$programs/freqsynth_render" "${picture[@]}" --reference 64 --seed 9 -o "$truth"
    for samples in "--spp 1" "--spp 4" "--uniform 81"; do
      # Without noise there is no difference then, to the bit.
      if [[ $samples == --uniform* && $scene != softshadow ]]; then continue; fi
      read -ra words <<<"$samples"
      "$programs/freqsynth_mpi" "${picture[@]}" "${words[@]}" -o "$out/whole.exr" >/dev/null
      for windows in 2x2 4x4; do
        "$programs/freqsynth_mpi" "${picture[@]}" "${words[@]}" --windows $windows -o "$out/windows.exr" >/dev/null
        "$programs/freqsynth_mpi_seam" $windows "$out/whole.exr" "$out/windows.exr" "$truth" |
          awk -v scene=$scene -v samples="$samples" -v windows=$windows '
            NR > 1 { for (i = 2; i <= 4; ++i) e[NR, i] = $i }
            END { printf "| %s | `%s` | %s |", scene, samples, windows
                  for (i = 2; i <= 4; ++i) printf " %.4f | %.4f |", e[2, i], e[3, i]
                  print "" }'
      done
    done
  done
}
windows | put "windows"
