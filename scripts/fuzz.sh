#!/usr/bin/env bash
# Fuzzes the text readers: set-up, the preset fuzz, then every target of tests/fuzz for an equal share of the time.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/fuzz.sh [SECONDS [SEED]]

Installs clang 19 and its symbolizer if they are missing, builds the preset fuzz and runs each target of tests/fuzz with libFuzzer, one per
core at a time; SECONDS (default 60) is the time for all of them, without the build. SEED (default 1) makes a run from the
same inputs repeat itself, as far as the time allows; 0 is a new one each time. Inputs start from
tests/fuzz/corpus/TARGET; new ones are kept in build/fuzz/corpus/TARGET and used again the next time.
An input that breaks a target is kept in build/fuzz/crashes/TARGET; build/fuzz/logs/TARGET.txt says why. To see it again:
  build/fuzz/tests/fuzz/fuzz_TARGET FILE
Once repaired, the input belongs into tests/fuzz/corpus/TARGET, where the tests replay it.
Exit code: 0 when nothing broke, 1 otherwise.
TEXT
}

seconds=60
case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  '') ;;
  *[!0-9]*) usage >&2; exit 2 ;;
  *) seconds=$1 ;;
esac
seed=${2:-1}
if (($# > 2)) || [[ $seed == *[!0-9]* ]]; then
  usage >&2
  exit 2
fi

cd "$(dirname "${BASH_SOURCE[0]}")/.."
./scripts/setup.sh clang-19 libclang-rt-19-dev llvm-19
./scripts/build.sh fuzz

# Without what is only replayed (tests/fuzz/corpus_test.cpp).
mapfile -t targets < <(cd tests/fuzz/corpus && printf '%s\n' * | grep -vx 'record\|gates')
jobs=$(nproc)
rounds=$(((${#targets[@]} + jobs - 1) / jobs))
share=$((seconds / rounds > 0 ? seconds / rounds : 1))

# Memory is bounded: 256 MB at once, 1 GB in all (AddressSanitizer's own included), for inputs of up to 64 KB.
fuzz() {
  local target=$1 seconds=$2 seed=$3
  local crashes=build/fuzz/crashes/$target found=build/fuzz/corpus/$target log=build/fuzz/logs/$target.txt
  mkdir -p "$crashes" "$found" build/fuzz/logs
  local before status=0
  before=$(find "$crashes" -type f | wc -l)
  build/fuzz/tests/fuzz/"fuzz_$target" "$found" "tests/fuzz/corpus/$target" -max_total_time="$seconds" -seed="$seed" \
    -max_len=65536 -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=256 -print_final_stats=1 \
    -dict=tests/fuzz/tokens.dict -artifact_prefix="$crashes/" >"$log" 2>&1 || status=$?
  local runs
  runs=$(awk '/^stat::number_of_executed_units:/ { print $2 }' "$log")
  printf '%-18s %9s runs, %d new crash input(s)\n' "$target" "${runs:-?}" \
    $(($(find "$crashes" -type f | wc -l) - before))
  if ((status != 0)); then
    grep -E -m 3 'ERROR|what\(\)|runtime error' "$log" || tail -n 5 "$log"
    return 1
  fi
}
export -f fuzz

printf 'fuzzing %d targets, %d at a time, %d s each\n' "${#targets[@]}" "$jobs" "$share"
# shellcheck disable=SC2016  # expanded by the inner shell
printf '%s\n' "${targets[@]}" | xargs -P "$jobs" -I '{}' bash -c 'fuzz "$1" "$2" "$3"' fuzz '{}' "$share" "$seed" || exit 1
