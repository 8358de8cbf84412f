#!/usr/bin/env bash
# Reports to git bisect whether a commit has a regression.
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: git bisect run /PATH/TO/bisect.sh BASELINE SUITE [--gates FILE.toml] [--set KEY=VALUE]... [--only KEY=VALUE]...
                                          [--ignore-options KEY]... [--data DIR] [--simulated DIR] [--jobs N]

Builds the checked-out commit (scripts/build.sh), runs SUITE (a file, or the name of a suite), and compares the runs with
those in the folder BASELINE (`bench --keep small` is enough) by `fusebench compare`. Use a copy of this script, of the
suite and of the gates outside of the tree: bisecting changes the tree. BISECT_BUILD replaces the command of the build and
BISECT_BINARY the program that it makes (build/release/fusebench).

Exit code: 0 the commit is good, 1 a gate failed, 125 the commit cannot be built or run (git skips it). 129 stops the bisection:
usage, a recording that is missing, or results that cannot be written.
TEXT
}

readonly good=0 bad=1 skip=125 stop=129  # above 127 git bisect stops

# A command without its value must not take the next option as one.
value_of() {
  if (($# < 2)) || [[ -z $2 ]]; then
    printf 'bisect: %s requires a value\n' "$1" >&2
    exit "$stop"
  fi
  printf '%s\n' "$2"
}

if [[ ${1:-} == --help || ${1:-} == -h ]]; then
  usage
  exit 0
fi
if (($# < 2)) || [[ $1 == -* || $2 == -* ]]; then
  usage >&2
  exit "$stop"
fi
baseline=$1
suite=$2
shift 2
bench=()
compare=()
while (($# > 0)); do
  value=$(value_of "$@") || exit "$stop"
  case $1 in
    --gates | --ignore-options) compare+=("$1" "$value") ;;
    --set | --only | --data | --simulated | --jobs) bench+=("$1" "$value") ;;
    *)
      printf 'bisect: unknown option %s\n' "$1" >&2
      usage >&2
      exit "$stop"
      ;;
  esac
  shift 2
done
if [[ ! -d $baseline ]]; then
  printf 'bisect: %s: no folder of runs\n' "$baseline" >&2
  exit "$stop"
fi

commit=$(git rev-parse --short=12 HEAD 2>/dev/null || printf 'unknown')
runs=$(mktemp -d "${TMPDIR:-/tmp}/fusebench_bisect.XXXXXX")
trap 'rm -rf "$runs"' EXIT
binary=${BISECT_BINARY:-build/release/fusebench}
if ! ${BISECT_BUILD:-./scripts/build.sh} >"$runs/build.log" 2>&1; then
  tail -n 5 "$runs/build.log" >&2
  printf 'bisect: %s cannot be built: skipped\n' "$commit" >&2
  exit "$skip"
fi

# With exit code 1 (a criterion failed) or 4 (a run failed or was lost), the runs are results to compare. A suite that ended early,
# for example on a full disk, has exit code 4 as well, but does not print its summary line.
"$binary" bench "$suite" "${bench[@]}" --out "$runs/new" --keep small >"$runs/bench.log" 2>&1
status=$?
if ((status == 4)) && ! grep -q ' runs ok' "$runs/bench.log"; then
  tail -n 5 "$runs/bench.log" >&2
  printf 'bisect: the suite ended before all runs were made\n' >&2
  exit "$stop"
fi
if ((status == 3)); then
  tail -n 5 "$runs/bench.log" >&2
  printf 'bisect: a recording of the suite is missing or damaged; set --data\n' >&2
  exit "$stop"
fi
if ((status != 0 && status != 1 && status != 4)); then
  tail -n 5 "$runs/bench.log" >&2
  printf 'bisect: %s cannot run the suite (exit code %d): skipped\n' "$commit" "$status" >&2
  if ((status == 130)); then exit 130; fi
  exit "$skip"
fi

"$binary" compare "$baseline" "$runs/new" "${compare[@]}"
status=$?
case $status in
  0) printf 'bisect: %s is good\n' "$commit"; exit "$good" ;;
  1) printf 'bisect: %s is bad\n' "$commit"; exit "$bad" ;;
  130) exit 130 ;;
  *)
    printf 'bisect: %s cannot be compared (exit code %d): skipped\n' "$commit" "$status" >&2
    exit "$skip"
    ;;
esac
