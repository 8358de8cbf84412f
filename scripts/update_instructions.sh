#!/usr/bin/env bash
# Makes the instruction counts of this program the committed ones.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/update_instructions.sh "REASON" [--binary FILE]

Counts the instructions of the kernels (scripts/check_instructions.sh), shows what moved, and replaces
results/instructions.csv. The reason is added to results/instructions_history.md: it says why the counts were meant to
move.
TEXT
}

cd "$(dirname "${BASH_SOURCE[0]}")/.."
if (($# < 1)) || [[ $1 == -* || -z $1 ]]; then
  usage >&2
  exit 2
fi
reason=$1
shift
arguments=()
if [[ ${1:-} == --binary && -n ${2:-} && $# -eq 2 ]]; then
  arguments=(--binary "$2")
elif (($# > 0)); then
  usage >&2
  exit 2
fi

out=build/instructions
history=results/instructions_history.md
status=0
./scripts/check_instructions.sh "${arguments[@]}" --out "$out" || status=$?
if ((status > 1)); then exit "$status"; fi

if [[ ! -f $history ]]; then printf '# Why the instruction counts moved\n\n' >"$history"; fi
printf -- '- %s, after %s: %s\n' "$(date -u +%F)" "$(git describe --always)" "$reason" >>"$history"
cp "$out/instructions.csv" results/.instructions.csv
mv results/.instructions.csv results/instructions.csv
printf 'update_instructions: %s kernels in results/instructions.csv\n' "$(grep -c -v -e '^#' -e '^kernel,' results/instructions.csv)"
