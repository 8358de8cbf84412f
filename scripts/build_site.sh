#!/usr/bin/env bash
# The documentation as a site that can be searched, from the same Markdown files, with Debian's MkDocs.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/build_site.sh [FOLDER]

Writes the site to FOLDER (default: build/site/site): README.md, docs/, results/README.md and what these link to. A page that
is in no menu, or a dead link, is an error. To read and search it:
  python3 -m http.server --directory build/site/site
Needs the package mkdocs (apt-get install mkdocs); exit code 77 where it is not installed. The links themselves are checked without it
by scripts/check_links.py.
TEXT
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
esac
out=${1:+$(realpath -m -- "$1")}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if ! command -v mkdocs >/dev/null; then
  printf 'build_site: skipped: mkdocs is not installed (apt-get install mkdocs)\n' >&2
  exit 77
fi

# The pages lie in the site as they do in the repository, so that their links are right as they are.
stage=build/site
rm -rf "$stage/pages"
mkdir -p "$stage/pages"
cp scripts/mkdocs.yml "$stage/mkdocs.yml"
{
  printf '%s\n' README.md CONTRIBUTING.md CHANGELOG.md
  find docs results -maxdepth 1 -name '*.md'
  ./scripts/check_links.py --list README.md CONTRIBUTING.md CHANGELOG.md docs/*.md results/*.md
} | LC_ALL=C sort -u | while read -r file; do
  install -D -m 644 "$file" "$stage/pages/$file"
done
for page in "$stage"/pages/docs/*.md; do
  if ! grep -q ": docs/$(basename "$page")\$" scripts/mkdocs.yml; then
    printf 'build_site: docs/%s is in no menu of scripts/mkdocs.yml\n' "$(basename "$page")" >&2
    exit 1
  fi
done
mkdocs build --strict --config-file "$stage/mkdocs.yml" --site-dir "${out:-$PWD/$stage/site}"
printf 'build_site: %s\n' "${out:-$PWD/$stage/site}/index.html"
