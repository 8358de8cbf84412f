#!/usr/bin/env bash
# Mutated inputs of every kind on every verb (tests/attack/attack.py says what is checked), and the cases that were found before.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/attack.sh [--seconds N | --count N] [--seed S] [--workers N] [--only KIND] [--binary FILE]

First replays the kept cases (tests/attack/corpus), then draws new ones for N seconds (default 60) or until there were N. KIND is
recording, trajectory, mesh, text (TOML), runs, archive or options. Findings are printed and kept in build/attack as cases that
  tests/attack/attack.py BINARY --replay FILE.json
runs again. Default of --binary: build/ci/fusebench, of the preset ci (scripts/build.sh ci).
Exit code: 0 nothing found, 1 findings, 2 usage.
TEXT
}

binary=build/ci/fusebench
arguments=()
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --binary) binary=${2:?}; shift 2 ;;
    --seconds | --count | --seed | --workers | --only)
      if (($# < 2)); then usage >&2; exit 2; fi
      arguments+=("$1" "$2")
      shift 2
      ;;
    *) usage >&2; exit 2 ;;
  esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
status=0
python3 tests/attack/attack.py "$binary" --replay tests/attack/corpus/*.json || status=1
python3 tests/attack/attack.py "$binary" --keep build/attack "${arguments[@]}" || status=1
exit "$status"
