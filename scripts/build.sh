#!/usr/bin/env bash
# Set-up, then configure and build one CMake preset into build/<preset>.
set -euo pipefail

usage() {
  cat <<'TEXT'
Usage: scripts/build.sh [PRESET [TARGET...]]

Installs missing packages (scripts/setup.sh), then configures and builds a preset of CMakePresets.json into
build/PRESET, or the targets alone. The default is release; the others are debug, asan-ubsan, tsan, bench and ci. ccache is
used if present.
TEXT
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
esac
preset=${1:-release}
targets=("${@:2}")
if ((${#targets[@]} > 0)); then targets=(--target "${targets[@]}"); fi

cd "$(dirname "${BASH_SOURCE[0]}")/.."
./scripts/setup.sh

if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
# Only warnings and errors: the libraries' configuration prints pages of status lines. Progress is not a result, so
# it goes to standard error.
cmake --preset "$preset" --log-level=WARNING >&2
cmake --build --preset "$preset" --parallel "$(nproc)" "${targets[@]}" >&2
