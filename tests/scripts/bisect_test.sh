#!/usr/bin/env bash
# scripts/bisect.sh finds the commit of a planted regression in a small history, skips what cannot be built or run, and stops
# git bisect at a mistake.
set -uo pipefail

bisect=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)/bisect.sh
if ! command -v git >/dev/null; then
  printf 'skipped: git is not installed\n'
  exit 77
fi
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree" || exit 2
failures=0

complain() {
  failures=$((failures + 1))
  printf 'FAILED: %s\n' "$1" >&2
}

# Stands for fusebench: a run is the file `number` of the commit, and a larger number is a regression.
cat >program <<'TEXT'
#!/usr/bin/env bash
printf '%s\n' "$*" >>"$KEPT"
case $1 in
  bench)
    case $(cat number) in
      broken) exit 2 ;;
      absent) exit 3 ;;
      full) exit 4 ;;
    esac
    for ((i = 1; i <= $#; ++i)); do
      if [[ ${!i} == --out ]]; then next=$((i + 1)); out=${!next}; fi
    done
    mkdir -p "$out" && cp number "$out/"
    if [[ $(cat number) == 3 ]]; then printf 'suite: 0 of 1 runs ok\n'; exit 4; fi
    ;;
  compare) (($(cat "$3/number") <= $(cat "$2/number"))) ;;
esac
TEXT
# shellcheck disable=SC2016  # of the program that is written
printf '#!/usr/bin/env bash\n[[ $(cat number) != uncompilable ]]\n' >build
chmod +x program build
mkdir baseline
printf '1\n' >baseline/number
export KEPT=$tree/calls BISECT_BINARY=$tree/program BISECT_BUILD=$tree/build

mkdir history && cd history || exit 2
git -c init.defaultBranch=main init -q .
git config user.name test
git config user.email test@example.org
for number in 1 1 uncompilable 1 broken 1 5 5 5; do
  printf '%s\n' "$number" >number
  git add number
  git commit -q --allow-empty -m "number $number"
done
expected=$(git rev-parse HEAD~2)

git bisect start HEAD HEAD~8 >/dev/null 2>&1
git bisect run "$bisect" "$tree/baseline" suite --set a=1 --data d --gates g.toml --ignore-options b >found 2>errors ||
  complain "git bisect run: exit code $?: $(tail -n 3 found errors)"
[[ $(git rev-parse refs/bisect/bad 2>/dev/null) == "$expected" ]] || complain "the wrong commit: $(tail -n 3 found)"
git bisect reset >/dev/null 2>&1
grep -qE '^bench suite --set a=1 --data d --out .* --keep small$' "$KEPT" || complain "options of bench: $(head -n 1 "$KEPT")"
grep -qE "^compare $tree/baseline .*/new --gates g.toml --ignore-options b\$" "$KEPT" || complain "options of compare: $(tail -n 1 "$KEPT")"

# expect CODE NUMBER ARGUMENT...: of one call where the commit has that number.
expect() {
  local code=$1 status=0
  printf '%s\n' "$2" >number
  shift 2
  "$bisect" "$@" >stdout 2>stderr || status=$?
  if ((status != code)); then complain "bisect.sh $*: exit code $status instead of $code: $(cat stderr)"; fi
}
expect 0 1 "$tree/baseline" suite
expect 1 2 "$tree/baseline" suite
expect 125 uncompilable "$tree/baseline" suite
expect 125 broken "$tree/baseline" suite
expect 1 3 "$tree/baseline" suite
expect 129 absent "$tree/baseline" suite
expect 129 full "$tree/baseline" suite
expect 129 1 "$tree/absent" suite
expect 129 1 "$tree/baseline"
expect 129 1 "$tree/baseline" suite --unknown 1
expect 129 1 "$tree/baseline" suite --gates
expect 0 1 --help
[[ -z $(find "${TMPDIR:-/tmp}" -maxdepth 1 -name 'fusebench_bisect.*' -newer "$tree/program" 2>/dev/null) ]] || complain 'its runs are left'

if ((failures > 0)); then exit 1; fi
printf 'bisect: passed\n'
