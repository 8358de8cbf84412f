#!/usr/bin/env bash
# Plants faults into a small tree of rooms and expects scripts/check_includes.py to refuse each, naming the place and the rule,
# and to let the sound tree pass.
set -euo pipefail

check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/check_includes.py
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# write FILE NAMESPACE LINES
write() {
  mkdir -p "$tree/$(dirname "$1")"
  printf '%b\n\nnamespace %s {\n}\n' "$3" "$2" >"$tree/$1"
}

sound_tree() {
  rm -rf "${tree:?}"/*
  cat >"$tree/CMakeLists.txt" <<'TEXT'
fusebench_room(core/base PUBLIC Eigen3::Eigen)
fusebench_room(core/estimator/filter USES base)
fusebench_room(core USES base filter PRIVATE filter::library)
fusebench_room(datasets/recording USES base)
fusebench_room(datasets/recording/formats/tum USES recording)
fusebench_room(eval/metrics USES base)
fusebench_room(eval/run
  USES base core recording tum metrics
  SOURCES ${build_info})
TEXT
  write core/base/types.hpp fusebench '#pragma once\n#include <vector>'
  write core/estimator/filter/iekf.cpp fusebench::filter '#include "core/base/types.hpp"'
  write core/estimator/filter/iekf.hpp fusebench::filter '#pragma once'
  write core/pipeline.cpp fusebench::core '#include "core/base/types.hpp"\n#include "core/estimator/filter/iekf.hpp"'
  write core/pipeline.hpp fusebench::core '#pragma once'
  write datasets/recording/recording.hpp fusebench::recording '#include "core/base/types.hpp"'
  write datasets/recording/formats/tum/tum_rgbd.cpp fusebench::formats::tum '#include "datasets/recording/recording.hpp"'
  write datasets/recording/formats/tum/tum_rgbd.hpp fusebench::formats::tum '#pragma once'
  write eval/metrics/statistics.cpp fusebench::metrics '#include "core/base/types.hpp"'
  write eval/run/run.cpp fusebench::run '#include "core/base/types.hpp"\n#include "core/pipeline.hpp"
#include "datasets/recording/formats/tum/tum_rgbd.hpp"\n#include "datasets/recording/recording.hpp"
#include "eval/metrics/statistics.hpp"'
}

# expect_refused WHERE RULE_WORDS, after the fault was planted
expect_refused() {
  local output
  if output=$("$check" "$tree"); then
    printf 'not refused: %s (%s)\n' "$1" "$2" >&2
    failures=1
  elif [[ $output != *"$1"* || $output != *"$2"* ]]; then
    printf 'refused without naming %s and "%s":\n%s\n' "$1" "$2" "$output" >&2
    failures=1
  fi
  sound_tree
}

# include FILE PATH: adds an include as the file's last line
include() {
  printf '#include %s\n' "$2" >>"$tree/$1"
}

sound_tree
if ! output=$("$check" "$tree"); then
  printf 'the sound tree is refused:\n%s\n' "$output" >&2
  failures=1
fi

include core/estimator/filter/iekf.cpp '"datasets/recording/recording.hpp"'
expect_refused core/estimator/filter/iekf.cpp:5 'core includes neither'
include core/estimator/filter/iekf.cpp '<fusebench/eval/run/run.hpp>'
expect_refused core/estimator/filter/iekf.cpp:5 'core includes neither'
include datasets/recording/recording.hpp '"eval/run/run.hpp"'
expect_refused datasets/recording/recording.hpp:5 'datasets does not include eval'
include core/estimator/filter/iekf.cpp '"core/pipeline.hpp"'
expect_refused core/estimator/filter/iekf.cpp:5 'core/estimator/filter does not use core'
include core/estimator/filter/iekf.cpp '"core/types.hpp"'
expect_refused core/estimator/filter/iekf.cpp:5 'core/estimator/filter does not use core'
include core/estimator/filter/iekf.cpp '"core/gone/types.hpp"'
expect_refused core/estimator/filter/iekf.cpp:5 'there is no such room'
include eval/run/run.cpp '"tests/support/scene.hpp"'
expect_refused eval/run/run.cpp:9 'nothing outside tests'
include core/estimator/filter/iekf.cpp '"types.hpp"'
expect_refused core/estimator/filter/iekf.cpp:5 'start at the repository root'
include core/estimator/filter/iekf.cpp '"../eval/run.hpp"'
expect_refused core/estimator/filter/iekf.cpp:5 'start at the repository root'

sed -i 's/(core\/estimator\/filter USES base)/(core\/estimator\/filter USES base recording)/' "$tree/CMakeLists.txt"
expect_refused 'core/estimator/filter uses recording' 'only rooms before it'
sed -i 's/USES recording)/USES base recording)/' "$tree/CMakeLists.txt"
expect_refused 'datasets/recording/formats/tum uses base' 'what its files include'
sed -i 's/(eval\/metrics USES base)/(eval\/metrics USES base recording)/' "$tree/CMakeLists.txt"
include eval/metrics/statistics.cpp '"datasets/recording/recording.hpp"'
expect_refused 'eval/metrics uses' 'metrics know neither'
sed -i 's/(eval\/metrics USES base)/(eval\/metrics USES base filter)\nfusebench_room(eval\/compare\/tables USES core recording)/' "$tree/CMakeLists.txt"
write eval/compare/tables/table.cpp fusebench::tables '#include "core/pipeline.hpp"\n#include "datasets/recording/recording.hpp"'
expect_refused 'eval/compare/tables uses' 'use both recordings and the pipeline'
sed -i 's/eval\/metrics/eval\/filter/' "$tree/CMakeLists.txt"
expect_refused CMakeLists.txt 'last names of rooms differ'
sed -i '/eval\/metrics/d' "$tree/CMakeLists.txt"
expect_refused eval/metrics/statistics.cpp 'every source lies in a room'
write core/estimator/filter/state.cpp fusebench ''
expect_refused core/estimator/filter/state.cpp:3 'the namespace of core/estimator/filter is fusebench::filter'
for unit in a b c d e f g h i j k l m n o; do write "core/estimator/filter/$unit.cpp" fusebench::filter ''; done
expect_refused core/estimator/filter 'at most 15 units'
rm "$tree/core/estimator/filter/"*
expect_refused core/estimator/filter 'every room has sources'

rm -rf "${tree:?}"/*
printf 'fusebench_room(core/base)\n' >"$tree/CMakeLists.txt"
status=0
"$check" "$tree" 2>/dev/null || status=$?
if ((status != 2)); then
  printf 'an empty tree ends with %d instead of 2\n' "$status" >&2
  failures=1
fi
exit "$failures"
