#!/usr/bin/env bash
# Fails on two types of one name in one namespace (see scripts/check_odr.sh, which asks the compiler, and takes minutes).
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_type_names.sh [ROOT]

Lists the structs, classes, unions and enumerations of core, datasets and eval below ROOT (default: this repository) that
stand in a namespace with a name, and prints those that are defined twice, with both places. Reads the layout that
clang-format gives: what stands in a namespace begins in the first column.
Exit code 1 if there is one, 2 if there is nothing to read.
TEXT
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
esac

cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

rooms=()
for room in core datasets eval; do
  if [[ -d $room ]]; then rooms+=("$room"); fi
done
if ((${#rooms[@]} == 0)); then
  printf 'check_type_names: nothing to check in %s\n' "$PWD" >&2
  exit 2
fi

find "${rooms[@]}" -type f \( -name '*.hpp' -o -name '*.cpp' \) -print | LC_ALL=C sort | awk '
  function define(name, place) {
    types++
    if (!(name in first)) {
      first[name] = place
    } else {
      printf "%s: %s is defined at %s as well\n", place, name, first[name]
      offences++
    }
  }
  {
    file = $0
    depth = line = 0
    while ((getline text < file) > 0) {
      line++
      if (match(text, /^(inline )?namespace [A-Za-z0-9_:]* *\{/)) {
        sub(/^(inline )?namespace /, "", text)
        sub(/ *\{.*/, "", text)
        scope[++depth] = text
      } else if (text ~ /^\}  *\/\/ *namespace/) {
        depth--
      } else if (text ~ /^(struct|class|union|enum( class| struct)?) / && (text ~ /\{/ || text !~ /;/)) {
        name = text
        sub(/^(struct|class|union|enum class|enum struct|enum) +/, "", name)
        sub(/^(\[\[[^]]*\]\]|alignas\([^)]*\)) */, "", name)
        match(name, /^[A-Za-z0-9_:]+/)
        rest = substr(name, RSTART + RLENGTH)
        name = substr(name, RSTART, RLENGTH)
        hidden = 0
        for (i = depth; i >= 1; i--) {
          if (scope[i] == "") hidden = 1
          name = scope[i] "::" name
        }
        if (!hidden && rest !~ /^</) define(name, file ":" line)  # <: a specialisation
      }
    }
    close(file)
  }
  END {
    if (!offences) printf "type names: %d, each defined once\n", types
    exit offences > 0
  }'
