#!/usr/bin/env bash
# From a fresh checkout to the table: set-up, release build, the quickstart suite, its table.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/bench.sh [DATA] [--data DATA] [ARGUMENT...]

Installs missing packages, builds the release preset, runs configs/suites/quickstart.toml over the recordings in DATA
(default: the environment variable FUSEBENCH_DATA) into results/runs/quickstart, and prints the table. Without DATA it
simulates two recordings first (slow and fast motion, in results/simulated; made once) and runs over them.
Further arguments go to `fusebench bench`, for example: -j 2, --only variant=full, --out DIR.

Exit codes are those of `fusebench bench`: 0 ok, 2 usage, 3 data missing or corrupt, 4 a run failed or was lost.
TEXT
}

start_dir=$PWD
data=${FUSEBENCH_DATA:-}
out=
extra=()
if (($# > 0)) && [[ $1 != -* ]]; then
  data=$1
  shift
fi
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --data | --out)
      if (($# < 2)); then
        printf 'bench: %s needs a folder\n' "$1" >&2
        exit 2
      fi
      if [[ $1 == --data ]]; then data=$2; else out=$2; fi
      shift
      ;;
    --data=*) data=${1#--data=} ;;
    --out=*) out=${1#--out=} ;;
    *) extra+=("$1") ;;
  esac
  shift
done

# Before minutes of building: is there anything to run on?
cd "$start_dir"
if [[ -n $data ]]; then
  if [[ ! -d $data ]]; then
    printf 'bench: there is no folder %s; name the folder of recordings, or none to simulate some\n' "$data" >&2
    exit 3
  fi
  data=$(cd "$data" && pwd)
fi
if [[ -n $out ]]; then out=$(realpath -m -- "$out"); fi

cd "$(dirname "${BASH_SOURCE[0]}")/.."
./scripts/build.sh release

fusebench=build/release/fusebench

# Simulated recordings are the same bytes each time, and `simulate` leaves alone what is there already.
simulate_recordings() {
  local preset
  for preset in slow fast; do
    "$fusebench" simulate --preset "$preset" --format zr300 --seed 1 --duration 5 --out "$data/simulated_zr300_$preset" \
      >/dev/null
  done
}

name=quickstart
if [[ -z $data ]]; then
  printf 'bench: no recordings are given, so two are simulated (slow and fast motion)\n' >&2
  name=simulated
  data=results/simulated
  simulate_recordings
fi

out=${out:-results/runs/$name}
status=0
"$fusebench" bench configs/suites/quickstart.toml --data "$data" --out "$out" "${extra[@]}" || status=$?
# A failed or lost run (4) is a row of the table, so the table is still worth reading.
if ((status == 0 || status == 4)); then
  "$fusebench" table "$out"
  "$fusebench" report "$out" --data "$data" --out "$out/report.html" --title "FuseBench: $name"
  printf '\nResults: %s\n' "$(realpath -m -- "$out")"
fi
exit "$status"
