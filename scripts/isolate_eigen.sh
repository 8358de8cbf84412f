#!/usr/bin/env bash
# Makes one object file of a static library, in which Eigen's functions are its own.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/isolate_eigen.sh ARCHIVE OBJECT

Links all of ARCHIVE into OBJECT and makes its copies of Eigen's inline functions and templates local. Debian compiles Ceres for
any x86-64 processor, and this project for x86-64-v3: Eigen's functions have the same names there and here, but other
instructions and another layout of allocated memory, and a linker keeps one of each name.
Needs GNU binutils.
TEXT
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
esac
if (($# != 2)); then
  usage >&2
  exit 2
fi
archive=$1
object=$2

names=$(mktemp)
trap 'rm -f "$names" "$object.part"' EXIT
# Without groups, of which a linker would keep one a name, whatever is local.
ld -r --force-group-allocation --whole-archive "$archive" -o "$object.part"
# A static variable of an inline function is "unique" rather than weak, which cannot be made local as it is.
nm "$object.part" | awk '$2 == "u" { print $3 }' | LC_ALL=C sort -u >"$names"
if [[ -s $names ]]; then objcopy --weaken-symbols="$names" "$object.part"; fi
nm "$object.part" | awk '$2 ~ /^[WV]$/ && $3 ~ /Eigen/ { print $3 }' | LC_ALL=C sort -u >"$names"
if [[ ! -s $names ]]; then
  printf 'isolate_eigen: %s has no functions of Eigen\n' "$archive" >&2
  exit 1
fi
objcopy --localize-symbols="$names" "$object.part"
mv "$object.part" "$object"
