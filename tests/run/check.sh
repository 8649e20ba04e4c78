#!/usr/bin/env bash
# Checks for the tests of scripts; to be sourced. A test ends with `finish`.

failures=0

# expect WHAT COMMAND...: the command must succeed.
expect() {
  local what=$1
  shift
  if ! "$@"; then
    echo "FAILED: $what"
    failures=$((failures + 1))
  fi
}

# is GOT EXPECTED
is() {
  if [[ $1 != "$2" ]]; then
    printf '  got:      %s\n  expected: %s\n' "$1" "$2"
    return 1
  fi
}

# has TEXT PART
has() {
  if [[ $1 != *"$2"* ]]; then
    printf '  no "%s" in:\n%s\n' "$2" "$1"
    return 1
  fi
}

lacks() { ! has "$1" "$2" >/dev/null; }

# call COMMAND...: keeps the exit code in $code, standard output in $out and the messages in $err.
call() {
  code=0
  "$@" >"$scratch/out" 2>"$scratch/err" </dev/null || code=$?
  out=$(<"$scratch/out")
  err=$(<"$scratch/err")
}

finish() {
  if ((failures > 0)); then
    echo "$failures checks failed"
    exit 1
  fi
  echo "all checks passed"
}

scratch=$(mktemp -d)
trap 'rm -rf -- "$scratch"' EXIT
out='' err='' code=0
export out err code
