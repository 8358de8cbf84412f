#!/usr/bin/env bash
# Gives scripts/check_tests_built.sh a small tree and what CMake would compile of it.
set -euo pipefail

check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/check_tests_built.sh
tree=$(cd "$(mktemp -d)" && pwd -P)
trap 'rm -rf "$tree"' EXIT
failures=0

# expect STATUS WORDS: of a check of the tree as it is; WORDS are part of what it says.
expect() {
  local output status=0
  output=$("$check" "$tree/build" "$tree" 2>&1) || status=$?
  if ((status != $1)) || [[ $output != *"$2"* ]]; then
    printf 'exit code %d and "%s", expected %d and "%s"\n' "$status" "$output" "$1" "$2" >&2
    failures=1
  fi
}

# compiled FILE...: what CMake's list has.
compiled() {
  local file
  {
    printf '[\n'
    for file; do
      printf '{\n  "directory": "%s/build",\n  "command": "c++ -c %s",\n  "file": "%s",\n  "output": "o"\n},\n' \
        "$tree" "$tree/tests/core/unbuilt_test.cpp" "$tree/$file"
    done
    printf ']\n'
  } >"$tree/build/compile_commands.json"
}

mkdir -p "$tree"/{build,tests/core,tests/support}
expect 2 'there is no'
compiled
expect 2 'no tests below'
touch "$tree"/tests/core/{a_test.cpp,b_test.cpp} "$tree/tests/support/scene.cpp"
compiled tests/core/a_test.cpp tests/core/b_test.cpp
expect 0 '2 files, all compiled'
touch "$tree/tests/core/unbuilt_test.cpp"
expect 1 'tests/core/unbuilt_test.cpp: is compiled by nobody'
compiled tests/core/a_test.cpp tests/core/b_test.cpp tests/core/not_unbuilt_test.cpp
expect 1 'tests/core/unbuilt_test.cpp: is compiled by nobody'
compiled tests/core/a_test.cpp tests/core/unbuilt_test.cpp tests/core/b_test.cpp
expect 0 '3 files, all compiled'
# Two of them as one.
mkdir -p "$tree/build/Unity"
compiled tests/core/a_test.cpp build/Unity/unity_0_cxx.cxx
printf '#include "%s"\n' "$tree/tests/core/b_test.cpp" >"$tree/build/Unity/unity_0_cxx.cxx"
expect 1 'tests/core/unbuilt_test.cpp: is compiled by nobody'
printf '#include "%s"\n' "$tree/tests/core/unbuilt_test.cpp" >>"$tree/build/Unity/unity_0_cxx.cxx"
expect 0 '3 files, all compiled'

if ((failures == 0)); then printf 'check_tests_built: all cases as expected\n'; fi
exit "$failures"
