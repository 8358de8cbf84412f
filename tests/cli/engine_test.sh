#!/usr/bin/env bash
# The engine from outside: a sweep that is killed again and again, that meets a full disk and a read-only folder, and two
# engines on one folder all end with the bytes of an undisturbed one.
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: tests/cli/engine_test.sh BINARY kills|disks|engines|verbs|streams [RUNS]
RUNS: of the sweep; default 200.
TEXT
}

if (($# < 2)); then
  usage >&2
  exit 2
fi
binary=$(realpath -- "$1")
group=$2
runs=${3:-200}
unset FUSEBENCH_DATA

work=$(mktemp -d)
mounted=
tidy() {
  if [[ -n $mounted ]]; then umount "$mounted"; fi
  rm -rf "$work"
}
trap tidy EXIT
cd "$work" || exit 2
failures=0

complain() {
  failures=$((failures + 1))
  printf 'FAILED: %s\n' "$1" >&2
  if [[ -s stderr ]]; then tail -n 5 stderr | sed 's/^/    stderr: /' >&2; fi
}

cat >tiny.toml <<TEXT
name = "tiny"
variants = ["no-imu"]
keep = "small"
frames = "0:2"
[config]
iekf.min_patches = 1  # so few are in so small images
[[simulations]]
name = "tiny"
format = "tum"
preset = "slow"
start = "motion"
seed = 1
duration_s = 0.1
size = "160x120"
blur_samples = 1
[[sweep]]
design = "latin-hypercube"
samples = $runs
tsdf.voxel_m = { from = 0.01, to = 0.02 }
iekf.max_iterations = { from = 1, to = 8 }
TEXT

# engine OUT [ARGUMENT...]: the sweep into a folder.
engine() {
  "$binary" bench tiny.toml --simulated simulated --out "$1" -j 2 --threads 1 "${@:2}" >stdout 2>stderr
}

# content OUT: every file of its runs with its bytes, but for what is never the same twice: timing and provenance of a
# record, and the milliseconds of frames.csv. Hidden files as well: nothing may be left of a killed engine.
content() {
  (cd "$1" && find . -path ./.fusebench/invocations -prune -o -type f -print | LC_ALL=C sort | while read -r file; do
    case $file in
      *.json) sed '/^  "timing"/,$d' "$file" ;;
      */frames.csv) cut -d, -f1-28 "$file" ;;
      *) cat "$file" ;;
    esac | md5sum | sed "s|-|$file|"
  done)
}

same_as_undisturbed() {
  content "$1" >"content_$2"
  if ! cmp -s content_undisturbed "content_$2"; then
    diff content_undisturbed "content_$2" | head -n 5 >&2
    complain "$2: not the bytes of the undisturbed sweep"
  fi
}

undisturbed() {
  engine undisturbed || complain "the undisturbed sweep: exit code $?"
  content undisturbed >content_undisturbed
  [[ $(grep -c record.json content_undisturbed) == "$runs" ]] || complain "the undisturbed sweep: not $runs runs"
}

check_kills() {
  undisturbed
  RANDOM=7
  local before=0 finished process
  for kill in 1 2 3 4 5 6 7 8 9 10; do
    engine killed &
    process=$!
    sleep "0.$((300 + RANDOM % 600))"
    # The engine is a child of the subshell that runs the function.
    pkill -KILL -P "$process"
    wait "$process" 2>/dev/null
    finished=$(find killed -name record.json -not -path '*/.*/*' 2>/dev/null | wc -l)
    ((finished >= before)) || complain "kill $kill: $before runs were finished, and then $finished"
    before=$finished
  done
  ((before < runs)) || printf 'note: all runs were finished before the last kill\n' >&2
  sleep 0.5 # children die with their engine, a moment later
  engine killed || complain "after the kills: exit code $?"
  same_as_undisturbed killed killed
  engine killed --json || complain "again: exit code $?"
  [[ $(grep -c '"resumed": true' stdout) == "$runs" ]] || complain "again: something was run twice"
}

