#!/usr/bin/env bash
# Every check and test: formatting, include directions, references to files, a warning-free build (of every test there is),
# generated pages, 20 seconds of fuzzing and a minute of attacks, the baseline, instruction counts, tests (pages are read in headless Chromium, which
# is installed); clang-tidy on request. Runs all of them even if one fails, and ends with the tests and a summary.
# shellcheck disable=SC2317  # the checks are called through step
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/test.sh [--tidy] [--odr]

Installs missing packages, builds the preset ci (release with warnings as errors and tests) and runs every check.
  --tidy    install clang-tidy-19 if it is missing, and run it over core, datasets and eval as well (slow)
  --odr     let the linker compare the definitions of all objects as well (scripts/check_odr.sh: 7 minutes on two cores)
Tests on real recordings read the folder FUSEBENCH_DATA; where it is not set they are reported as skipped.
Exit code: 0 when everything passed, 1 otherwise.
TEXT
}

tidy=false
odr=false
for argument in "$@"; do
  case "$argument" in
    -h | --help) usage; exit 0 ;;
    --tidy) tidy=true ;;
    --odr) odr=true ;;
    *) usage >&2; exit 2 ;;
  esac
done

if [[ -n ${FUSEBENCH_DATA:-} ]]; then
  # The tests run in other folders, so a relative path would be lost.
  if [[ ! -d $FUSEBENCH_DATA ]]; then
    printf 'test: FUSEBENCH_DATA=%s is not a folder\n' "$FUSEBENCH_DATA" >&2
    exit 2
  fi
  FUSEBENCH_DATA=$(cd "$FUSEBENCH_DATA" && pwd)
  export FUSEBENCH_DATA
fi

cd "$(dirname "${BASH_SOURCE[0]}")/.."
started=$SECONDS
failures=0
summary=()
failed=()
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

# step NAME COMMAND...: runs the command, remembers how it went. 77: something optional is not installed.
step() {
  local name=$1 result=passed before=$SECONDS status=0
  shift
  printf '\n== %s\n' "$name"
  { "$@" 2>&1 | tee "$logs/$name"; status=${PIPESTATUS[0]}; } || true
  if ((status == 77)); then
    result=skipped
  elif ((status != 0)); then
    result=FAILED
    failures=$((failures + 1))
    failed+=("$name")
  fi
  summary+=("$(printf '%-20s %-7s %4d s' "$name" "$result" $((SECONDS - before)))")
}

# Prints the sources of the given folders, NUL-separated.
sources() {
  local pattern=$1
  shift
  find "$@" -type f -name "$pattern" -print0 | LC_ALL=C sort -z
}

check_scripts() {
  local script status=0
  for script in scripts/*.sh tests/scripts/*.sh tests/cli/*.sh tests/report/*.sh tests/slurm/*.sh tests/installed/*.sh tests/python/*.sh .ci/run; do
    bash -n "$script" || status=1
  done
  return "$status"
}

check_format() {
  sources '*.[ch]pp' core datasets eval tests | xargs -0 -r clang-format --dry-run -Werror
}

# Version 19 because Debian's default, 14, cannot read the C++20 headers of g++ 12 (std::source_location).
check_tidy() {
  ./scripts/setup.sh clang-tidy-19 || return 1
  sources '*.cpp' core datasets eval |
    xargs -0 -r -n 1 -P "$(nproc)" clang-tidy-19 -p build/ci --quiet --warnings-as-errors='*'
}

# Waits for them. Tests whose packages could not be installed are skipped, and say so.
packages_for_tests() {
  while [[ ! -s $logs/packages.status ]]; do sleep 0.5; done
  cat "$logs/packages.txt"
  return "$(<"$logs/packages.status")"
}

# What the checks that failed said last, then the summary: the end of a log tells what is wrong.
finish() {
  local name
  for name in "${failed[@]}"; do
    printf '\n== %s FAILED; its last lines:\n' "$name"
    tail -n 40 "$logs/$name"
  done
  if [[ -f $logs/tests ]]; then
    printf '\n== the longest tests [s]\n'
    sed -n 's/^ *[0-9]*\/[0-9]* Test *#[0-9]*: \([^ ]*\) .* \([0-9.]*\) sec *$/\2 \1/p' "$logs/tests" | LC_ALL=C sort -rn | sed -n 1,20p
  fi
  printf '\n== summary\n'
  printf '%s\n' "${summary[@]}"
  if ((failures > 0)); then
    printf '%d of %d checks FAILED in %d s\n' "$failures" "${#summary[@]}" $((SECONDS - started))
    exit 1
  fi
  printf 'all %d checks passed in %d s\n' "${#summary[@]}" $((SECONDS - started))
  exit 0
}

step set-up ./scripts/setup.sh
if ((failures > 0)); then finish; fi
# What only tests need comes while the build, which does not need it, computes.
{
  ./scripts/setup.sh clang-19 libclang-rt-19-dev llvm-19 chromium-driver python3-selenium slurm-wlm munge iproute2 \
    >"$logs/packages.txt" 2>&1 && status=0 || status=$?
  printf '%d\n' "$status" >"$logs/packages.status"
} &
step scripts check_scripts
step formatting check_format
step includes ./scripts/check_includes.py
step references ./scripts/check_references.sh
step links ./scripts/check_links.py
step type-names ./scripts/check_type_names.sh
step words ./scripts/check_words.py --check core datasets eval
step planted-faults ./scripts/plant_faults.py --check
step build ./scripts/build.sh ci
step test-packages packages_for_tests
if [[ ${summary[-1]} == *FAILED* ]]; then finish; fi
step tests-built ./scripts/check_tests_built.sh build/ci
step build-cost ./scripts/check_build_cost.py
step generated-docs ./scripts/generate_docs.sh --check build/ci/fusebench
if $tidy; then step clang-tidy check_tidy; fi
if $odr; then step one-definition ./scripts/check_odr.sh; fi
step fuzz ./scripts/fuzz.sh 20
step attack ./scripts/attack.sh --seconds 50
step baseline ./scripts/check_baseline.sh --binary build/ci/fusebench
step instructions ./scripts/check_instructions.sh
step tests ctest --preset ci
finish
