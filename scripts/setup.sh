#!/usr/bin/env bash
# Installs the Debian packages of scripts/packages.txt, and those named as arguments, that are missing.
# Does nothing when all are there.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/setup.sh [PACKAGE...]

Installs what is missing of scripts/packages.txt, and of the packages named, with apt-get (through sudo when not
root). Without anything missing it changes nothing and needs neither network nor rights.
TEXT
}

die() {
  printf 'setup: %s\n' "$1" >&2
  exit 2
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
esac

scripts_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mapfile -t wanted < <(awk '{ sub(/#.*/, "") } NF { print $1 }' "$scripts_dir/packages.txt")
wanted+=("$@")

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  die "this is not a Debian-like system; install the counterparts of these packages yourself, then build with
  cmake --preset release && cmake --build --preset release
packages: ${wanted[*]}"
fi

# dpkg-query knows only packages that it has heard of and complains about the others: those are missing too.
installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' "${wanted[@]}" 2>/dev/null || true)
mapfile -t missing < <(printf '%s\n' "${wanted[@]}" |
  awk -v list="$installed" '
    BEGIN {
      count = split(list, lines, "\n")
      for (i = 1; i <= count; i++) if (substr(lines[i], 2, 1) == "i") { split(lines[i], part, " "); have[part[2]] }
    }
    !($1 in have)')

if ((${#missing[@]} == 0)); then
  printf 'setup: all %d packages are installed\n' "${#wanted[@]}" >&2
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || die "run as root, or install sudo: these packages are missing: ${missing[*]}"
  as_root=(sudo)
fi
printf 'setup: installing %s\n' "${missing[*]}" >&2
as_root+=(env DEBIAN_FRONTEND=noninteractive)
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}"
