#!/usr/bin/env bash
# Fails on a name that two files of the product define in different ways (the One Definition Rule): the linker would take
# one of the definitions for both, without a word.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_odr.sh [--jobs N] [OBJECT...]

Compiles the product with the preset odr (for link-time optimisation, not optimised), and lets the linker compare the
types and declarations of all objects. Nothing is linked that could be run. With OBJECTs, these are compared instead.
  --jobs N  compilers at a time (default: processors)
Prints each violation with both places; exit code 1 if there is one, 2 if something could not be compiled.
TEXT
}

jobs=$(nproc)
objects=()
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --jobs) jobs=${2:?--jobs needs a number}; shift ;;
    -*) usage >&2; exit 2 ;;
    *) objects+=("$(realpath -- "$1")") ;;
  esac
  shift
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if ((${#objects[@]} == 0)); then
  cmake --preset odr >/dev/null || exit 2
  # Not the libraries and the program: for these the linker would generate all of the code.
  mapfile -t objects < <(sed -n 's|^ *"command": ".* -o \([^ ]*\) -c .*|\1|p' build/odr/compile_commands.json |
    grep -v '\.gch$')  # precompiled headers are no objects
  ninja -C build/odr -j "$jobs" --quiet "${objects[@]}" || exit 2
  cd build/odr
fi
if ((${#objects[@]} == 0)); then
  printf 'check_odr: there are no objects to compare\n' >&2
  exit 2
fi

# Relocatable and still intermediate code: only the whole-program analysis, which merges the types, is run.
report=$(mktemp -d)
trap 'rm -rf "$report"' EXIT
status=0
"${CXX:-g++}" -O0 -flto -fno-fat-lto-objects -r -flinker-output=rel -Wodr -Werror=odr -Werror=lto-type-mismatch \
  "${objects[@]}" -o "$report/all.o" 2>"$report/messages" || status=$?
if ((status != 0)); then
  grep -vE '^(lto-wrapper|lto1|/usr/bin/ld|collect2)' "$report/messages" || cat "$report/messages"
  exit 1
fi
printf 'one definition rule: %d objects, all agree\n' "${#objects[@]}"
