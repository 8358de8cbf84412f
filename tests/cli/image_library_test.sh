#!/usr/bin/env bash
# Which files the program loads: OpenImageIO for the JPEGs of a page, and not for plain PNGs; an installed program takes its
# module from the installation.
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: tests/cli/image_library_test.sh BINARY GOLDEN_TUM_FOLDER BUILD_FOLDER CMAKE
TEXT
}

if (($# != 4)); then
  usage >&2
  exit 2
fi
binary=$(realpath -- "$1")
golden=$(realpath -- "$2")
build=$(realpath -- "$3")
cmake=$4
unset FUSEBENCH_DATA

work=$(realpath -- "$(mktemp -d)")
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2

failed() {
  printf 'FAILED: %s\n' "$1" >&2
  if [[ -s stderr ]]; then sed 's/^/    stderr: /' stderr >&2; fi
  exit 1
}

# libraries_of PROGRAM ARGUMENT...: runs it; the paths of what it loaded, at its start or later, are in the file loaded.
libraries_of() {
  rm -f linker.*
  LD_DEBUG=files LD_DEBUG_OUTPUT=linker "$@" >stdout 2>stderr || failed "exit code $? of $*"
  sed -n 's/^ *[0-9]*:\tcalling init: //p' linker.* >loaded
  grep -q '/libc\.so' loaded || failed "the dynamic linker does not say what it loads"
}

libraries_of "$binary" inspect "$golden"
grep -q 'OpenImageIO\|fusebench_images' loaded && failed "looking at plain PNGs loads OpenImageIO"
# Its patches are kept as images.
libraries_of "$binary" run "$golden" --variant no-imu --out out --threads 2
find out -name '*.png' | grep -q . || failed "no images of patches are kept"
grep -q 'OpenImageIO\|fusebench_images' loaded && failed "a run over plain PNGs loads OpenImageIO"

"$cmake" --install "$build" --prefix "$work/installed" >stdout 2>stderr || failed "it cannot be installed"
libraries_of installed/bin/fusebench inspect "$golden" --page page.html
grep -q 'OpenImageIO' loaded || failed "no image library is loaded for the pictures of a page"
module=$(grep '/fusebench_images\.so$' loaded)
[[ $(realpath -- "$module") == "$work"/installed/*/fusebench/fusebench_images.so ]] ||
  failed "the installed program takes its module from '$module'"
