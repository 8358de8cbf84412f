#!/usr/bin/env bash
# Puts types into a small tree and expects scripts/check_type_names.sh to refuse two of one name.
set -euo pipefail

check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/check_type_names.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# expect STATUS WORDS TEXT: of a second file beside core/first.hpp; WORDS are part of what the check says.
expect() {
  local output status=0
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{core,eval/suites/engine}
  printf 'namespace fusebench {\n\nstruct Options {\n  int a;\n};\nenum class Mode { on, off };\n\n}  // namespace fusebench\n' \
    >"$tree/core/first.hpp"
  printf '%b\n' "$3" >"$tree/eval/suites/engine/second.cpp"
  output=$("$check" "$tree" 2>&1) || status=$?
  if ((status != $1)) || [[ $output != *"$2"* ]]; then
    printf '%b\nexit code %d and "%s", expected %d and "%s"\n' "$3" "$status" "$output" "$1" "$2" >&2
    failures=1
  fi
}

end='}  // namespace fusebench'
expect 1 'eval/suites/engine/second.cpp:2: fusebench::Options is defined at core/first.hpp:3 as well' \
  "namespace fusebench {\nstruct Options {\n  double a;\n};\n$end"
expect 1 'fusebench::Options is defined at' "namespace fusebench {\nclass Options final : public Base {\n};\n$end"
expect 1 'fusebench::Mode is defined at' "namespace fusebench {\nenum class Mode { a };\n$end"
expect 1 'second.cpp:4: fusebench::Options' "namespace fusebench {\nnamespace {\n}  // namespace\nunion Options {\n};\n$end"
expect 0 '3, each defined once' "namespace fusebench {\nstruct Options;\nclass Mode;\nstruct Other {\n  struct Options {};\n};\n$end"
expect 0 '2, each defined once' "namespace fusebench {\nnamespace {\nstruct Options {\n};\n}  // namespace\n$end"
expect 0 '3, each defined once' "namespace fusebench::engine {\nstruct Options {\n};\n}  // namespace fusebench::engine"
expect 0 '2, each defined once' "namespace fusebench {\ntemplate <>\nstruct Options<int> {\n};\n$end"

rm -rf "${tree:?}"/*
status=0
"$check" "$tree" >/dev/null 2>&1 || status=$?
if ((status != 2)); then
  printf 'an empty tree: exit code %d, expected 2\n' "$status" >&2
  failures=1
fi

if ((failures == 0)); then printf 'check_type_names: all cases as expected\n'; fi
exit "$failures"
