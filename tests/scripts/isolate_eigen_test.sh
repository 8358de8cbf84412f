#!/usr/bin/env bash
# In the object that scripts/isolate_eigen.sh made of Ceres no function of Eigen can be taken for ours, and Ceres is still there.
set -euo pipefail

if (($# != 1)); then
  printf 'Usage: tests/scripts/isolate_eigen_test.sh OBJECT\n' >&2
  exit 2
fi
isolate=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/isolate_eigen.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

fail() {
  printf 'FAILED: %s\n' "$1" >&2
  failures=1
}

nm "$1" >"$folder/names"
shared=$(awk '$2 ~ /^[WVu]$/ && $3 ~ /Eigen/' "$folder/names" | head -n 3)
if [[ -n $shared ]]; then fail "functions of Eigen are shared: $shared"; fi
if readelf -gW "$1" | grep -q Eigen; then fail 'functions of Eigen are in groups of which a linker keeps one'; fi
grep -q ' T _ZN5ceres5Solve' "$folder/names" || fail 'ceres::Solve is gone'

# What has nothing to be made local is not what it is for.
printf 'int nothing() { return 0; }\n' >"$folder/nothing.cpp"
g++ -c "$folder/nothing.cpp" -o "$folder/nothing.o"
ar rc "$folder/nothing.a" "$folder/nothing.o"
if "$isolate" "$folder/nothing.a" "$folder/out.o" 2>"$folder/said"; then fail 'a library without Eigen is accepted'; fi
grep -q 'has no functions of Eigen' "$folder/said" || fail 'a library without Eigen is not called that'
if [[ -e $folder/out.o || -e $folder/out.o.part ]]; then fail 'a refused library leaves a file'; fi
exit "$failures"
