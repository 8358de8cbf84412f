#!/usr/bin/env bash
# Writes paths into a small tree and expects scripts/check_references.sh to find those that lead nowhere, and no others.
set -euo pipefail

check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/check_references.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

fresh_tree() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{core,docs,eval/mesh,scripts,tests/scripts,tests/support,configs/suites}
  printf '// See docs/a.md.\n' >"$tree/core/types.hpp"
  printf '# A\n' >"$tree/docs/a.md"
  printf '#!/bin/sh\n' >"$tree/scripts/build.sh"
  printf '#pragma once\n' >"$tree/tests/support/scene.hpp"
}

# expect_missing FILE LINE PATH
expect_missing() {
  fresh_tree
  printf 'first line\n%s\n' "$2" >"$tree/$1"
  local output status=0
  output=$("$check" "$tree") || status=$?
  if ((status != 1)) || [[ $output != "$1:2: there is no $3" ]]; then
    printf 'in %s, "%s": exit code %d and "%s", expected 1 and %s\n' "$1" "$2" "$status" "$output" "$3" >&2
    failures=1
  fi
}

# expect_found FILE LINE
expect_found() {
  fresh_tree
  printf 'first line\n%s\n' "$2" >"$tree/$1"
  local output
  if ! output=$("$check" "$tree"); then
    printf 'in %s, "%s": not accepted: %s\n' "$1" "$2" "$output" >&2
    failures=1
  fi
}

expect_missing docs/b.md 'see `core/typs.hpp`' core/typs.hpp
expect_missing docs/b.md 'see [the first](aa.md#top)' aa.md
expect_missing README.md 'see [the first](docs/b.md)' docs/b.md
expect_missing core/iekf.cpp '// As in eval/mesh/gone.cpp.' eval/mesh/gone.cpp
expect_missing core/iekf.hpp '/// (docs/z.md)' docs/z.md
expect_missing scripts/test.sh './scripts/gone.sh --check' scripts/gone.sh
expect_missing scripts/test.sh 'python3 tests/report/page.py' tests/report/page.py
expect_missing configs/suites/a.toml '# see configs/suites/b.toml' configs/suites/b.toml

expect_found docs/b.md '`core/types.hpp`, `./scripts/build.sh`, [a](a.md#b), [c](#c) and https://example.org/core/gone.hpp'
expect_found docs/b.md 'any `configs/suites/NAME.toml`, `core/*.hpp`, `build/ci/core/gone.cpp`, `include/core/gone.hpp`'
expect_found tests/one_test.cpp '// support/scene.hpp and tests/support/scene.hpp'
expect_found tests/scripts/any_test.sh 'expect core/gone.cpp'

rm -rf "${tree:?}"/*
status=0
"$check" "$tree" >/dev/null 2>&1 || status=$?
if ((status != 2)); then
  printf 'an empty tree: exit code %d, expected 2\n' "$status" >&2
  failures=1
fi

if ((failures == 0)); then printf 'check_references: all cases as expected\n'; fi
exit "$failures"
