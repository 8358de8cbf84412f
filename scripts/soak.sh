#!/usr/bin/env bash
# Many runs in one engine, and a long recording in one run: does anything grow? tests/soak/soak.py measures.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/soak.sh [--count N] [--minutes N] [-j N] [--binary FILE]

N runs (default 1000; 10000 take some minutes) of a tiny recording, N at a time, and a simulated recording of so many minutes
(default 5) in one run. Samples of memory and descriptors go to build/soak/runs.csv and recording.csv.
Exit code: 0 nothing grows, 1 something does, 2 usage.
TEXT
}

binary=build/ci/fusebench
count=1000
minutes=5
jobs=1
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --count) count=${2:?}; shift 2 ;;
    --minutes) minutes=${2:?}; shift 2 ;;
    -j) jobs=${2:?}; shift 2 ;;
    --binary) binary=${2:?}; shift 2 ;;
    *) usage >&2; exit 2 ;;
  esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
status=0
python3 tests/soak/soak.py "$binary" runs --count "$count" -j "$jobs" || status=1
python3 tests/soak/soak.py "$binary" recording --minutes "$minutes" || status=1
exit "$status"
