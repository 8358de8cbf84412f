#!/usr/bin/env bash
# Gives scripts/check_instructions.sh and scripts/update_instructions.sh a made-up valgrind and program, and expects the
# verdict that each set of counts deserves.
set -euo pipefail

scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# The program has two kernels; what they take is said by the variables FUSE and MESH, who built it by COMPILER.
mkdir -p "$tree"/{scripts,results,bin}
cp "$scripts"/{check,update}_instructions.sh "$tree/scripts/"
cat >"$tree/program" <<'TEXT'
#!/bin/sh
if [ "${1:-}" = --build ]; then
  printf 'compiler: %s\nflags: -O3\n' "${COMPILER:-GNU 12}"
else
  printf 'fuse,100,pixel\n'
  if [ -n "${MESH-2000}" ]; then printf 'mesh,10,triangle\n'; fi
fi
TEXT
cat >"$tree/bin/valgrind" <<'TEXT'
#!/bin/sh
if [ "$1" = --version ]; then echo valgrind-0; exit; fi
if [ -n "${BROKEN:-}" ]; then echo 'it broke' >&2; exit 1; fi
for argument; do
  case $argument in --callgrind-out-file=*) out=${argument#*=} ;; esac
  program=$argument
done
dump() { printf 'desc: Trigger: Client Request: %s\nsummary: 7\ntotals: %s\n' "$2" "$3" >"$out.$1"; }
dump 1 fuse "${FUSE-1000}"
if [ -n "${MESH-2000}" ]; then dump 2 mesh "${MESH-2000}"; fi
: >"$out"
"$program"
TEXT
chmod +x "$tree/program" "$tree/bin/valgrind"
export PATH=$tree/bin:$PATH
git -C "$tree" init -q
git -C "$tree" -c user.name=test -c user.email=test@example.org commit -q --allow-empty -m 'Nothing'

# expect STATUS WORDS [VARIABLE=VALUE...]: of a check with these variables; WORDS are part of what it says.
expect() {
  local status=$1 words=$2 output got=0
  shift 2
  output=$(env "$@" "$tree/scripts/check_instructions.sh" --binary "$tree/program" 2>&1) || got=$?
  if ((got != status)) || [[ $output != *"$words"* ]]; then
    printf 'with %s: exit code %d, expected %d and "%s":\n%s\n\n' "${*:-nothing changed}" "$got" "$status" "$words" \
      "$output" >&2
    failures=1
  fi
}

expect 1 'there is no results/instructions.csv'
"$tree/scripts/update_instructions.sh" 'The first counts' --binary "$tree/program" >/dev/null 2>&1
expect 0 'fuse                              1000          1000   +0.00 %   10.0 per pixel'
expect 0 '+3.00 %' FUSE=1030
expect 1 'MORE' FUSE=1031
expect 0 '-3.00 %' MESH=1940
expect 1 'LESS' MESH=1939
expect 1 'GONE' MESH=
expect 0 'compiler: the counts are of GNU 12, this is GNU 13' FUSE=2000 COMPILER='GNU 13'
expect 2 'it broke' BROKEN=1

MESH='' "$tree/scripts/update_instructions.sh" 'No mesh any more' --binary "$tree/program" >/dev/null 2>&1
expect 1 'NEW'
if [[ $(grep -c '^- 20.*, after [0-9a-f]*: ' "$tree/results/instructions_history.md") != 2 ]]; then
  printf 'the history does not have both reasons:\n%s\n' "$(cat "$tree/results/instructions_history.md")" >&2
  failures=1
fi

# Nothing of the kind is installed in a folder of just what the script needs.
mkdir "$tree/few"
for tool in bash dirname env; do ln -s "$(command -v "$tool")" "$tree/few/$tool"; done
expect 77 'skipped' PATH="$tree/few"

exit "$failures"
