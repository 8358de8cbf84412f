#!/usr/bin/env bash
# Fails on an #include that points the wrong way (see "Two graphs" in docs/architecture.md).
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_includes.sh [ROOT]

Checks the #include lines below ROOT (default: this repository):
  - core includes neither datasets nor eval, and datasets does not include eval
  - the metrics of eval (*_metrics, statistics, mesh/, trajectory/) include neither datasets nor core/pipeline.hpp
  - only eval/run.cpp, eval/measured_motion.cpp and eval/cli include both datasets and core/pipeline.hpp
  - nothing outside tests includes tests
  - quoted paths start at the repository root
Prints each offending line with its rule; exit code 1 if there is one.
TEXT
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
esac
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

rooms=()
for room in core datasets eval tests; do
  if [[ -d $room ]]; then rooms+=("$room"); fi
done
if ((${#rooms[@]} == 0)); then
  printf 'check_includes: nothing to check in %s\n' "$PWD" >&2
  exit 2
fi

find "${rooms[@]}" -type f \( -name '*.hpp' -o -name '*.cpp' \) -print | LC_ALL=C sort | awk '
  function offence(file, line, text, rule) {
    sub(/^[ \t]+/, "", text)
    printf "%s:%d: %s\n    rule: %s\n", file, line, text, rule
    offences++
  }
  function check_line(file, line, text, path, quoted) {
    if (quoted && path !~ /^(core|datasets|eval|tests)\//)
      offence(file, line, text, "quoted include paths start at the repository root")
    if (file ~ /^core\// && path ~ /^(datasets|eval)\//)
      offence(file, line, text, "core never includes datasets or eval")
    if (file ~ /^datasets\// && path ~ /^eval\//)
      offence(file, line, text, "datasets never includes eval")
    if (file ~ /^eval\/([a-z0-9_]*_metrics|statistics|(mesh|trajectory)\/[a-z0-9_]*)\.[ch]pp$/ &&
        (path ~ /^datasets\// || path == "core/pipeline.hpp"))
      offence(file, line, text, "metrics never include datasets or the pipeline")
    if (file !~ /^tests\// && path ~ /^tests\//)
      offence(file, line, text, "only tests include tests")
  }
  {
    file = $0
    datasets_line = pipeline_line = line = 0
    while ((getline text < file) > 0) {
      line++
      if (text !~ /^[ \t]*#[ \t]*include[ \t]*["<]/) continue
      path = text
      sub(/^[ \t]*#[ \t]*include[ \t]*/, "", path)
      quoted = substr(path, 1, 1) == "\""
      path = substr(path, 2)
      sub(/[">].*/, "", path)
      sub(/^fusebench\//, "", path)
      check_line(file, line, text, path, quoted)
      if (path ~ /^datasets\//) { datasets_line = line; datasets_text = text }
      if (path == "core/pipeline.hpp") pipeline_line = line
    }
    close(file)
    if (datasets_line && pipeline_line && file !~ /^(eval\/(run|measured_motion)\.cpp|eval\/cli\/.*|tests\/.*)$/)
      offence(file, datasets_line, datasets_text,
              "only eval/run.cpp, eval/measured_motion.cpp and eval/cli know both datasets and core/pipeline.hpp")
    files++
  }
  END {
    if (!offences) printf "include directions: %d files, all as drawn\n", files
    exit offences > 0
  }'
