#!/usr/bin/env bash
# Runs the suite of the baseline and compares it with the committed results.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_baseline.sh [--binary FILE] [--out DIR] [ARGUMENT...]

Runs configs/suites/baseline.toml (about a minute; finished runs of this very program are not repeated) and compares it
with results/baseline, exactly on the CPU model of the baseline and with the wider limits of configs/gates_other_cpu.toml
on others. Further arguments go to `fusebench compare`, for example: --format markdown, --all.
  --binary FILE  default: build/release/fusebench
  --out DIR      of the runs; default: build/baseline
Exit codes: 0 nothing moved; 1 something did; otherwise those of `fusebench`.
TEXT
}

cd "$(dirname "${BASH_SOURCE[0]}")/.."
binary=build/release/fusebench
out=build/baseline
arguments=()
while (($# > 0)); do
  case $1 in
    --help | -h)
      usage
      exit 0
      ;;
    --binary | --out)
      if (($# < 2)); then
        printf 'check_baseline: %s needs a value\n' "$1" >&2
        exit 2
      fi
      if [[ $1 == --binary ]]; then binary=$2; else out=$2; fi
      shift 2
      ;;
    *)
      arguments+=("$1")
      shift
      ;;
  esac
done

# cpu_of FOLDER: the CPU model of its runs.
cpu_of() {
  find "$1" -name record.json -not -path '*/.*/*' -exec sed -n 's/^    "cpu": "\(.*\)",$/\1/p' {} + | sort -u
}

estimator=$("$binary" --version | sed -n 's/.*estimator \([0-9a-f]*\).*/\1/p')
if [[ -z $estimator ]]; then
  printf 'check_baseline: %s does not tell the version of its estimator\n' "$binary" >&2
  exit 2
fi
# A suite that changed leaves no runs of the old one beside the new ones.
runs=$out/runs/$estimator-$(cksum <configs/suites/baseline.toml | cut -d' ' -f1)
"$binary" bench configs/suites/baseline.toml --simulated "$out/simulated" --out "$runs" -j 2 --threads 1 >&2
gates=configs/gates.toml
if [[ $(cpu_of "$runs") != "$(cpu_of results/baseline)" ]]; then
  printf 'check_baseline: the baseline was made on another CPU model; the limits are wider\n' >&2
  gates=configs/gates_other_cpu.toml
fi
"$binary" compare results/baseline "$runs" --gates "$gates" "${arguments[@]}"
