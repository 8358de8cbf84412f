#!/usr/bin/env bash
# The Python module of runs, on a run of the golden recording.
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: tests/python/python_test.sh BINARY GOLDEN_TUM_FOLDER
TEXT
}

if (($# != 2)); then
  usage >&2
  exit 2
fi
if ! command -v python3 >/dev/null; then
  printf 'skipped: python3 is not installed\n'
  exit 77
fi
work=$(realpath -- "$(mktemp -d)")
trap 'rm -rf "$work"' EXIT
"$1" run "$2" --variant no-imu --set patches.size_px=12 --threads 2 --out "$work/runs" >"$work/log" 2>&1 || {
  cat "$work/log" >&2
  exit 1
}
FUSEBENCH_ROOT=$(realpath -- "$(dirname "${BASH_SOURCE[0]}")/../..")
export FUSEBENCH_ROOT FUSEBENCH_RUNS=$work/runs
PYTHONDONTWRITEBYTECODE=1 python3 -W error "$FUSEBENCH_ROOT/tests/python/test_fusebench_runs.py"
