#!/usr/bin/env bash
# The Markdown files of the repository have no dead link; in a small tree with planted ones, scripts/check_links.py finds each.
set -euo pipefail

check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/check_links.py
if ! command -v python3 >/dev/null; then
  printf 'skipped: python3 is not installed\n'
  exit 77
fi
"$check"
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# expect STATUS WORDS TEXT: of a page docs/page.md beside docs/other.md; WORDS are part of what the check says.
expect() {
  local output status=0
  mkdir -p "$tree/docs"
  printf '# Title\n\n## A heading: `code`, and more\n\n## Twice\n\n## Twice\n\n```\n# no heading\n```\n' >"$tree/docs/other.md"
  printf '%b\n' "$3" >"$tree/docs/page.md"
  output=$("$check" "$tree" 2>&1) || status=$?
  if ((status != $1)) || [[ $output != *"$2"* ]]; then
    printf '%b\nexit code %d and "%s", expected %d and "%s"\n' "$3" "$status" "$output" "$1" "$2" >&2
    failures=1
  fi
}

expect 0 '2 links in 2 files, 0 dead' '[a](other.md) and [b](other.md#a-heading-code-and-more)'
expect 0 '2 links' '[a](other.md#twice) [b](other.md#twice-1)'
expect 0 '1 links' '# Here\n[a](#here)'
expect 0 '0 links' '[a](https://example.org/x.md) `[b](gone.md)`\n\n    [c](gone.md)\n\n```\n[d](gone.md)\n```'
expect 0 '1 links' '- a list\n    that [goes](other.md) on'
expect 1 'docs/page.md:3: gone.md: there is no such file' 'a\n\n[b](gone.md)'
expect 1 'other.md#gone: no heading of docs/other.md' '[a](other.md#gone)'
expect 1 'other.md#no-heading' '[a](other.md#no-heading)'
expect 1 'other.md#twice-2' '[a](other.md#twice-2)'
expect 1 '#gone: no heading of docs/page.md' '[a](#gone)'
expect 1 'outside of the repository' '[a](../../)'
expect 1 '2 links in 2 files, 1 dead' '![a](gone.png) [b](other.md)'
exit "$failures"
