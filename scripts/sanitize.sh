#!/usr/bin/env bash
# Tests and attacks under sanitizers, in a build of their own: on request, since it takes an hour or more.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/sanitize.sh address|thread [LABEL] [--attack SECONDS]

address: address and undefined behaviour (preset asan-ubsan), all tests; thread: data races (preset tsan), the tests of engine and
pipeline. LABEL (fast, unit, system, slow) takes only those tests. --attack: mutated inputs as well (scripts/attack.sh), with address.
Exit code: 0 nothing found, 1 otherwise, 2 usage.
TEXT
}

label=
attack=
case "${1:-}" in
  address) preset=asan-ubsan ;;
  thread) preset=tsan ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac
shift
while (($# > 0)); do
  case "$1" in
    fast | unit | system | slow) label=$1; shift ;;
    --attack) attack=${2:?}; shift 2 ;;
    *) usage >&2; exit 2 ;;
  esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
if [[ $preset == tsan ]]; then targets=(values_tests estimator_tests metrics_tests runs_tests); else targets=(); fi
./scripts/build.sh "$preset" "${targets[@]}"
selected=()
if [[ -n $label ]]; then selected+=(-L "^$label\$"); fi
if [[ $preset == tsan ]]; then selected+=(-R '^(Pipeline|Parallel|LocalEngine|ForkedJob|ManyMotions|Run)'); fi
status=0
ctest --preset "$preset" "${selected[@]}" || status=1
if [[ -n $attack ]]; then
  # Sanitizers need address space without a limit, and their library first.
  export ASAN_OPTIONS=detect_leaks=0:abort_on_error=1:allocator_may_return_null=1
  python3 tests/attack/attack.py "build/$preset/fusebench" --seconds "$attack" --no-memory-limit \
    --preload "$(g++ -print-file-name=libasan.so)" --keep build/attack || status=1
fi
exit "$status"
