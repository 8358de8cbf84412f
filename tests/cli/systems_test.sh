#!/usr/bin/env bash
# External programs as systems, from outside: one in another language that does well, and those that hang, die, or leave half
# a trajectory, NaN, other units or mirrored poses. Each of these is a row with a reason that names the file and line.
set -uo pipefail

if (($# != 2)); then
  printf 'Usage: tests/cli/systems_test.sh BINARY GOLDEN_TUM_FOLDER\n' >&2
  exit 2
fi
binary=$(realpath -- "$1")
golden=$(realpath -- "$2")
unset FUSEBENCH_DATA

work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
cd "$work" || exit 2
cp -r "$golden" freiburg1_copy
chmod -R u+w freiburg1_copy
checks=0
failures=0

complain() {
  failures=$((failures + 1))
  printf 'FAILED: %s\n' "$1" >&2
  if [[ -s stderr ]]; then sed 's/^/    stderr: /' stderr >&2; fi
}

# A system in awk: stands still at the stamps of the exported colour images. What else it does, $2 says.
cat >mine.sh <<'TEXT'
#!/bin/sh
set -eu
[ "${1:-}" = --version ] && { echo "mine 1.0"; exit 0; }
still() { awk '!/^#/ { print $1, 0.001 * NR, 0, 0, 0, 0, 0, 1 }' "$1/rgb.txt"; }
case $2 in
  good) still "$1" >poses.txt
    printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n' >mesh.ply
    printf '0 0 1\n1 0 1\n0 1 1\n' >>mesh.ply ;;
  hang) sleep 1000 ;;
  die) echo "assertion failed in mapping"; exit 42 ;;
  loud) echo begin; echo "the reason is this"; exit 3 ;;
  crash) kill -SEGV $$ ;;
  none) true ;;
  half) still "$1" | head -c 130 >poses.txt ;;
  nan) still "$1" | awk 'NR == 3 { $2 = "nan" } { print }' >poses.txt ;;
  units) still "$1" | awk '{ $2 = 1e5 * $2; print }' >poses.txt ;;
  mirror) printf -- '-1 0 0 0 0 1 0 0 0 0 1 0\n%.0s' 1 2 3 4 5 >poses.txt ;;
  few) still "$1" | head -n 2 >poses.txt ;;
  truth) ls "$1"; test ! -e "$1/groundtruth.txt"; still "$1" >poses.txt ;;
esac
TEXT

# definition NAME MODE [LINE...]: mine.toml for a mode of the program.
definition() {
  local name=$1 mode=$2
  shift 2
  {
    printf 'name = "%s"\nexport = "tum"\ndeterministic = true\n' "$name"
    printf 'command = ["sh", "{folder}/mine.sh", "{recording}", "%s"]\nversion = ["sh", "{folder}/mine.sh", "--version"]\n' "$mode"
    printf '[limits]\ntime_s = 2\n[trajectory]\nfile = "poses.txt"\nonline = true\n'
    printf '%s\n' "$@"
  } >"$name.toml"
}

# row NAME CODE PATTERN: runs it, and looks for the pattern in what is said and in the record.
row() {
  local name=$1 code=$2 pattern=$3 status record
  checks=$((checks + 1))
  "$binary" run freiburg1_copy --system "$name.toml" --out runs >stdout 2>stderr
  status=$?
  if ((status != code)); then complain "$name: exit code $status instead of $code"; fi
  if ! grep -qE "$pattern" stderr; then complain "$name: nothing like '$pattern'"; fi
  record=$(find "runs/freiburg1_copy/$name" -name record.json 2>/dev/null | head -n 1)
  if [[ -z $record ]]; then complain "$name: no record"; return; fi
  if ((code != 0)) && ! grep -E '"reason"' "$record" | grep -qE "$pattern"; then complain "$name: the record does not say why"; fi
  if find "runs/freiburg1_copy/$name" -name work | grep -q .; then complain "$name: its working folder is left"; fi
}

