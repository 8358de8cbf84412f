#!/usr/bin/env bash
# Compiles two files that agree on a type, and two that do not, and expects scripts/check_odr.sh to tell them apart.
set -euo pipefail

check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/check_odr.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree"
failures=0

# compiled NAME FIELDS RESULT: an object whose function takes a type room::Options with these fields.
compiled() {
  printf 'namespace room { struct Options { %s }; %s %s(const Options& o) { return o.a; } }\n' "$2" "$3" "$1" >"$1.cpp"
  "${CXX:-g++}" -O0 -g0 -flto -fno-fat-lto-objects -c "$1.cpp" -o "$1.o"
}

# expect STATUS WORDS OBJECT...
expect() {
  local status=$1 words=$2 output got=0
  shift 2
  output=$("$check" "$@" 2>&1) || got=$?
  if ((got != status)) || [[ $output != *"$words"* ]]; then
    printf '%s: exit code %d and "%s", expected %d and "%s"\n' "$*" "$got" "$output" "$status" "$words" >&2
    failures=1
  fi
}

compiled first 'int a = 1; double b = 2;' int
compiled second 'int a = 1; double b = 2;' int
compiled other 'double a = 1;' double
compiled renamed 'int a = 1; double c = 2;' int
expect 0 '2 objects, all agree' first.o second.o
expect 1 "struct Options" first.o second.o other.o
expect 1 'other.cpp:1' first.o other.o
expect 1 'renamed.cpp:1' second.o renamed.o

if ((failures == 0)); then printf 'check_odr: all cases as expected\n'; fi
exit "$failures"
