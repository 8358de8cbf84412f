#!/usr/bin/env bash
# From a fresh checkout to the table: set-up, release build, the quickstart suite, its table.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/bench.sh [DATA] [--data DATA] [ARGUMENT...]

Installs missing packages, builds the release preset, runs configs/suites/quickstart.toml over the recordings in DATA
(default: the environment variable FUSEBENCH_DATA) into results/runs/quickstart, and prints the table.
Further arguments go to `fusebench bench`, for example: --resume, --only variant=full, --out DIR.

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
if [[ -z $data || ! -d $data ]]; then
  if [[ -n $data ]]; then printf 'bench: there is no folder %s\n' "$data" >&2; fi
  cat >&2 <<'TEXT'
bench: no recordings: download freiburg1_rpy (rgbd_dataset_freiburg1_rpy.tgz) from the TUM RGB-D page, https://cvg.cit.tum.de/data/datasets/rgbd-dataset/download, unpack it into a folder and run ./scripts/bench.sh FOLDER (or set FUSEBENCH_DATA to it).
TEXT
  exit 3
fi
data=$(cd "$data" && pwd)
if [[ -n $out ]]; then out=$(realpath -m -- "$out"); fi

cd "$(dirname "${BASH_SOURCE[0]}")/.."
./scripts/build.sh release

out=${out:-results/runs/quickstart}
status=0
build/release/fusebench bench configs/suites/quickstart.toml --data "$data" --out "$out" "${extra[@]}" || status=$?
# A failed or lost run (4) is a row of the table, so the table is still worth reading.
if ((status == 0 || status == 4)); then
  build/release/fusebench table "$out"
  printf '\nResults: %s\n' "$(realpath -m -- "$out")"
fi
exit "$status"
