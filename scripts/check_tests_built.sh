#!/usr/bin/env bash
# Fails on a *_test.cpp below tests/ that is compiled by nobody: it would never fail.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_tests_built.sh [BUILD_FOLDER] [ROOT]

Compares the files *_test.cpp below ROOT/tests (default: this repository) with BUILD_FOLDER/compile_commands.json, which
CMake writes when it configures (default: build/ci).
Prints each that is not compiled; exit code 1 if there is one, 2 if there is nothing to compare.
TEXT
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
esac
root=$(cd "${2:-$(dirname "${BASH_SOURCE[0]}")/..}" && pwd)
commands=${1:-$root/build/ci}/compile_commands.json

if [[ ! -f $commands ]]; then
  printf 'check_tests_built: there is no %s\n' "$commands" >&2
  exit 2
fi
compiled=$(sed -n 's|^ *"file": "\(.*\)",\{0,1\}$|\1|p' "$commands")
# Several files that are compiled as one: CMake writes a file that includes them.
while read -r unity; do
  compiled+=$'\n'$(sed -n 's|^#include "\(.*\)"$|\1|p' "$unity")
done < <(grep '/Unity/unity_[^/]*\.cxx$' <<<"$compiled")
count=0
missing=0
while read -r file; do
  count=$((count + 1))
  if ! grep -qxF -- "$root/$file" <<<"$compiled"; then
    printf '%s: is compiled by nobody: add it to tests/CMakeLists.txt\n' "$file"
    missing=$((missing + 1))
  fi
done < <(cd "$root" && find tests -type f -name '*_test.cpp' | LC_ALL=C sort)

if ((count == 0)); then
  printf 'check_tests_built: there are no tests below %s/tests\n' "$root" >&2
  exit 2
fi
if ((missing > 0)); then exit 1; fi
printf 'tests: %d files, all compiled\n' "$count"
