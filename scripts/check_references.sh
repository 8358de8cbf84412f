#!/usr/bin/env bash
# Fails on a path in a document, comment or script that names a file of the repository that is not there.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_references.sh [ROOT]

Reads the text files below ROOT (default: this repository) and checks that there is
  - every path that begins with core/, datasets/, eval/, tests/, scripts/, docs/, configs/ or .ci/ and ends in a
    file's extension: from ROOT on, or from the folder of the file that names it
  - every target of a relative link of a Markdown file
NAME in a path stands for any name. Not read: CMakeLists.txt (the build does that), results, golden files, inputs of the
fuzz targets, and tests/scripts, whose files are made up.
Prints file:line and the path for each that is missing; exit code 1 if there is one.
TEXT
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
esac
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

# Prints the text files, NUL-separated; of a checkout only what git knows, or would add.
texts() {
  if git rev-parse --show-cdup 2>/dev/null | grep -qx ''; then
    git ls-files -z --cached --others --exclude-standard
  else
    find . -type f -printf '%P\0'
  fi | LC_ALL=C sort -z -u |
    grep -zvE '(^|/)CMakeLists\.txt$|^(results|build|tests/(scripts|golden|fuzz/corpus))/|^\.git/' |
    grep -zE '\.(hpp|cpp|in|md|sh|py|js|css|cmake|toml|txt|json|yml|yaml|cff)$|^\.ci/|^\.clang'
}

# Prints FILE:LINE:PATH of what could be a reference.
references() {
  local rooms='core|datasets|eval|tests|scripts|docs|configs|\.ci'
  local extensions='hpp|cpp|in|md|sh|py|js|css|cmake|toml|txt|json|csv|ply|yml|html'
  local path="(?<![A-Za-z0-9_./\${}<>*~-])(?:\./)?\K(?:$rooms)/[A-Za-z0-9_./-]*\.(?:$extensions)(?![A-Za-z0-9_*{-])"
  local status=0
  texts | xargs -0 -r grep -HnoP -- "$path" || status=$?
  ((status <= 1 || status == 123)) || return "$status"
  texts | { grep -zE '\.md$' || true; } | xargs -0 -r grep -HnoP -- '\]\(\K[^)#:\s]+(?=(#[^)]*)?\))' || true
}

missing=0
checked=0
while IFS=: read -r file line path; do
  checked=$((checked + 1))
  [[ $path != *NAME* ]] || continue
  [[ ! -e $path && ! -e $(dirname "$file")/$path ]] || continue
  printf '%s:%s: there is no %s\n' "$file" "$line" "$path"
  missing=$((missing + 1))
done < <(references | LC_ALL=C sort -u)

if ((missing > 0)); then exit 1; fi
if ((checked == 0)); then
  printf 'check_references: nothing to check in %s\n' "$PWD" >&2
  exit 2
fi
printf 'references: %d, all to files that are there\n' "$checked"
