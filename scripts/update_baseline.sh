#!/usr/bin/env bash
# Makes the results of this program the baseline.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/update_baseline.sh "REASON" [--binary FILE]

Runs the suite of the baseline, shows what moved, and replaces results/baseline (record.json and trajectory.tum of each
run) with it. The reason is added to results/baseline/HISTORY.md: it says why the numbers were meant to move.
TEXT
}

cd "$(dirname "${BASH_SOURCE[0]}")/.."
if (($# < 1)) || [[ $1 == -* || -z $1 ]]; then
  usage >&2
  exit 2
fi
reason=$1
shift
binary=build/release/fusebench
if [[ ${1:-} == --binary && -n ${2:-} ]]; then
  binary=$2
elif (($# > 0)); then
  usage >&2
  exit 2
fi

out=build/baseline
estimator=$("$binary" --version | sed -n 's/.*estimator \([0-9a-f]*\).*/\1/p')
runs=$out/runs/$estimator-$(cksum <configs/suites/baseline.toml | cut -d' ' -f1)
status=0
if [[ -d results/baseline ]]; then
  ./scripts/check_baseline.sh --binary "$binary" --out "$out" || status=$?
  if ((status > 1)); then exit "$status"; fi
else
  "$binary" bench configs/suites/baseline.toml --simulated "$out/simulated" --out "$runs" -j 2 --threads 1
fi

staged=$(mktemp -d results/.baseline.XXXXXX)
trap 'rm -rf "$staged"' EXIT
if [[ -f results/baseline/HISTORY.md ]]; then
  cp results/baseline/HISTORY.md "$staged/"
else
  printf '# Why the baseline moved\n\n' >"$staged/HISTORY.md"
fi
printf -- '- %s, after %s: %s\n' "$(date -u +%F)" "$(git describe --always)" "$reason" >>"$staged/HISTORY.md"
(cd "$runs" && find . -name record.json -not -path '*/.*/*' | LC_ALL=C sort) | while read -r record; do
  folder=$staged/$(dirname "$record")
  mkdir -p "$folder"
  # Which host it was is nobody's business; the CPU model says which limits hold.
  sed 's/^    "host": ".*"$/    "host": "reference"/' "$runs/$record" >"$folder/record.json"
  cp "$runs/$(dirname "$record")/trajectory.tum" "$folder/"
done
chmod -R u=rwX,go=rX "$staged"
rm -rf results/baseline
mv "$staged" results/baseline
trap - EXIT
printf 'update_baseline: %s runs in results/baseline\n' "$(find results/baseline -name record.json | wc -l)"