check_disks() {
  undisturbed
  mkdir disk
  if ! mount -t tmpfs -o size=1500k none disk 2>/dev/null; then
    printf 'skipped: no file system can be mounted here\n'
    exit 77
  fi
  mounted=$work/disk
  local status
  engine disk/out
  status=$?
  ((status == 4)) || complain "a full disk: exit code $status instead of 4"
  grep -q 'cannot be written: No space left on device' stderr || complain "a full disk: not said"
  grep -qE '[0-9]+ of [0-9]+ runs are finished and kept' stderr || complain "a full disk: what is kept is not said"
  local kept
  kept=$(find disk/out -name record.json -not -path '*/.*/*' | wc -l)
  ((kept > 0 && kept < runs)) || complain "a full disk: $kept runs kept"
  while read -r file; do
    "$binary" table "$(dirname "$file")" >/dev/null 2>stderr || complain "a full disk: $file is not whole"
  done < <(find disk/out -name record.json -not -path '*/.*/*' | head -n 5)
  # Pages and tables are whole or not there, and the reason is told.
  head -c 2000k /dev/zero >disk/filler 2>/dev/null
  local verb
  for verb in 'inspect simulated/tiny --page' 'report undisturbed --out' 'collect undisturbed --out'; do
    # shellcheck disable=SC2086  # several arguments
    "$binary" $verb disk/page.html >stdout 2>stderr
    status=$?
    ((status == 4)) || complain "$verb on a full disk: exit code $status instead of 4"
    grep -q 'page.html: cannot be written: No space left on device' stderr || complain "$verb on a full disk: why is not told"
    [[ -z $(find disk -maxdepth 1 -name '*page*') ]] || complain "$verb on a full disk: leaves a part of a file"
  done
  rm disk/filler
  mount -o remount,size=500m disk
  mount -o remount,ro disk
  engine disk/out
  status=$?
  ((status == 4)) || complain "a read-only folder: exit code $status instead of 4"
  grep -q 'Read-only' stderr || complain "a read-only folder: not said"
  local left=disk/out/.left.77.tmp
  mount -o remount,rw disk
  mkdir -p "$left/new"
  mount -o remount,ro disk
  "$binary" gc disk/out >stdout 2>stderr
  status=$?
  ((status == 4)) || complain "gc in a read-only folder: exit code $status instead of 4"
  grep -q "$left: cannot be removed: Read-only" stderr || complain "gc in a read-only folder: what it left is not said"
  mount -o remount,rw disk
  "$binary" gc disk/out | grep -q 'removed 1 left' || complain "gc with a folder that can be written to again"
  [[ ! -e $left ]] || complain "gc leaves what it says it removed"
  engine disk/out || complain "with room again: exit code $?"
  same_as_undisturbed disk/out disk
}

check_engines() {
  undisturbed
  engine shared --json &
  local first=$!
  "$binary" bench tiny.toml --simulated simulated --out shared -j 2 --threads 1 --json >second.json 2>second.err ||
    complain "the second engine: exit code $?"
  wait "$first" || complain "the first engine: exit code $?"
  same_as_undisturbed shared shared
  local made=$(($(grep -c '"resumed": false' stdout) + $(grep -c '"resumed": false' second.json)))
  ((made == runs)) || complain "two engines: $made runs were made for $runs"

  # A run that is killed from outside is a row with its reason, and is run again on request.
  sed 's/^frames.*/frames = "0:3"/; s/^samples.*/samples = 6/' tiny.toml >few.toml
  "$binary" bench few.toml --simulated simulated --out few -j 1 --threads 1 >stdout 2>stderr &
  local process=$!
  # Once a run is claimed, a child of the engine is a run.
  until compgen -G 'few/.fusebench/claims/*' >/dev/null; do sleep 0.002; done
  sleep 0.02
  for _ in 1 2 3 4 5; do
    pkill -KILL -P "$process"
    sleep 0.01
  done
  wait "$process"
  local status=$?
  ((status == 4)) || complain "a killed run: exit code $status instead of 4"
  "$binary" list runs few -o failed >listed 2>stderr || complain "list runs"
  grep -q 'signal 9 (Killed)' listed || complain "a killed run: its reason is not listed"
  "$binary" rerun few >stdout 2>stderr || complain "rerun: exit code $?"
  [[ $("$binary" list runs few -o failed | wc -l) == 1 ]] || complain "rerun: something is still failed"
  [[ $("$binary" list runs few -o ok | wc -l) == 7 ]] || complain "rerun: not 6 good runs"
}

