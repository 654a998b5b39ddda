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
