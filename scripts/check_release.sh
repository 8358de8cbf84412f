#!/usr/bin/env bash
# All checks of a release (docs/release.md), one after the other.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/check_release.sh

Checks that CMakeLists.txt, CITATION.cff and CHANGELOG.md have one version and that the tree has no changes, then runs
  scripts/test.sh --odr, scripts/sanitize.sh address and thread, and scripts/check_package.sh --libraries.
Needs root, the network, and hours on two cores. Exit code: 0 all passed, 1 otherwise, 2 usage.
TEXT
}

case "${1:-}" in
  '') ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.."
version=$(sed -n 's/^project(fusebench VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
if ! grep -qx "version: $version" CITATION.cff || ! grep -q "^## \[$version\]" CHANGELOG.md; then
  printf 'check_release: CMakeLists.txt has version %s; CITATION.cff and CHANGELOG.md must have the same\n' "$version" >&2
  exit 1
fi
if [[ -n $(git status --porcelain) ]]; then
  printf 'check_release: the tree has changes; commit them first\n' >&2
  exit 1
fi
./scripts/test.sh --odr
./scripts/sanitize.sh address
./scripts/sanitize.sh thread
./scripts/build.sh release
./scripts/check_package.sh --build build/release --libraries
printf 'check_release: %s passed; tag it: git tag -a v%s -m "FuseBench %s"\n' "$version" "$version" "$version"
