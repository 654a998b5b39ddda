#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes photographs to look at with freqsynth_render --scene image:FILE, 512x512 pixels each.
#   examples/photographs.sh FOLDER
#
# They come from Debian's package lomiri-wallpapers-16.04 (16 MB), which is fetched with
# apt-get download and unpacked into a temporary folder, not installed. Scaled down and cropped:
#   dandelion.png  "seeding", Clemens Engelhardt 2018, CC0-1.0: fine hairs against the light, in
#                  front of a blurred meadow
#   mountains.png  "picosdeeuropa", Aitzol Berasategi 2018, CC-BY-4.0: rocks, grass and clouds,
#                  sharp all over. Name the author where you show it.
set -euo pipefail

fail() {
  echo "photographs.sh: $*" >&2
  exit 1
}

[[ $# -eq 1 && $1 != -* ]] || {
  echo "usage: examples/photographs.sh FOLDER" >&2
  exit 2
}
folder=$1
package=lomiri-wallpapers-16.04
for tool in apt-get dpkg-deb oiiotool; do
  command -v "$tool" >/dev/null || fail "needs $tool (oiiotool is in the package openimageio-tools)"
done
mkdir -p "$folder" || fail "cannot make the folder $folder"
folder=$(cd "$folder" && pwd)

temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
# apt fetches as a user of its own where it can, who has to be able to write here.
chmod 755 "$temporary"
(cd "$temporary" && apt-get -q download "$package" >log 2>&1) ||
  fail "apt-get cannot download $package: $(tail -n 1 "$temporary/log")"
dpkg-deb -x "$temporary/$package"_*.deb "$temporary/unpacked" || fail "cannot unpack $package"

# picture NAME SOURCE SCALED CROP: scaled to SCALED, then the part CROP (WxH+X+Y).
picture() {
  local source=$temporary/unpacked/usr/share/backgrounds/$2
  [[ -f $source ]] || fail "$package has no $2: another version than 20.04.0?"
  oiiotool "$source" --resize "$3" --cut "$4" -d uint8 -o "$folder/$1.png" ||
    fail "oiiotool cannot make $folder/$1.png"
  echo "$folder/$1.png"
}
picture dandelion seeding_by_Clements_Engelhardt.jpg 1024x576 512x512+60+20
picture mountains picosdeeuropa_by_Aitzol_Berasategi.jpg 768x576 512x512+180+20
