# SPDX-License-Identifier: MIT
# For tests of programs, to be sourced. `program` names the program under test.

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# expect_failure CODE TEXT ARGUMENTS...: exits with CODE and says TEXT.
expect_failure() {
  local code=$1 text=$2 status=0
  shift 2
  "$program" "$@" >said 2>&1 || status=$?
  [[ $status -eq $code ]] || fail "exit code $status instead of $code: $*"
  grep -qF -- "$text" said || fail "does not say '$text': $* ($(cat said))"
}

# cut_short PICTURE: its first half, as cut_short.ENDING.
cut_short() { head -c $(($(stat -c %s "$1") / 2)) "$1" >"cut_short.${1##*.}"; }

# huge PICTURE: a copy whose header claims 65500 x 65500 pixels, as huge.ENDING. JPEG and PNG only.
huge() {
  local copy="huge.${1##*.}" at
  cp "$1" "$copy"
  case $1 in
    *.jpg) # marker 0xffc0, length, precision, height, width
      at=$(LC_ALL=C grep -obUaP '\xff\xc0\x00\x11\x08' "$1" | tr -d "\0" | head -n 1)
      printf '\xff\xdc\xff\xdc' | dd of="$copy" bs=1 seek=$((${at%%:*} + 5)) conv=notrunc status=none ;;
    *.png) # not checked before the sum of the header is, so only that nothing is read
      printf '\x00\x00\xff\xdc\x00\x00\xff\xdc' | dd of="$copy" bs=1 seek=16 conv=notrunc status=none ;;
    *) return 1 ;;
  esac
}
