#!/usr/bin/env bash
# Plants includes into a small tree and expects scripts/check_includes.sh to refuse the bad ones, naming the line and
# the rule, and to let the good ones pass.
set -euo pipefail

check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/check_includes.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

fresh_tree() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{core,datasets,eval/cli,eval/mesh,eval/trajectory,tests/support}
  printf '#pragma once\n#include <vector>\n' >"$tree/core/types.hpp"
}

# expect_refused FILE INCLUDE_LINE RULE_WORDS
expect_refused() {
  fresh_tree
  printf '// first line\n%b\n' "$2" >"$tree/$1"
  local output
  if output=$("$check" "$tree"); then
    printf 'not refused: %s in %s\n' "$2" "$1" >&2
    failures=1
  elif [[ $output != *"$1:2:"* || $output != *"$3"* ]]; then
    printf 'refused without naming %s:2 and "%s":\n%s\n' "$1" "$3" "$output" >&2
    failures=1
  fi
}

# expect_accepted FILE INCLUDE_LINES
expect_accepted() {
  fresh_tree
  printf '// first line\n%b\n' "$2" >"$tree/$1"
  local output
  if ! output=$("$check" "$tree"); then
    printf 'refused, but allowed:\n%s\n' "$output" >&2
    failures=1
  fi
}

both='#include "datasets/recording.hpp"\n#include "core/frame_report.hpp"'

expect_refused core/iekf.cpp '#include "datasets/recording.hpp"' 'core never includes'
expect_refused core/iekf.hpp '  #  include "eval/statistics.hpp"' 'core never includes'
expect_refused core/iekf.cpp '#include <fusebench/eval/run.hpp>' 'core never includes'
expect_refused datasets/tum_rgbd.cpp '#include "eval/run.hpp"' 'datasets never includes eval'
expect_refused eval/mesh/mesh_metrics.cpp '#include "core/frame_report.hpp"' 'metrics never include'
expect_refused eval/trajectory_metrics.hpp '#include "datasets/recording.hpp"' 'metrics never include'
expect_refused eval/statistics.cpp '#include "core/frame_report.hpp"' 'metrics never include'
expect_refused eval/trajectory/alignment.cpp '#include "datasets/recording.hpp"' 'metrics never include'
expect_refused eval/record.cpp "$both" 'know both'
expect_refused eval/run.hpp "$both" 'know both'
expect_refused eval/batch.cpp "$both" 'know both'
expect_refused eval/run.cpp '#include "tests/support/scene.hpp"' 'only tests include tests'
expect_refused core/iekf.cpp '#include "../eval/run.hpp"' 'start at the repository root'
expect_refused core/iekf.cpp '#include "types.hpp"' 'start at the repository root'

expect_accepted eval/run.cpp "$both"
expect_accepted eval/measured_motion.cpp "$both"
expect_accepted eval/cli/run.cpp "$both"
expect_accepted eval/trajectory_metrics.cpp '#include "core/types.hpp"\n#include "eval/statistics.hpp"'
expect_accepted datasets/tum_rgbd.cpp '#include "core/types.hpp"'
expect_accepted tests/support/scene.hpp "$both"
expect_accepted core/iekf.cpp '// #include "eval/run.hpp" would be wrong here'

if ((failures == 0)); then printf 'check_includes: all cases as expected\n'; fi
exit "$failures"