# says CODE PATTERN ARGUMENT...: the program ends with the code and prints the pattern on standard output or error.
says() {
  local code=$1 pattern=$2 status
  shift 2
  "$binary" "$@" >stdout 2>stderr
  status=$?
  ((status == code)) || complain "$*: exit code $status instead of $code"
  grep -qE -- "$pattern" stdout stderr || complain "$*: does not print '$pattern'"
}

check_verbs() {
  undisturbed
  local suite=(bench tiny.toml --simulated simulated)
  says 0 "$runs runs: 0 finished, 0 failed before, $runs to do" "${suite[@]}" --out elsewhere --dry-run
  [[ ! -e elsewhere ]] || complain "--dry-run writes something"
  says 0 "\"n_finished\": $runs" "${suite[@]}" --out undisturbed --dry-run --json
  says 2 "unknown option 'tsdf.voxel' in a sweep" "${suite[@]}" --out elsewhere --set tsdf.voxel=1,2
  "$binary" "${suite[@]}" --out nowhere --executor slurm >stdout 2>stderr && complain "slurm without a cluster succeeds"
  grep -qE 'there is no sbatch here|no Slurm controller answers' stderr || complain "slurm without a cluster: not said"
  [[ ! -e nowhere ]] || complain "slurm without a cluster: something is left"
  says 2 'require --executor slurm' "${suite[@]}" --out nowhere --submit
  says 2 'is swept as well' "${suite[@]}" --out nowhere --set tsdf.voxel_m=0.02

  says 0 'ate_rmse_m|aie_grey' collect undisturbed
  [[ $(cut -d, -f6 stdout | sort -u | wc -l) == $((runs + 1)) ]] || complain "collect: not every run"
  says 0 '"metric"' collect undisturbed --format jsonl
  says 0 '\| +1 \|' best undisturbed --by aie --group none
  says 2 'allowed|one of' best undisturbed --by beauty
  says 3 'absent' collect absent
  says 4 '/dev/full: cannot be written: No space left on device' collect undisturbed --out /dev/full
  says 0 'no-imu iekf.max_iterations=[0-9]+ tsdf.voxel_m=0.01[0-9]* ' list runs undisturbed
  says 0 "$runs runs" report undisturbed --out sweep.html
  grep -q 'Best configurations' sweep.html || complain "the report says nothing of the sweep"
  # Where `bench` writes without --out and --simulated.
  mkdir -p usual/results/runs
  cp -r undisturbed usual/results/runs
  cp -r simulated usual/results
  (cd usual && "$binary" report results/runs/undisturbed --out sweep.html) >stdout 2>stderr || complain "report of the usual folder"
  grep -q 'no images of the recording' stderr && complain "report: a simulated recording is not found"

  # Two folders, made apart, become one.
  says 0 "$runs of $runs runs ok" "${suite[@]}" --out left --set iekf.max_lost_frames=7
  says 0 'runs copied, 0 were there' merge undisturbed left --into together
  says 0 '0 runs copied' merge undisturbed --into together
  says 0 'removed 0 left by killed processes, 0 runs' gc together
  says 0 'would remove .* 0 runs' gc together --failed --stale --dry-run

  mkdir -p theirs/.notes.tmp
  touch theirs/.notes.tmp/file
  says 3 'holds no runs' gc theirs
  says 3 'holds no runs' list runs theirs
  [[ -e theirs/.notes.tmp/file ]] || complain "gc removes what is not its own"

  # After a power cut the end of a record is zeros: the run is a row that says so, and is run again.
  cp -r undisturbed cut
  local record size
  record=$(find cut -name record.json -not -path '*/.*/*' | LC_ALL=C sort | head -n 1)
  size=$(stat -c %s "$record")
  truncate -s 4096 "$record"
  truncate -s "$size" "$record"
  says 0 "$((runs - 1)) of $runs runs ok" table cut
  local verb
  for verb in 'list runs' collect; do
    # shellcheck disable=SC2086  # two words
    says 0 'record.json is damaged: not JSON at byte 4097 .zeros after a power cut' $verb cut
  done
  says 0 "$runs runs" report cut --out cut.html
  says 3 'record.json is damaged' compare undisturbed cut
  says 0 "^$(dirname "$record")\$" gc cut --failed --dry-run
  says 0 "$runs of $runs runs ok" "${suite[@]}" --out cut
  same_as_undisturbed cut cut

  says 0 'PASS' compare undisturbed undisturbed
  cp -r undisturbed worse
  record=$(find worse -name record.json -not -path '*/.*/*' | LC_ALL=C sort | head -n 1)
  sed -i 's/"tracked": [0-9]*/"tracked": 0/' "$record"
  says 1 'REGRESSION' compare undisturbed worse
  for format in markdown json junit gbench github-benchmark openmetrics; do
    says 1 . compare undisturbed worse --format "$format"
    if grep -qiw nan stdout; then complain "compare --format $format: prints NaN"; fi
  done
  rm -r "$(dirname "$record")"
  says 1 'missing' compare undisturbed worse
  says 3 'absent' compare undisturbed absent
}

