#!/usr/bin/env bash
# An installation: programs build against it with find_package(fusebench), the one that uses metrics alone without the
# libraries of the estimator; the program finds its suites; manual pages and completions are there, for every verb.
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: tests/installed/installed_test.sh BUILD_FOLDER CMAKE
TEXT
}

if (($# != 2)); then
  usage >&2
  exit 2
fi
build=$(realpath -- "$1")
cmake=$2
sources=$(realpath -- "$(dirname "${BASH_SOURCE[0]}")")
unset FUSEBENCH_DATA

work=$(realpath -- "$(mktemp -d)")
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
failed() {
  printf 'FAILED: %s\n' "$1" >&2
  if [[ -s log ]]; then tail -20 log | sed 's/^/    /' >&2; fi
  exit 1
}

"$cmake" --install "$build" --prefix "$work/usr" >log 2>&1 || failed "it cannot be installed"

# build_and_run PART ARGUMENT...: its output is in the file PART.out. To be called in a process of its own.
build_and_run() {
  local part=$1
  shift
  mkdir "$part" && cd "$part" || exit 1
  "$cmake" -G Ninja -S "$sources" -B build -DPART="$part" -DCMAKE_PREFIX_PATH="$work/usr" "$@" >log 2>&1 ||
    failed "the program with the $part cannot be configured"
  "$cmake" --build build >log 2>&1 || failed "the program with the $part cannot be built"
  "build/$part" >"../$part.out" 2>log || failed "the program with the $part fails"
}
without=()
for package in Ceres PNG ZLIB embree tinyobjloader CLI11 nlohmann_json; do
  without+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
build_and_run metrics "${without[@]}" &
metrics=$!
(build_and_run estimator) || exit 1
wait "$metrics" || exit 1
[[ $(<metrics.out) == "pairs 400 ate_mm 10.0" ]] || failed "metrics print: $(<metrics.out)"
expected=$'initialised x_mm 0\ntracked x_mm 5\ntracked x_mm 10\ntracked x_mm 15'
[[ $(<estimator.out) == "$expected" ]] || failed "the estimator prints: $(<estimator.out)"

# The word after find_package is one that people mistype.
if "$cmake" -G Ninja -S "$sources" -B wrong -DPART=metric -DCMAKE_PREFIX_PATH="$work/usr" >log 2>&1; then
  failed "a component that there is not is found"
fi
grep -q 'metric.*metrics' log || failed "an unknown component is refused without the names of those that there are"

program=$work/usr/bin/fusebench
"$program" list suites >suites 2>log || failed "the installed program does not find its suites"
grep -q "^quickstart .*$work/usr/share/fusebench/configs/suites/quickstart.toml" suites || failed "no suite quickstart"

# help_of WORD...: the help text of a verb, asked for once.
mkdir help
help_of() {
  local file="help/${*:-fusebench}"
  [[ -s $file ]] || "$program" "$@" --help >"$file"
  cat "$file"
}

# verbs_of WORD...: every verb below it, by the help texts.
verbs_of() {
  local verb
  printf '%s\n' "fusebench${*:+ $*}"
  while read -r verb; do
    verbs_of "$@" "$verb"
  done < <(help_of "$@" |
    awk '/^Subcommands:/ { inside = 1; next } inside && /^[^ ]/ { inside = 0 } inside && /^  [a-z]/ { print $1 }')
}
verbs_of >verbs
(($(wc -l <verbs) > 25)) || failed "there are too few verbs"
# shellcheck source=/dev/null
source "$work/usr/share/bash-completion/completions/fusebench"
zsh=$(<"$work/usr/share/zsh/vendor-completions/_fusebench")
while read -r -a words; do
  page=$work/usr/share/man/man1/$(IFS=-; printf '%s' "${words[*]}").1.gz
  [[ -s $page ]] || failed "there is no manual page of ${words[*]}"
  page=$(gzip -dc "$page" | sed 's/\\-/-/g')
  COMP_WORDS=("${words[@]}" -) COMP_CWORD=${#words[@]}
  _fusebench
  proposed=" ${COMPREPLY[*]} "
  while read -r flag; do
    [[ $proposed == *" $flag "* ]] || failed "bash does not complete $flag of ${words[*]}"
    [[ $page == *"$flag"* ]] || failed "the manual page of ${words[*]} lacks $flag"
    [[ $zsh == *"$flag"?([=+])'['* ]] || failed "zsh does not know $flag"
  done < <(help_of "${words[@]:1}" | sed -nE 's/^  (-[-a-z0-9_,]+).*/\1/p' | tr ',' '\n')
done <verbs
if command -v zsh >/dev/null; then
  zsh -n "$work/usr/share/zsh/vendor-completions/_fusebench" 2>log || failed "zsh does not understand its completion"
fi

if grep -E '(Needs|Excludes)\\:' "$work/usr/share/zsh/vendor-completions/_fusebench" >log; then
  failed "zsh takes what an option needs for a part of its value"
fi

# expect PROPOSALS WORD...: what bash proposes for the last word.
expect() {
  local wanted=$1 proposed
  shift
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
  _fusebench
  proposed=$(printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort | paste -s -d ' ')
  [[ $proposed == "$wanted" ]] || failed "'$*' is completed to '$proposed'"
}
mkdir recordings
touch recordings.txt
expect "report reproduce rerun run" fusebench r
expect "report" fusebench help repo
expect "aie ape ate" fusebench eval a
expect "--align --align_origin" fusebench eval ape tum gt.txt est.txt --ali
expect "none origin scale se3 sim3 yaw" fusebench eval ape gt.txt est.txt --align ""
expect "recorded" fusebench run --imu r
expect "recorded" fusebench run --imu = r
expect "auto recorded synthetic" fusebench run --imu =
expect "no-imu" fusebench run recordings --variant no-i
expect "tsdf.voxel_m=" fusebench run --set tsdf.vox
expect "variants" fusebench list v
expect "zsh" fusebench completion z
expect "recordings" fusebench run --data rec
expect "recordings recordings.txt" fusebench run rec
expect "--imu" fusebench run recordings --json --im