definition good good '[mesh]' 'file = "mesh.ply"'
row good 0 '5/5|5 of 5'
log=$(find runs/freiburg1_copy/good -name log.txt)
if ! grep -q 'version: mine 1.0' "$log"; then complain 'the version is not in the log'; fi
if [[ ! -s $(dirname "$log")/mesh.ply ]]; then complain 'the cloud of points is not there'; fi
definition truth truth
row truth 0 '5/5|5 of 5'
definition few few
row few 0 '2/5|2 of 5'
definition hang hang
row hang 4 'killed after 2 s, its limit'
definition die die
row die 4 'exit code 42'
if ! grep -rq 'assertion failed in mapping' runs/freiburg1_copy/die/*/log.txt; then complain 'the last words are not in the log'; fi
definition crash crash
row crash 4 'signal 11'
definition none none
row none 4 'none wrote no trajectory: there is no poses.txt, which trajectory.file of none.toml names'
definition half half
row half 4 'poses.txt:4'
definition nan nan
row nan 0 '4/5|4 of 5'  # the row of a lost frame
definition units units
row units 4 'poses.txt: the poses extend over .* unit'
definition mirror mirror
sed -i 's/file = "poses.txt"/file = "poses.txt"\nformat = "kitti"/' mirror.toml
row mirror 4 'poses.txt:1: .*no rotation'
definition promised truth '[mesh]' 'file = "mesh.ply"'
row promised 4 'mesh.ply: cannot'
definition loud loud
row loud 4 'sh: exit code 3: the reason is this'
definition absent good
sed -i 's/"--version"/"--no-such-word", "nothing"/; s/"sh", "{folder}\/mine.sh", "--no/"no-such-program", "--no/' absent.toml

# The name of a system in place of its file.
for named in 'open3d:did you mean .*configs/systems/open3d.toml' 'infinitam:--variant infinitam' 'mien.toml:those of .*rtabmap'; do
  checks=$((checks + 1))
  "$binary" run freiburg1_copy --system "${named%%:*}" --out runs >stdout 2>stderr
  status=$?
  if ((status != 3)) || ! grep -q 'there is no such file' stderr || ! grep -qE -- "${named#*:}" stderr; then
    complain "--system ${named%%:*}: exit code $status, or another hint"
  fi
done

# In a suite: repetitions with seeds, rows with reasons, and what is not installed is excluded with its reason.
cat >suite.toml <<'TEXT'
name = "programs"
recordings = ["freiburg1_copy"]
variants = ["infinitam"]
systems = ["good.toml", "die.toml", "absent.toml", "drawing.toml"]
TEXT
definition drawing good
sed -i 's/deterministic = true/deterministic = false/' drawing.toml
mkdir -p listed/suites
cp suite.toml listed/suites/
checks=$((checks + 1))
if ! (cd / && "$binary" list suites --configs "$OLDPWD/listed") >stdout 2>stderr || ! grep -q 'drawing.toml' stdout; then
  complain 'suites with external programs cannot be listed from elsewhere'
  cat stderr >&2
fi
checks=$((checks + 1))
"$binary" bench suite.toml --out suite_runs -j 2 >stdout 2>stderr
status=$?
if ((status != 4)); then complain "suite: exit code $status instead of 4"; fi
if ! grep -q 'left out: absent: .*no-such-program' stderr; then complain 'what cannot run here is not said'; fi
"$binary" bench suite.toml --out suite_runs -j 2 >stdout 2>stderr
for run in infinitam good drawing 'drawing repetition 5'; do
  if ! grep -q "$run: (was there)" stderr; then complain "$run: a finished run is repeated"; fi
done
"$binary" bench suite.toml --out suite_runs -j 2 --dry-run >stdout 2>stderr
if ! grep -q 'no-such-program' stdout; then complain 'what is not installed is not said'; cat stdout >&2; fi
"$binary" bench suite.toml --out suite_runs --dry-run --only variant=infinitam >stdout 2>stderr
if grep -q 'no-such-program' stdout stderr; then complain 'a program that is left out is asked for its version'; fi
printf 'name = "alone"\nrecordings = ["freiburg1_copy"]\nsystems = ["good.toml"]\n' >alone.toml
if ! "$binary" bench alone.toml --out alone_runs >stdout 2>stderr; then complain 'a suite of a system alone does not run'; cat stderr >&2; fi
printf '# another version\n' >>good.toml
"$binary" bench alone.toml --out alone_runs >stdout 2>stderr
"$binary" table alone_runs --systems >stdout 2>stderr
if (($(grep -c 'good #' stdout) != 2)); then complain 'two versions of a program are one row'; cat stdout >&2; fi
if grep -q 'frames.csv' <("$binary" report alone_runs --out alone.html 2>&1); then complain 'the report misses frames.csv of a program'; fi
if ! grep -q 'another version' alone.html; then complain 'the report does not show the definition'; fi
for option in --profile '--set=iekf.max_iterations=3'; do
  if "$binary" run freiburg1_copy --system good.toml --out runs $option >stdout 2>stderr; then complain "$option is taken and does nothing"; fi
done
"$binary" table suite_runs --systems >stdout 2>stderr
for pattern in 'drawing.*5/5 ok' 'die.*0/1 ok' 'infinitam.*1/1 ok' 'exit code 42'; do
  if ! grep -qE "$pattern" stdout; then complain "the table has nothing like '$pattern'"; cat stdout >&2; fi
done

# A system of the program itself: surfels, the same with any number of threads.
for threads in 1 3; do
  checks=$((checks + 1))
  if ! "$binary" run freiburg1_copy --variant elasticfusion --set elasticfusion.stable_confidence=1 --threads $threads --out surfels$threads >stdout 2>stderr ||
    ! grep -q '5/5 frames' stderr; then
    complain "elasticfusion with $threads threads does not track five frames"
  fi
  cat surfels$threads/*/*/*/trajectory.tum surfels$threads/*/*/*/mesh.ply >surfels$threads.bytes
done
checks=$((checks + 1))
if ! cmp -s surfels1.bytes surfels3.bytes; then complain 'elasticfusion depends on the number of threads'; fi
checks=$((checks + 1))
if "$binary" run freiburg1_copy --variant elasticfusion-imu --out surfels >stdout 2>stderr || ! grep -qi 'imu' stderr; then
  complain 'elasticfusion-imu without an IMU does not say so'
fi

printf '%d checks, %d failures\n' "$checks" "$failures"
((failures == 0))
