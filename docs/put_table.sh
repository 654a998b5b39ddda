#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Puts what it reads into a document: between the lines <!-- NAME --> and <!-- end of NAME -->.
#   docs/put_table.sh DOCUMENT NAME <TABLE
set -euo pipefail
document=$1 name=$2
for line in "<!-- $name -->" "<!-- end of $name -->"; do
  if [[ $(grep -cxF -- "$line" "$document") != 1 ]]; then
    echo "put_table.sh: $document: has not one line $line" >&2
    exit 1
  fi
done
table=$(mktemp)
trap 'rm -f "$table"' EXIT
cat >"$table"
if [[ ! -s $table ]]; then
  echo "put_table.sh: nothing to put into $document" >&2
  exit 1
fi
whole=$(awk -v name="$name" -v table="$table" '
  $0 == "<!-- end of " name " -->" { inside = 0 }
  !inside { print }
  $0 == "<!-- " name " -->" {
    inside = 1
    print ""
    while ((getline line < table) > 0) print line
    print ""
  }' "$document")
printf '%s\n' "$whole" >"$document"