# ends CODE WHAT: of the last command, kept in `status`.
ends() {
  ((status == $1)) || complain "$2: exit code $status instead of $1"
}

# Standard output and error that take nothing, or are closed: what cannot be shown never ends a suite, and what was to be
# the result is an error with one sentence.
check_streams() {
  undisturbed
  local suite=(bench tiny.toml --simulated simulated -j 2 --threads 1) status
  "$binary" "${suite[@]}" --out full 2>/dev/full
  status=$?
  ends 0 'a suite whose progress meets a full disk'
  same_as_undisturbed full full
  "$binary" "${suite[@]}" --out closed 2>&-
  status=$?
  ends 0 'a suite with standard error closed'
  same_as_undisturbed closed closed
  "$binary" "${suite[@]}" --out all_closed <&- >&- 2>&-
  status=$?
  ends 0 'a suite with everything closed'
  same_as_undisturbed all_closed all_closed
  "$binary" "${suite[@]}" --out left 2>&1 >/dev/null | true
  status=${PIPESTATUS[0]}
  ends 0 'a suite whose progress nobody reads any more'
  same_as_undisturbed left left
  "$binary" table absent 2>/dev/full
  status=$?
  ends 3 'an error that cannot be shown'

  local verb
  for verb in 'list variants' 'table undisturbed' '--help' '--version' \
    'bench tiny.toml --simulated simulated --out undisturbed --json'; do
    # shellcheck disable=SC2086  # several arguments
    "$binary" $verb >/dev/full 2>stderr
    status=$?
    ends 4 "$verb: output to a full disk"
    [[ $(grep -c '^error: standard output cannot be written' stderr) == 1 ]] || complain "$verb: a full disk is not said once"
    # shellcheck disable=SC2086
    "$binary" $verb >&- 2>stderr
    status=$?
    ends 4 "$verb: output closed"
    [[ $(grep -c '^error: ' stderr) == 1 ]] || complain "$verb: a closed output is not said once"
    # shellcheck disable=SC2086
    "$binary" $verb >/dev/full 2>&-
    status=$?
    ends 4 "$verb: neither output nor error"
  done
  : >stderr
  # A reader that has seen enough is no error, and nothing is said of it.
  "$binary" list variants 2>stderr | true
  status=${PIPESTATUS[0]}
  if ((status != 0)); then ends 141 'a pipe whose reader has left'; fi
  ! grep -qv '^\.\.\. ' stderr || complain 'a pipe whose reader has left: something is said'
}

case $group in
  kills) check_kills ;;
  disks) check_disks ;;
  engines) check_engines ;;
  verbs) check_verbs ;;
  streams) check_streams ;;
  *)
    usage >&2
    exit 2
    ;;
esac
if ((failures > 0)); then
  printf '%s: %d checks failed\n' "$group" "$failures" >&2
  exit 1
fi
printf '%s: passed with %d runs\n' "$group" "$runs"
