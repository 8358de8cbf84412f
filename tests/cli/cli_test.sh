#!/usr/bin/env bash
# The command line from outside: what bad input, Ctrl-C and an unwritable folder do, and that the same run gives the
# same bytes. Runs one group of checks on copies of the golden recording, in a folder of its own.
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: tests/cli/cli_test.sh BINARY GOLDEN_TUM_FOLDER bad-data|bad-usage|evaluation|evo|meshes|imports|exports|recordings|interrupt|determinism|profile
TEXT
}

if (($# != 3)); then
  usage >&2
  exit 2
fi
binary=$(realpath -- "$1")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
golden=$(realpath -- "$2")
group=$3
unset FUSEBENCH_DATA

work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
cd "$work" || exit 2
checks=0
failures=0

complain() {
  failures=$((failures + 1))
  printf 'FAILED: %s\n' "$1" >&2
  if [[ -s stderr ]]; then sed 's/^/    stderr: /' stderr >&2; fi
}

# fresh_copy: the golden recording as ./copy (a name that tells the camera), writable.
fresh_copy() {
  rm -rf freiburg1_copy
  cp -r "$golden" freiburg1_copy
  chmod -R u+w freiburg1_copy
}

# refused NAME CODE PATTERN... -- ARGUMENT...: the program ends with CODE and exactly one error of one line that matches
# every pattern (extended regular expressions; one that begins with "hint:" is for the hint), prints no result, and
# leaves ./out as absent as it was.
refused() {
  local name=$1 code=$2 status pattern
  local patterns=()
  shift 2
  while [[ $1 != -- ]]; do
    patterns+=("$1")
    shift
  done
  shift
  checks=$((checks + 1))
  rm -rf out
  "$binary" "$@" >stdout 2>stderr
  status=$?
  if ((status != code)); then complain "$name: exit code $status instead of $code"; fi
  if [[ $(grep -c '^error: ' stderr) != 1 ]]; then complain "$name: not exactly one error"; fi
  if grep -qvE '^(error: .|  hint: .|warning: .|\.\.\. .)' stderr; then complain "$name: something else on standard error"; fi
  if [[ -s stdout ]]; then complain "$name: a result on standard output"; fi
  for pattern in "${patterns[@]}"; do
    if [[ $pattern == hint:* ]]; then
      grep -E '^  hint: ' stderr | grep -qE -- "${pattern#hint:}" || complain "$name: no hint matches '$pattern'"
    else
      grep -E '^error: ' stderr | grep -qE -- "$pattern" || complain "$name: no error matches '$pattern'"
    fi
  done
  if [[ -e out ]]; then complain "$name: left $(find out | tr '\n' ' ')"; fi
}

# Arguments of the run that the checks vary.
run=(run freiburg1_copy --variant no-imu --out out --threads 2)

check_bad_data() {
  refused "missing recording" 3 'nowhere' -- run nowhere --variant no-imu --out out

  fresh_copy
  rm freiburg1_copy/depth/1305031229.596617.png
  refused "missing depth image" 3 'depth/1305031229.596617.png' -- "${run[@]}"

  fresh_copy
  sed -i '5s/.*/1305031229.564425 rgb extra column/' freiburg1_copy/rgb.txt
  refused "columns of rgb.txt" 3 'rgb.txt:5' -- "${run[@]}"

  fresh_copy
  sed -i '7s/ [^ ]*$//' freiburg1_copy/groundtruth.txt
  refused "columns of groundtruth.txt" 3 'groundtruth.txt:7' -- "${run[@]}"

  fresh_copy
  sed -i '9s/ [^ ]*$/ abc/' freiburg1_copy/groundtruth.txt
  refused "a word for a number" 3 'groundtruth.txt:9.*abc' -- "${run[@]}"

  fresh_copy
  sed -i '9s/.*/1305031229.3633 inf 0 0 0 0 0 1/' freiburg1_copy/groundtruth.txt
  refused "not a number" 3 'groundtruth.txt:9' -- "${run[@]}"

  fresh_copy
  sed -i '6s/^1305031229/1305031228/' freiburg1_copy/rgb.txt
  refused "time running backwards" 3 'rgb.txt:6' -- "${run[@]}"

  fresh_copy
  sed -i 's/^1305031229/1305039229/; s/^1305031230/1305039230/' freiburg1_copy/groundtruth.txt
  refused "truth of another time" 3 'groundtruth' -- "${run[@]}"

  fresh_copy
  tiny_depth_png >freiburg1_copy/depth/1305031229.564442.png
  refused "depth of another size" 3 'depth/1305031229.564442.png' '640x480' -- "${run[@]}"

  fresh_copy
  truncate -s 60000 freiburg1_copy/rgb/1305031229.628753.png
  refused "truncated image in the middle of a run" 3 'frame 3' 'rgb/1305031229.628753.png' 'truncated' -- "${run[@]}"
  refused "truncated image with an IMU" 3 'rgb/1305031229.628753.png' -- \
    run freiburg1_copy --variant full --imu synthetic --out out --threads 1

  fresh_copy
  printf 'no image' >freiburg1_copy/depth/1305031229.664358.png
  refused "no image at all" 3 'depth/1305031229.664358.png' -- "${run[@]}"

  # Longer than any image, though it takes no room; a GIF whose header claims 17 GB.
  fresh_copy
  truncate -s 60G freiburg1_copy/rgb/1305031229.628753.png
  refused "a file with holes" 3 'rgb/1305031229.628753.png: 64424509440 bytes are too many for an image' -- "${run[@]}"
  fresh_copy
  printf 'GIF89a\xff\xff\xff\xff\x80\0\0\0\0\0\xff\xff\xff,\0\0\0\0\1\0\1\0\0\2\2D\1\0;' >freiburg1_copy/rgb/1305031229.628753.png
  refused "a GIF" 3 'frame 3' 'rgb/1305031229.628753.png: a GIF' -- "${run[@]}"

  # In a suite the same is a row of the table, and the rest goes on.
  fresh_copy
  truncate -s 60000 freiburg1_copy/rgb/1305031229.628753.png
  mkdir -p data/freiburg1_good && cp -r "$golden"/. data/freiburg1_good && mv freiburg1_copy data/freiburg1_bad
  printf 'name = "two"\nall = true\nvariants = ["no-imu"]\n' >two.toml
  checks=$((checks + 1))
  "$binary" bench two.toml --data data --out runs >stdout 2>stderr
  if (($? != 4)); then complain "suite with bad data: not exit code 4"; fi
  grep -q '1 of 2 runs ok' stderr || complain "suite with bad data: the good run is not counted"
  "$binary" table runs >stdout 2>stderr || complain "table of a suite with bad data"
  grep -q '1305031229.628753.png' stdout || complain "the table does not say why the run failed"
  "$binary" table runs --format latex --metrics ate,rpe >stdout 2>stderr || complain "table --metrics by short names"
  refused "a ranking by a number that no run has" 3 'no run has mesh' 'hint:--by' -- best runs --by mesh
}

# A grey PNG of 1x1 pixels with 16 bits, byte by byte.
tiny_depth_png() {
  printf '\x89PNG\r\n\x1a\n'
  printf '\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x01\x00\x00\x00\x01\x10\x00\x00\x00\x00\x6a\xee\x47\x16'
  printf '\x00\x00\x00\x0b\x49\x44\x41\x54\x78\x9c\x63\x10\x60\x00\x00\x00\x23\x00\x11\x31\x07\xfd\x77'
  printf '\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82'
}

check_bad_usage() {
  fresh_copy
  refused "unknown verb" 2 'rnu' 'run' -- rnu
  refused "unknown key" 2 'iekf.max_iteration' 'iekf.max_iterations' -- "${run[@]}" --set iekf.max_iteration=8
  refused "out of range" 2 'iekf.max_iterations' '999' '1 \.\. 200' -- "${run[@]}" --set iekf.max_iterations=999
  refused "wrong type" 2 'iekf.max_iterations' 'many' -- "${run[@]}" --set iekf.max_iterations=many
  refused "no assignment" 2 'iekf.max_iterations' -- "${run[@]}" --set iekf.max_iterations
  refused "NaN" 2 'tsdf.voxel_m' -- "${run[@]}" --set tsdf.voxel_m=nan

  printf '# options\n[iekf]\nmax_iterations = 5\nmax_iteration = 8\n' >options.toml
  refused "unknown key in a file" 2 'options.toml:4' 'max_iterations' -- "${run[@]}" --config options.toml
  printf '[iekf]\nmax_iterations = 5000\n' >options.toml
  refused "out of range in a file" 2 'options.toml:2' '5000' -- "${run[@]}" --config options.toml
  printf '[iekf]\nmax_iterations = "five"\n' >options.toml
  refused "wrong type in a file" 2 'options.toml:2' -- "${run[@]}" --config options.toml
  printf '[iekf]\nmax_iterations = = 5\n' >options.toml
  refused "no TOML" 2 'options.toml:2' -- "${run[@]}" --config options.toml
  refused "no such file of options" 3 'absent.toml' -- "${run[@]}" --config absent.toml

  refused "unknown variant" 2 'no_imu' 'no-imu' -- run freiburg1_copy --variant no_imu --out out
  refused "IMU needed" 2 "'full'" 'hint:--imu synthetic' -- run freiburg1_copy --variant full --out out
  refused "a calibration from the truth" 2 'made from its ground truth' 'hint:recorded' -- \
    calibrate freiburg1_copy --imu synthetic --out out
  refused "a calibration from the truth, automatic" 2 'made from its ground truth' -- \
    calibrate freiburg1_copy --imu auto --out out
  refused "a calibration without samples" 2 'needs an IMU' 'hint:.*inertial samples .*with --imu synthetic' -- \
    calibrate freiburg1_copy --out out
  refused "a calibration by edit without samples" 2 'needs an IMU' 'hint:.*inertial samples .*with --imu synthetic' -- \
    calibrate freiburg1_copy --variant no-imu --set terms.prior=imu --out out
  refused "one round" 2 'rounds' '2 (-|to) 20' -- calibrate freiburg1_copy --imu synthetic --rounds 1
  refused "frames backwards" 2 '4:2' -- "${run[@]}" --frames 4:2
  refused "an open window behind the end" 2 "frames 1000: begins behind the end: 'freiburg1_copy' has 5 frames, 0 to 4" -- "${run[@]}" --frames 1000:
  refused "frames beyond the end" 2 '3:9' -- "${run[@]}" --frames 3:9
  local units
  for units in 1e300 1e-300 nan; do
    refused "depth units of $units" 2 'depth.units' 'allowed|above 0' -- "${run[@]}" --depth-units "$units"
  done
  refused "no clock is off by that much" 2 'imu_time_offset_sigma_s = 0.5 ' -- \
    "${run[@]}" --set initialisation.imu_time_offset_sigma_s=0.5
  refused "unknown camera" 2 'freiburg9' -- "${run[@]}" --camera freiburg9
  refused "unknown option" 2 'frobnicate' -- "${run[@]}" --frobnicate
  refused "misspelt option" 2 'no option --varient \(nearest: --variant\)' 'hint:fusebench run --help' -- run freiburg1_copy --varient full
  refused "misspelt option before the verb" 2 'fusebench. has no option --versoin \(nearest: --version\)' -- --versoin run
  refused "a long option with one dash" 2 'no option -variant \(nearest: --variant\)' -- run freiburg1_copy -variant full
  refused "too many arguments" 2 'fusebench run. does not take other another$' -- run freiburg1_copy other another
  refused "another value" 2 '--preset slwo: not one of slow, fast, .* \(nearest: slow\)' -- simulate --preset slwo --out out
  refused "no value" 2 '--variant is given without its value' -- run freiburg1_copy --variant
  refused "the beginning of an option" 2 'has no option --var .nearest: --variant' -- run x --var full
  refused "the beginning of a short option" 2 'has no option --thr .nearest: --threads' -- run x --thr 2
  refused "help of an unknown verb" 2 "unknown verb 'evall' .nearest: eval" 'hint:lists the verbs' -- help evall
  refused "help of what is like no verb" 2 "unknown verb 'frobz'$" 'hint:lists the verbs' -- help frobz
  refused "help of an unknown verb of eval" 2 "unknown verb 'foo' of .fusebench eval" -- help eval foo
  refused "nearly a name of evo's" 2 "unknown verb 'apee' of .fusebench eval. \(nearest: ape\)" -- eval apee gt.txt est.txt
  refused "unknown verb of eval" 2 "unknown verb 'atee' of .fusebench eval. \(nearest: ate\)" -- eval atee gt.txt est.txt
  refused "no threads" 2 'threads' -- run freiburg1_copy --variant no-imu --out out --threads 0

  refused "speed without a path" 2 'speed' 'trajectory' -- simulate --out out --speed 2
  refused "unit without a scene" 2 'scene-unit' 'scene' -- simulate --out out --scene-unit 0.001
  refused "up without a scene" 2 'scene-y-up' 'scene' -- simulate --out out --scene-y-up
  printf '%s 0 0 1 0 0 0 1\n' 0 1 2 3 >path.txt
  refused "no speed" 2 'speed = 0 ' 'allowed' -- simulate --out out --trajectory path.txt --duration 0 --speed 0
  refused "hardly any speed" 2 'speed = 1e-09' -- simulate --out out --trajectory path.txt --duration 0 --speed 1e-9

  printf 'name = "s"\nall = true\nvariant = ["full"]\n' >suite.toml
  refused "unknown key of a suite" 2 'suite.toml:3' 'variants' -- bench suite.toml --data . --out out
  printf 'name = "s"\nall = true\nvariants = ["fulll"]\n' >suite.toml
  refused "unknown variant of a suite" 2 'suite.toml:3' 'nearest: full' -- bench suite.toml --data . --out out
  printf 'name = "s"\nrecordings = ["absent"]\nvariants = ["no-imu"]\n' >suite.toml
  refused "unknown recording of a suite" 3 'absent' -- bench suite.toml --data . --out out

  # The name of a suite is a folder below results/runs.
  local escape
  for escape in ../../../escaped "$PWD/escaped" a/b .. .hidden; do
    printf 'variants = ["no-imu"]\nall = true\nname = "%s"\n' "$escape" >suite.toml
    refused "name of a suite: $escape" 2 'suite.toml:3: name = ' 'hint:folder' -- bench suite.toml --data .
  done
  if [[ -e results || -e escaped || -e ../escaped ]]; then complain "name of a suite: something was written"; fi

  printf 'name = "s"\nvariants = ["full"]\n[[simulations]]\nname = "a"\npreset = "quick"\n' >suite.toml
  refused "unknown preset of a suite" 2 'suite.toml:5' 'slow' -- bench suite.toml --out out
  printf 'name = "s"\nall = true\nvariants = ["full"]\n[[criteria]]\ntitle = "t"\nvariant = "full"\nmetric = "ate_rmse"\n' >suite.toml
  refused "unknown metric of a criterion" 2 'suite.toml:7' 'ate_rmse_m' -- bench suite.toml --data . --out out

  # What cannot be simulated is refused before anything runs.
  printf 'name = "s"\nvariants = ["full"]\n[[simulations]]\nname = "a"\npreset = "slow"\nsize = "0x0"\n' >suite.toml
  refused "no pixels" 2 "recording 'a': image size = 0x0" -- bench suite.toml --out out --dry-run
  printf 'name = "s"\nvariants = ["full"]\n[[simulations]]\nname = "a"\npreset = "slow"\nduration_s = 1e12\n' >suite.toml
  refused "too long" 2 "recording 'a': duration_s = 1000000000000 .allowed" -- bench suite.toml --out out --dry-run
  printf 'name = "s"\nall = true\nvariants = ["full"]\n' >suite.toml
  refused "no silence" 2 'slurm-silence' 'nan' -- bench suite.toml --out out --slurm-silence nan
  refused "delta without end" 2 'delta = 1e\+308 ' -- \
    eval rpe freiburg1_copy/groundtruth.txt freiburg1_copy/groundtruth.txt -d 1e308
  printf 'name = "s"\nrecordings = ["freiburg1_copy"]\nvariants = ["full"]\n[[sweep]]\ndesign = "latin-hypercube"\n' >many.toml
  printf 'samples = 1000000\ntsdf.voxel_m = { from = 0.01, to = 0.02 }\n' >>many.toml
  refused "more runs than a plan holds" 2 'has 1000000 points \(allowed: up to 100000\)' -- bench many.toml --data . --out out

  # An unwritable place; a file in the way serves root as well, who may write everywhere.
  printf 'in the way' >obstacle
  refused "unwritable folder" 4 'obstacle' 'hint:--out' -- run freiburg1_copy --variant no-imu --out obstacle/out
  [[ $(cat obstacle) == 'in the way' ]] || complain "unwritable folder: the file in the way was changed"
}

# listed NAME PATTERN -- ARGUMENT...: `list recordings` succeeds, and a line of it matches the extended regular expression.
listed() {
  local name=$1 pattern=$2
  shift 3
  checks=$((checks + 1))
  "$binary" list recordings "$@" >stdout 2>stderr || complain "$name: exit code $?"
  grep -qE -- "$pattern" stdout || complain "$name: no line matches '$pattern'"
}

# on_terminal COLUMNS ARGUMENT...: what the program prints on a terminal of that width (0: one that does not tell) as ./stdout.
on_terminal() {
  local columns=$1
  shift
  checks=$((checks + 1))
  script -qec "stty cols $columns && $(printf '%q ' "$binary" "$@")" /dev/null </dev/null | tr -d '\r' >stdout
  [[ ${PIPESTATUS[0]} == 0 ]] || complain "$* on a terminal of $columns: $(cat stdout)"
}

# fits WIDTH PATTERN: no line of ./stdout that matches the extended regular expression is wider.
fits() {
  awk -v width="$1" -v of="$2" '$0 ~ of && length > width' stdout | grep . >&2 && complain "wider than $1"
}

# check_folded_tables RUNS: tables fit a terminal, or --width; elsewhere, and of formats, a row is a line.
check_folded_tables() {
  local runs=$1 verb
  for verb in "table $runs" "table $runs --systems" "best $runs --by cpu"; do
    # shellcheck disable=SC2086
    on_terminal 70 $verb
    fits 70 '^\|'
    [[ $(grep -cE '^\| (recording|group) ' stdout) -gt 1 ]] || complain "$verb on a terminal: no blocks of columns"
    # shellcheck disable=SC2086
    [[ $("$binary" $verb --width 70) == "$(cat stdout)" ]] || complain "$verb: --width 70 is not as a terminal of 70"
    # shellcheck disable=SC2086
    [[ $("$binary" $verb | grep -cE '^\| (recording|group) ') == 1 ]] || complain "$verb into a pipe is folded"
    # shellcheck disable=SC2086
    on_terminal 70 $verb --format markdown
    [[ $(grep -cE '^\| (recording|group) ' stdout) == 1 ]] || complain "$verb --format markdown on a terminal is folded"
  done
  for verb in "list suites --configs $here/../../configs" 'list recordings' "list runs $runs" 'list metrics' "compare $runs $runs --all"; do
    # shellcheck disable=SC2086
    on_terminal 90 $verb
    fits 90 '  '
    # shellcheck disable=SC2086
    on_terminal 90 $verb --width 0
    # shellcheck disable=SC2086
    [[ $("$binary" $verb) == "$(cat stdout)" ]] || complain "$verb: --width 0 is not as into a pipe"
  done
  COLUMNS=60 on_terminal 0 list recordings dorm
  fits 60 .
  COLUMNS=wide on_terminal 0 list recordings dorm
  fits 100 .
  refused "a width that is none" 2 'width.*10001' -- list recordings --width 10001
}

check_recordings() {
  mkdir -p data/scene
  cp -r "$golden" data/rgbd_dataset_freiburg1_rpy
  cp -r "$golden" data/scene/freiburg1_walk
  listed "without a folder" '^fr1_desk +tum +613 +CC BY 4.0 +- ' --
  listed "absent" '^fr1_desk .* - ' -- --data data
  listed "present" '^fr1_rpy +tum .* data/rgbd_dataset_freiburg1_rpy ' -- --data data
  listed "others" '^freiburg1_walk +tum .* data/scene/freiburg1_walk' -- --data data
  listed "json" '"recording": "dorm1_slow"' -- --data data --json
  refused "no such folder of runs" 3 'nowhere: no such folder' 'hint:the folder of a run' -- table nowhere
  refused "a record as a folder of runs" 3 'record.json: no folder' 'hint:the folder of a run' -- \
    table "$(touch record.json && echo record.json)"
  refused "no such folder" 3 'nowhere' 'hint:--data' -- list recordings --data nowhere

  # By its published name, from any folder.
  checks=$((checks + 1))
  (mkdir elsewhere && cd elsewhere && "$binary" run fr1_rpy --data ../data --variant no-imu --frames 0:2 --out out) \
    >stdout 2>stderr || complain "run by a published name: exit code $?"
  grep -q '^no ATE: the trajectory cannot be aligned: 2 matched positions' stderr || complain "run does not say why it has no ATE"
  grep -q '^  hint: take more frames' stderr || complain "run without ATE does not say what to do"
  grep -rq '"name": "rgbd_dataset_freiburg1_rpy"' --include record.json elsewhere/out || complain "another recording was run"
  grep -q '"frames": null' <("$binary" list recordings --data data --json) || complain "unknown is not null in JSON"
  listed "a text" '^fr3_office ' -- FR3_office
  [[ $(grep -c . stdout) == 2 ]] || complain "list recordings FR3_office: other rows as well"
  checks=$((checks + 1))
  "$binary" list metrics >stdout 2>stderr || complain "list metrics: exit code $?"
  local metric
  for metric in ate_rmse_m ate_fitted_m silent_failures mesh_accuracy_m nees_pose coverage cpu_ms_per_frame; do
    grep -q "^$metric  " stdout || complain "list metrics: not $metric"
  done
  refused "a text that is nowhere" 2 "none of .* options contains 'voxl'" 'nearest' -- list options voxl

  # What was run is run again by its record, and a window may be open.
  local first again
  checks=$((checks + 1))
  first=$("$binary" run fr1_rpy --data data --variant no-imu --frames 3: --set iekf.max_iterations=3 --out like 2>stderr) ||
    complain "an open window: exit code $?"
  grep -q '"first_frame": 3' "$first/record.json" || complain "an open window: another first frame"
  again=$("$binary" run --like "$first" --data data --out again 2>stderr) || complain "run --like: exit code $?"
  [[ $(grep -vcE '^(no ATE|  hint): ' stderr) == 1 && ${first#like/} == "${again#again/}" ]] || complain "run --like: another run, $again"
  cmp -s "$first/trajectory.tum" "$again/trajectory.tum" || complain "run --like: another trajectory"
  again=$("$binary" run scene/freiburg1_walk --data data --like "$first/record.json" --set iekf.max_iterations=2 \
    --out again --json 2>stderr) || complain "run --like with changes: exit code $?"
  grep -q 'another content' stderr && complain "run --like: the same images have another content"
  refused "like, and something else" 2 '--like and --variant exclude' 'hint:--set' -- run --like "$first" --variant dm --data data --out out
  refused "like, of a recording that is elsewhere" 3 "the record is of 'rgbd_dataset_freiburg1_rpy'" 'hint:--data or FUSEBENCH_DATA' \
    -- run --like "$first" --out out
  refused "like nothing" 3 'absent' -- run --like absent --data data --out out
  refused "no recording" 2 'no recording is given' 'hint:--like' -- run --variant no-imu --out out
  "$binary" table again --format csv >stdout 2>stderr || complain "table: exit code $?"
  grep -q 'iekf.max_iterations=2,3,1' stdout || complain "table: options and window of a run are not told"
  "$binary" list runs again >stdout 2>stderr || complain "list runs: exit code $?"
  grep -q 'no-imu iekf.max_iterations=3 ' stdout || complain "list runs: the options are not told"
  check_folded_tables again

  # A file beyond the limit of the shell is a sentence, too.
  checks=$((checks + 1))
  (ulimit -f 8 && "$binary" run fr1_rpy --data data --variant no-imu --frames 0:2 --out limited) >stdout 2>stderr
  [[ $? == 4 && $(grep -c '^error: .*File too large' stderr) == 1 ]] || complain "a limit of file sizes: $(cat stderr)"
  [[ ! -e limited || -z $(find limited -type f) ]] || complain "a limit of file sizes: left $(find limited)"

  # A configuration that was printed is one that is read.
  checks=$((checks + 1))
  "$binary" config --variant dm --set tsdf.voxel_m=0.02 >dm.toml 2>stderr || complain "config: exit code $?"
  "$binary" config --config dm.toml >again.toml 2>stderr || complain "config of a printed one: exit code $?"
  [[ $(grep '^# hash' dm.toml) == "$(grep '^# hash' again.toml)" ]] || complain "config: not the values that were printed"
  "$binary" config >full.toml 2>stderr && "$binary" config --config full.toml >again.toml 2>stderr
  grep -q 'full.toml:' again.toml && complain "config: a file edits options that it leaves as they are"

  # The depth camera needs no IMU, and what is written is a calibration.
  checks=$((checks + 1))
  "$binary" simulate --preset fast --size 320x240 --duration 2 --out data/moving >/dev/null 2>&1 || complain "simulate: exit code $?"
  sed -e 's/^cy_px = 120\..*/cy_px = 135/' -e 's/^calibration_source.*/calibration_source = "depth 15 px too low"/' \
    data/moving/calibration.toml >depth.toml
  "$binary" calibrate moving --data data --calibration depth.toml --depth-camera --out depth.toml >stdout 2>stderr ||
    complain "calibrate --depth-camera: exit code $?"
  grep -Eq '^  fitted  .* px, centre ' stdout || complain "calibrate --depth-camera does not say what it fitted"
  grep -q 'verdict .* is determined' stdout || complain "calibrate --depth-camera has no verdict"
  grep -q '^depth.toml: written, in place of a calibration (depth 15 px too low)' stderr ||
    complain "calibrate --depth-camera does not say what it replaced"
  "$binary" run moving --data data --calibration depth.toml --variant no-imu --frames :2 --out out >stdout 2>stderr ||
    complain "a run with the fitted depth camera: exit code $?"
  "$binary" inspect fr1_rpy --data data --frames 0:3 --json >stdout 2>stderr || complain "inspect of three frames: exit code $?"
  grep -q '"registration": null' stdout || complain "inspect --json: what was not measured is not null"
  refused "a depth camera within its uncertainty" 4 'does not determine a depth camera: edges move' 'hint:near and far' -- \
    calibrate fr1_rpy --data data --depth-camera --out out
  prints 'verdict +not determined' "a fit that is only shown" calibrate fr1_rpy --data data --depth-camera
  refused "too few frames for a depth camera" 4 'too few edges' 'hint:near and far' -- \
    calibrate fr1_rpy --data data --depth-camera --frames 0:3

  # An IMU in other units is refused before a calibration; `prepare` exits as `inspect` does.
  checks=$((checks + 1))
  "$binary" simulate --preset fast --format tum --duration 0.7 --size 320x240 --blur-samples 1 --in-motion --out in_g >/dev/null 2>&1
  awk -F, -v OFS=, 'NR > 1 {for (i = 5; i <= 7; i++) $i /= 9.81} 1' in_g/imu.csv >imu.csv && mv imu.csv in_g/imu.csv
  refused "a calibration by an IMU in units of gravity" 3 'units of gravity' -- calibrate in_g --out out
  "$binary" prepare in_g >stdout 2>stderr
  [[ $? == 3 ]] || complain "prepare of an IMU in units of gravity does not exit with 3"

  # Suites go by name from any folder; of two values for one key either counts.
  checks=$((checks + 1))
  "$binary" bench quickstart --data data --only variant=full --only variant=no-imu --only recording=walk --dry-run \
    >stdout 2>stderr || complain "a suite by its name: exit code $?"
  [[ $(grep -c freiburg1_walk stdout) == 2 ]] || complain "--only twice: not both variants"
  refused "a misspelt variant of --only" 2 "suite 'quickstart' has no such variant .nearest: full" 'hint:it has .*no-imu' \
    -- bench quickstart --data data --only variant=fll --dry-run
  refused "a misspelt key of --only" 2 'varient=full .nearest: variant' -- bench quickstart --data data --only varient=full --dry-run
  refused "nearly a suite" 3 "no suite 'quickstrat' .nearest: quickstart" 'hint:list suites' -- bench quickstrat --out out
  diff <("$binary" help eval mesh) <("$binary" eval mesh --help) >stderr || complain "help is not --help"
  refused "known, but absent" 3 'fr1_desk.*rgbd_dataset_freiburg1_desk' 'hint:fetch_datasets.sh fr1_desk' \
    -- run fr1_desk --data data --variant no-imu --out out
  refused "by hand" 3 'dorm1_slow' 'hint:Google Drive.*data/dorm1/dorm1_slow' \
    -- run dorm1_slow --data data --variant no-imu --out out
  refused "nearly known" 3 'fr1_dsk' 'hint:fr1_desk' -- run fr1_dsk --data data --variant no-imu --out out
}

# stopped SIGNAL ARGUMENT...: the signal arrives while frames are processed; nothing of the run is left, and what was
# there before still is.
stopped() {
  local signal=$1 status process attempt
  shift
  checks=$((checks + 1))
  "$binary" "$@" --out kept/out --threads 1 >stdout 2>stderr &
  process=$!
  # Once the hidden folder of the run is there, frames are being processed.
  for ((attempt = 0; attempt < 1000; ++attempt)); do
    if [[ -n $(find kept/out -name '.*.tmp' 2>/dev/null) ]]; then break; fi
    sleep 0.01
  done
  if ((attempt == 1000)); then complain "$1, SIG$signal: the run did not begin"; fi
  kill -s "$signal" "$process"
  wait "$process"
  status=$?
  if ((status != 130)); then complain "$1, SIG$signal: exit code $status instead of 130"; fi
  # A suite keeps what it was asked for, so that it can be gone on with.
  local left
  left=$(find kept -mindepth 1 -not -path 'kept/out/.fusebench*' -not -path kept/file | tr '\n' ' ')
  if [[ -n $left && ! ($1 == bench && $left == 'kept/out ') ]]; then complain "$1, SIG$signal: left $left"; fi
  rm -rf kept/out
  [[ $(cat kept/file) == mine ]] || complain "$1, SIG$signal: touched what was there before"
  [[ $(grep -c '^error: ' stderr) == 1 ]] || complain "$1, SIG$signal: not exactly one message"
  if [[ -s stdout ]]; then complain "$1, SIG$signal: a result on standard output"; fi
}

# ended SIGNAL SECONDS ARGUMENT...: a signal after so many seconds of work ends the program within a second, with one
# message and nothing left.
ended() {
  local signal=$1 after=$2 status process from took
  shift 2
  checks=$((checks + 1))
  "$binary" "$@" >stdout 2>stderr &
  process=$!
  sleep "$after"
  from=${EPOCHREALTIME/./}
  kill -s "$signal" "$process" || complain "$1 $2, SIG$signal: it had ended before"
  wait "$process"
  status=$?
  took=$((${EPOCHREALTIME/./} - from))
  if ((status != 130)); then complain "$1 $2, SIG$signal: exit code $status instead of 130"; fi
  if ((took > 1000000)); then complain "$1 $2, SIG$signal: took $took us"; fi
  [[ $(grep -c '^error: stopped by the user' stderr) == 1 ]] || complain "$1 $2, SIG$signal: not exactly one message"
  if [[ -s stdout ]]; then complain "$1 $2, SIG$signal: a result on standard output"; fi
  if [[ -n $(find kept -mindepth 1 -not -path kept/file) ]]; then complain "$1 $2, SIG$signal: left $(find kept | tr '\n' ' ')"; fi
}

check_interrupt() {
  fresh_copy
  mkdir -p kept data
  mv freiburg1_copy data
  printf 'mine' >kept/file
  printf 'name = "s"\nall = true\nvariants = ["no-imu", "dm-no-imu"]\n' >suite.toml
  stopped INT run data/freiburg1_copy --variant no-imu
  stopped TERM run data/freiburg1_copy --variant no-imu
  stopped INT bench suite.toml --data data
  stopped INT bench suite.toml --data data -j 2
  corner_obj 1 0 >truth.obj
  corner_obj 1 0.01 >rec.obj
  for signal in INT TERM; do
    ended $signal 0.5 eval mesh rec.obj truth.obj --samples 50000000 --threads 1 --colored kept/colored.ply
    ended $signal 1 simulate --preset fast --duration 60 --out kept/new/simulated
  done
}

# The part of a record that repeats: all before the timing, and no thread count (the provenance comes after it).
reproducible_part() { sed '/"timing"/,$d' "$1"; }

check_determinism() {
  fresh_copy
  local threads reference='' first='' folder name
  for threads in 1 2 8 1; do
    checks=$((checks + 1))
    rm -rf out
    if ! folder=$("$binary" run freiburg1_copy --variant full --imu synthetic --threads "$threads" --out out 2>stderr); then
      complain "run with $threads threads"
      continue
    fi
    # Five frames of 12 mm have no ATE.
    [[ $(grep -cv '^no ATE: \|^  hint: \|^\.\.\. ' stderr) == 1 ]] || complain "$threads threads: more than the summary on standard error"
    if [[ -z $reference ]]; then
      reference=reference
      mv "$folder" "$reference"
      first=$folder
      continue
    fi
    [[ $folder == "$first" ]] || complain "$threads threads: folder $folder instead of $first"
    for name in trajectory.tum truth.tum mesh.ply intensity.bin patches.csv log.txt; do
      cmp -s "$reference/$name" "$folder/$name" || complain "$threads threads: $name differs"
    done
    cmp -s <(reproducible_part "$reference/record.json") <(reproducible_part "$folder/record.json") ||
      complain "$threads threads: record.json differs before its timing"
    [[ $(reproducible_part "$folder/record.json" | wc -l) -gt 50 ]] || complain "there is hardly a record to compare"
  done

  # The filter's matrices need more than a small stack.
  checks=$((checks + 1))
  rm -rf out
  if folder=$(ulimit -s 512 && "$binary" run freiburg1_copy --variant full --imu synthetic --threads 2 --out out 2>stderr); then
    cmp -s <(reproducible_part reference/record.json) <(reproducible_part "$folder/record.json") || complain "a small stack: record.json differs"
  else
    complain "a small stack: exit code $?"
  fi

  # Runs side by side are the same runs, in the same order.
  mkdir -p data && mv freiburg1_copy data
  printf 'name = "s"\nall = true\nvariants = ["no-imu", "dm-no-imu"]\n' >suite.toml
  checks=$((checks + 1))
  "$binary" bench suite.toml --data data --out one --json >one.json 2>stderr || complain "bench"
  (ulimit -s 512 && "$binary" bench suite.toml --data data --out one_more --json -j 2) >two.json 2>stderr || complain "bench -j 2"
  cmp -s one.json <(sed 's/one_more/one/' two.json) || complain "bench -j 2: other outcomes"
  while read -r name; do
    cmp -s <(reproducible_part "one/$name") <(reproducible_part "one_more/$name") || complain "bench -j 2: $name differs"
  done < <(cd one && find . -name record.json -o -name trajectory.tum -o -name intensity.bin)
  [[ $(find one_more -name record.json | wc -l) == 2 ]] || complain "bench -j 2: not two runs"

  # A criterion decides the exit code.
  printf '[[criteria]]\ntitle = "t"\nvariant = "no-imu"\nmetric = "frames_lost"\nstatistic = "worst"\nat_most = 0\n' >>suite.toml
  checks=$((checks + 1))
  "$binary" bench suite.toml --data data --out one --summary sums/s.json --summary-page s.html >stdout 2>stderr ||
    complain "a criterion that passes: exit code $?"
  grep -q '1 of 1 criteria passed' stdout || complain "a criterion that passes is not told"
  grep -q '"verdict": "PASS"' sums/s.json || complain "a criterion that passes is not in the summary"
  grep -q '<canvas' s.html || grep -q '<table>' s.html || complain "the summary's page has no table"
  sed -i 's/^at_most.*/at_least = 1/' suite.toml
  "$binary" bench suite.toml --data data --out one >stdout 2>stderr
  (($? == 1)) || complain "a criterion that fails: not exit code 1"
}

# without_times FILE: frames.csv without its last columns, the milliseconds of decoding and of each stage.
without_times() { sed -E 's/(,[^,]*){6}$//' "$1"; }

# same_but_times FOLDER FOLDER: the same files with the same bytes, but for times and the trace.
same_but_times() {
  local name
  diff <(cd "$1" && find . -type f ! -name trace.json | sort) <(cd "$2" && find . -type f ! -name trace.json | sort) ||
    return 1
  while read -r name; do
    case $name in
      ./record.json) cmp <(reproducible_part "$1/$name") <(reproducible_part "$2/$name") || return 1 ;;
      ./frames.csv) cmp <(without_times "$1/$name") <(without_times "$2/$name") || return 1 ;;
      *) cmp "$1/$name" "$2/$name" || return 1 ;;
    esac
  done < <(cd "$1" && find . -type f ! -name trace.json)
}

check_profile() {
  fresh_copy
  local threads plain profiled
  for threads in 1 2; do
    checks=$((checks + 1))
    plain=$("$binary" run freiburg1_copy --variant no-imu --threads "$threads" --out plain 2>stderr) || complain "a run"
    profiled=$("$binary" run freiburg1_copy --variant no-imu --threads "$threads" --out profiled --profile 2>stderr) ||
      complain "a profiled run"
    [[ ${plain#plain} == "${profiled#profiled}" ]] || complain "a profiled run has another folder: $profiled"
    same_but_times "$plain" "$profiled" >differences 2>&1 || complain "a profile changes more: $(head -3 differences)"
    [[ ! -e $plain/trace.json ]] || complain "a trace that nobody asked for"
    grep -q histogram_ms "$plain/record.json" && complain "a histogram that nobody asked for"
    grep -q '"histogram_ms"' "$profiled/record.json" || complain "no histogram in the record"
    python3 - "$profiled" "$threads" 2>stderr <<'TEXT' || complain "the profile with $threads threads"
import json, sys
folder, threads = sys.argv[1], int(sys.argv[2])
histograms = json.load(open(folder + "/record.json"))["timing"]["histogram_ms"]
assert list(histograms) == ["decode", "preprocess", "predict", "update", "fuse", "refresh", "frame"], list(histograms)
for h in histograms.values():
    assert h["count"] == sum(h["counts"]) and len(h["edges"]) == len(h["counts"]) + 1, h
    assert h["edges"][0] <= h["min"] <= h["median"] <= h["p90"] <= h["p99"] <= h["max"] <= h["edges"][-1], h
events = json.load(open(folder + "/trace.json"))["traceEvents"]
names = [e["args"]["name"] for e in events if e["ph"] == "M"]
assert names == ["fusebench freiburg1_copy no-imu", "frames"] + ["decoding ahead"] * (threads > 1), names
frames = [e for e in events if e["name"] == "frame"]
assert [e["args"]["frame"] for e in frames] == [0, 1, 2, 3, 4]
for e in events:
    if e["ph"] == "X":
        assert e["tid"] == (2 if threads > 1 and e["name"] == "decode" else 1), e
TEXT
  done

  # A suite repeats what has no profile, and nothing else.
  mkdir -p data && mv freiburg1_copy data
  printf 'name = "s"\nall = true\nvariants = ["no-imu"]\nkeep = "small"\n' >suite.toml
  checks=$((checks + 1))
  local step
  for step in 'false ' 'false --profile' 'true --profile' 'true '; do
    # shellcheck disable=SC2086  # none or one flag
    "$binary" bench suite.toml --data data --out suite --json ${step#* } >stdout 2>stderr ||
      complain "bench ${step#* }: exit code $?"
    grep -q "\"resumed\": ${step%% *}" stdout || complain "bench, $step: not as often as it should be"
  done
  [[ $(find suite -name trace.json | wc -l) == 1 ]] || complain "bench --profile: not one trace"
}

# curve OFFSET STRETCH: a trajectory of 60 poses on a helix, in TUM's format.
curve() {
  awk -v offset="$1" -v stretch="$2" 'BEGIN {
    for (i = 0; i < 60; i++) {
      a = 0.05 * i
      printf "%.4f %.9f %.9f %.9f 0 0 %.9f %.9f\n", 1305031100 + 0.1 * i + offset, stretch * cos(a), stretch * sin(a),
             stretch * 0.1 * a, sin(a / 2), cos(a / 2)
    }
  }'
}

# A camera that turns about two axes, one after the other, in TUM's format.
tumble() {
  awk 'BEGIN {
    for (i = 0; i < 60; i++) {
      a = 0.025 * (i % 30)
      printf "%.4f %.4f %.4f %.4f %.9f 0 %.9f %.9f\n", 1305031100 + 0.1 * i, cos(0.05 * i), sin(0.05 * i), sin(0.1 * i),
             i < 30 ? 0 : sin(a), i < 30 ? sin(a) : 0, cos(a)
    }
  }'
}

# swing OFFSET RATE: 12 s of a hand-held camera at RATE Hz on a clock that is OFFSET behind, in TUM's format.
swing() {
  awk -v offset="$1" -v rate="$2" 'BEGIN {
    for (i = 0; i < 12 * rate; i++) {
      t = i / rate
      a = 0.15 * sin(2.1 * t) + 0.1 * sin(5.3 * t + 1)
      printf "%.6f %.6f %.6f %.6f %.9f 0 0 %.9f\n", 1305031100 + t - offset, 0.3 * sin(1.7 * t) + 0.05 * sin(4.1 * t), 0.2 * cos(1.3 * t),
             0.1 * sin(2.9 * t), sin(a), cos(a)
    }
  }'
}

# prints PATTERN NAME ARGUMENT...: the program succeeds, says nothing on standard error, and prints the pattern.
prints() {
  local pattern=$1 name=$2
  shift 2
  checks=$((checks + 1))
  "$binary" "$@" >stdout 2>stderr || complain "$name: exit code $?"
  if grep -qv '^\.\.\. ' stderr; then complain "$name: something on standard error"; fi
  grep -qE -- "$pattern" stdout || complain "$name: does not print '$pattern'"
}

# accepted NAME PATTERN WARNING ARGUMENT...: the program succeeds, prints the pattern and the warning.
accepted() {
  local name=$1 pattern=$2 warning=$3
  shift 3
  checks=$((checks + 1))
  "$binary" "$@" >stdout 2>stderr || complain "$name: exit code $?"
  grep -qE -- "$pattern" stdout || complain "$name: does not print '$pattern'"
  grep -qE -- "^warning: .*$warning" stderr || complain "$name: does not warn of '$warning'"
}

# Names of columns, lost frames, more columns, whole matrices.
check_formats() {
  local files rmse
  prints '^formats: reference tum \(by its columns\), estimate tum \(by its columns\)$' "formats" eval ate gt.txt est.txt
  [[ $(head -1 stdout) == formats:* ]] || complain "formats are not in the first line"
  prints '"format_source": "by its columns"' "formats as JSON" eval ate gt.txt est.txt --json
  prints '^formats: tum \(by its columns\)$' "formats of a list" eval traj gt.txt est.txt
  prints '^formats: data euroc \(by its columns\), gt tum \(by its columns\)$' "formats that differ" eval traj data.csv gt.txt
  rmse=$("$binary" eval ate gt.txt est.txt | grep '^rmse')
  (echo "timestamp,tx,ty,tz,qx,qy,qz,qw" && tr ' ' , <est.txt) >names.csv
  (echo "num,t,x,y,z,qx,qy,qz,qw" && awk '{ print NR "," $0 }' est.txt | tr ' ' ,) >numbered.csv
  (echo "%time,field.header.stamp,$(printf 'field.pose.position.%s,' x y z)$(printf 'field.pose.orientation.%s,' x y z)field.pose.orientation.w" &&
    awk '{ print $1 + 1, $0 }' est.txt | tr ' ' ,) >ros.csv
  (echo "#timestamp x y z qx qy qz qw id" && awk '{ print $0, NR }' est.txt) >id.txt
  for files in names.csv numbered.csv ros.csv id.txt; do
    checks=$((checks + 1))
    "$binary" eval ate tum gt.txt "$files" >stdout 2>stderr || complain "$files: exit code $?"
    [[ $(grep '^rmse' stdout) == "$rmse" ]] || complain "$files: another error than of est.txt"
    head -1 stdout | grep -q 'estimate tum (names in line 1)$' || complain "$files: the source of the format is not printed"
  done
  awk 'NR % 10 == 5 { print $1, "nan nan nan nan nan nan nan"; next } NR % 10 == 6 { print $1, "0 0 0 0 0 0 0"; next } { print }' est.txt >lost.txt
  awk 'NR % 10 != 5 && NR % 10 != 6' est.txt >kept.txt
  for files in evo tum rpg; do
    accepted "lost frames with $files" '^rmse' 'lost.txt:5: 12 of 60 rows are of lost frames' eval ate gt.txt lost.txt --protocol "$files"
    [[ $(grep '^rmse' stdout) == "$("$binary" eval ate gt.txt kept.txt --protocol "$files" | grep '^rmse')" ]] ||
      complain "lost frames with $files: another error than without their rows"
  done
  awk '{ print $0, "0 0 0 1" }' kitti.txt >whole.txt
  prints 'by the number of the pose' "whole matrices" eval ate whole.txt kitti.txt
  awk '{ print NR - 1, $0 }' kitti.txt >counted.txt
  awk 'NR % 10 != 5' counted.txt >gaps.txt
  prints 'by the number of the frame' "matrices after numbers" eval ate counted.txt gaps.txt
  grep -q '^pairs .*54 of 54' stdout || complain "matrices after numbers: another number of pairs"
  paste -d ' ' <(cut -d ' ' -f 1 gt.txt) kitti.txt >stamped.txt
  prints 'estimate kitti \(by its columns, matrices after a stamp\)' "matrices after stamps" eval ate gt.txt stamped.txt
  sed 's/[^ ]*/"&"/g; s/ /,/g' est.txt >quoted.csv
  "$binary" eval ate gt.txt quoted.csv | grep -qxF "$rmse" || complain "quoted cells: another error than of est.txt"
  awk '{ split($1, t, "."); $1 = t[1] " " substr(t[2] "000000000", 1, 9) + 0; print }' est.txt >halves.txt
  accepted "stamps in two columns" '^rmse' 'seconds and nanoseconds in two columns' eval ate gt.txt halves.txt
  [[ $(grep '^rmse' stdout) == "$rmse" ]] || complain "stamps in two columns: another error than of est.txt"
  sed 's/[. ]/,/g' est.txt >commas.csv
  refused "decimal commas between commas" 3 'commas.csv:[0-9]+: decimal commas' 'hint:decimal point' -- eval ate gt.txt commas.csv
  sed 's/\./,/g' est.txt >commas.txt
  refused "decimal commas" 3 'commas.txt:1: decimal commas' 'hint:decimal point' -- eval ate tum gt.txt commas.txt
  refused "a line of names without a pose" 3 'few.csv:1: a line of names, but no column' 'hint:put # before' -- \
    eval ate gt.txt "$(sed '1s/qw/q/' names.csv >few.csv && echo few.csv)"
}

check_evaluation() {
  curve 0 1 >gt.txt
  curve 0.004 1.1 >est.txt
  awk '{ printf "%.0f,%s,%s,%s,%s,%s,%s,%s\n", $1 * 1e9, $2, $3, $4, $8, $5, $6, $7 }' gt.txt >data.csv
  awk '{ a = 0.05 * (NR - 1); printf "%.9f %.9f 0 %s %.9f %.9f 0 %s 0 0 1 %s\n", cos(a), -sin(a), $2, sin(a), cos(a), $3, $4 }' \
    gt.txt >kitti.txt

  prints 'protocol +evo \(evo v1.36.5\)' "protocol" eval ate gt.txt est.txt
  prints '60 of 60 possible \(coverage 100.0 %\)' "pairs" eval ate gt.txt est.txt
  prints 'alignment +sim3 from all pairs.*scale 0.90909' "evo's -as" eval ate gt.txt est.txt -as
  prints 'rmse +[0-9.]+e-1[0-9]' "a scaled copy" eval ate gt.txt est.txt -vas
  prints 'alignment +se3 from the first 10 pairs' "n_to_align" eval ate gt.txt est.txt -a --n_to_align 10
  # A side that does not move, moves on a line, or moves only upwards.
  awk '{ print $1, 1.1, 2.2, 3.3, 0, 0, 0, 1 }' gt.txt >still.txt
  awk '{ printf "%s %.4f %.4f %.4f 0 0 0 1\n", $1, 0.0371234 * NR, 0.0212345 * NR, -0.0132173 * NR }' gt.txt >line.txt
  awk '{ printf "%s 0.7 -0.3 %.4f 0 0 0 1\n", $1, sin(0.1 * NR) }' gt.txt >rising.txt
  local mode
  for mode in -a -as -s '--align yaw' '--align_origin -s' '--protocol tum' '--protocol rpg' '--protocol eth3d'; do
    # shellcheck disable=SC2086
    refused "a still reference, $mode" 3 'cannot be aligned: the reference does not move' 'hint:--align origin' -- eval ape still.txt gt.txt $mode
    # shellcheck disable=SC2086
    refused "a still estimate, $mode" 3 'cannot be aligned: the estimate does not move' 'hint:--align origin' -- eval ape gt.txt still.txt $mode
  done
  refused "a still trajectory with a reference" 3 'the estimate does not move' -- eval traj still.txt --ref gt.txt -a
  refused "a still estimate over motions" 3 'the estimate does not move' -- eval rpe gt.txt still.txt -as
  accepted "a still estimate by its first pose" 'rmse' 'does one of them not move' eval ape gt.txt still.txt --align origin
  accepted "a still estimate as it is" 'rmse' 'does one of them not move' eval ape gt.txt still.txt
  refused "a line" 3 'the reference moves along a straight line' -- eval ape line.txt line.txt -a
  for mode in -s '--align_origin -s' '--align scale'; do
    # shellcheck disable=SC2086
    refused "a line, $mode" 3 'moves along a straight line' 'hint:--align origin .* in place of -a, -s' -- eval ate line.txt line.txt $mode
  done
  prints 'rmse' "a line, as the hint says" eval ate line.txt line.txt --align origin
  prints 'rmse' "a line about the vertical" eval ape line.txt line.txt --align yaw
  refused "a vertical line" 3 'the estimate does not move horizontally' -- eval ape gt.txt rising.txt --align yaw
  prints '60 of 60 possible' "a limit without an end" eval ape gt.txt est.txt --protocol tum --t_max_diff 1e300
  # 3 s without a pose: evaluate_rpe.py pairs the pose before it with itself.
  sed '21,50d' est.txt >gap.txt
  checks=$((checks + 1))
  "$binary" eval rpe gt.txt gap.txt --protocol tum >stdout 2>stderr || complain "a gap: exit code $?"
  grep -q '^warning: poses without a pose a delta later.*: 1;' stderr || complain "a pose paired with itself is not told"
  grep -qE '^min +0( |$)' stdout && complain "a pose is compared with itself"
  tumble >tumble.txt
  prints 'fitted offset +\(.*the camera in the reference' "a fitted offset" eval ate tumble.txt tumble.txt --fit_offset
  prints 'trans_part_offset_fitted \[mm\]' "a fitted offset in mm" eval ate tumble.txt tumble.txt --fit_offset --change_unit mm
  swing 0 100 >swing.txt
  swing 0.066 30 >late.txt
  prints 'reference clock: t_reference = t_estimate \+ 0.066[0-9]+ s, standard deviation 0.000' "the reference's clock" \
    eval ate swing.txt late.txt -a --t_max_diff 0.02 --fit-time-offset
  prints 'undetected failures +[0-9]+ +0$' "silent failures without an offset" eval ape swing.txt late.txt --t_max_diff 0.02 --fit_time_offset
  prints 'trans_part_clock_fitted \[mm\]' "errors with the fitted clock" \
    eval ape swing.txt late.txt -a --t_max_diff 0.02 --fit-time-offset --change_unit mm
  prints 'angle_deg_clock_fitted \[deg\]' "relative errors with the fitted clock" eval rpe swing.txt late.txt --protocol tum --fit-time-offset
  prints '"offset_s": 0.066' "the clock as JSON" eval rpe swing.txt late.txt --protocol tum --fit-time-offset --json
  prints 't_estimate - 0.034[0-9]+ s' "the clock after an offset" eval ate swing.txt late.txt --t_max_diff 0.02 --t_offset 0.1 --fit-time-offset
  prints 'reference clock: t_reference = t_estimate \+ 0.066' "clocks of trajectories" eval traj late.txt --ref swing.txt --fit-time-offset
  prints '"applied": "fitted"' "clocks of trajectories as JSON" eval traj late.txt --ref swing.txt --fit-time-offset --json
  prints 'trans_part \[cm\]' "change_unit" eval ate gt.txt est.txt --change_unit cm
  prints 'angle_deg \[deg\]' "relation" eval ate gt.txt est.txt --pose_relation angle_deg
  prints 'data.csv \(euroc\): 60 poses' "euroc" eval ate data.csv est.txt -a
  refused "TUM text as euroc" 3 'est.txt:1: no commas' 'hint:say tum' -- eval traj euroc est.txt
  prints 'estimate +est.txt \(tum\)' "euroc against tum" eval ate euroc data.csv est.txt -a
  prints 'by the number of the pose' "kitti" eval ate kitti kitti.txt kitti.txt
  prints 'consecutive, delta 1 f, selected from the estimate' "rpe" eval rpe gt.txt est.txt
  prints 'all, delta 0.3 m within 10 %' "rpe of all pairs" eval rpe gt.txt est.txt --all_pairs -d 0.3 -u m
  prints 'fixed delta, delta 1 s' "rpe of tum" eval rpe gt.txt est.txt --protocol tum
  prints 'length \[m\] +segments' "rpe of rpg" eval rpe gt.txt est.txt --protocol rpg
  prints 'held where it has no pose' "eth3d" eval ate gt.txt est.txt --protocol eth3d
  prints '"protocol": "evo"' "JSON" eval rpe gt.txt est.txt --json
  grep -Eq '"(errors|timestamps_ns)"' stdout && complain "JSON lists errors that nobody asked for"
  prints '"errors": \[' "JSON with each error" eval rpe gt.txt est.txt --json --all_errors
  prints '"timestamps_ns": \[' "JSON with each stamp" eval rpe gt.txt est.txt --json --all_errors --protocol tum
  refused "each error of no JSON" 2 'all_errors requires --json' 'hint:--errors' -- eval rpe gt.txt est.txt --all_errors
  prints 'rmse' "errors as a file" eval ate gt.txt est.txt --errors errors/ate.csv
  [[ $(head -1 errors/ate.csv) == timestamp_ns,trans_part_m ]] || complain "errors as a file: $(head -1 errors/ate.csv)"
  [[ $(wc -l <errors/ate.csv) == 61 ]] || complain "errors as a file: not 60 errors"

  for i in 1 2 3 4; do curve $((100 * i)) 1; done >long.txt
  sed '7p' long.txt >rare.txt
  checks=$((checks + 1))
  "$binary" eval ate rare.txt long.txt >stdout 2>stderr || complain "a rare repeat: exit code $?"
  grep -q 'warning: rare.txt:8: 1 of 241 rows repeat a stamp (both are kept)' stderr || complain "a rare repeat is not told"

  prints 'rmse' "errors of tum's motions as a file" eval rpe gt.txt est.txt --protocol tum --errors errors/rpe.csv
  [[ $(sed -n 2p errors/rpe.csv) =~ ^13050311[0-9]{11}, ]] || complain "errors of tum's motions have no stamps"

  # Each pose with each pose of 2100: more motions than are listed, but not than are compared.
  awk 'BEGIN { for (i = 0; i < 2100; ++i) printf "%.2f %.9f %.9f 0 0 0 0 1\n", i / 20, cos(i / 50), i / 100 }' >many.txt
  prints 'errors +4410000 +4410000' "many motions" eval rpe many.txt many.txt --protocol tum --all_pairs
  prints '"count": 4410000' "many motions as JSON" eval rpe many.txt many.txt --protocol tum --all_pairs --json
  refused "many motions in JSON" 2 '4410000 motions.*1048576' 'hint:--downsample' -- \
    eval rpe many.txt many.txt --protocol tum --all_pairs --json --all_errors
  refused "a list of many motions" 2 '4410000 motions.*0.3 GB.*4194304' 'hint:--downsample' -- \
    eval rpe many.txt many.txt --protocol tum --all_pairs --errors out

  awk '{ print $0, "1e-4 0 0 1e-4 0 1e-4 1e-3 0 0 1e-3 0 1e-3" }' est.txt >openvins.txt
  prints 'NEES / 3 mean' "NEES" eval nees gt.txt openvins.txt --align origin --errors errors/nees.csv
  [[ $(wc -l <errors/nees.csv) == 60 ]] || complain "NEES as a file: not 59 poses within the truth"
  prints '"metric": "nees"' "NEES as JSON" eval nees gt.txt openvins.txt --json
  prints 'openvins.txt \(openvins\): 60 poses' "an estimate with covariances" eval ate gt.txt openvins.txt
  refused "no covariances" 2 'no covariances' 'hint:20 columns' -- eval nees gt.txt est.txt
  refused "a negative variance" 3 'openvins.txt:3: a variance is below zero' -- \
    eval nees gt.txt "$(sed -i '3s/1e-3$/-1e-3/' openvins.txt && echo openvins.txt)"

  refused "a folder as a trajectory" 3 '\.: a folder, where a trajectory is needed' 'hint:trajectory\.tum' -- eval ate gt.txt .
  refused "no such trajectory" 3 'absent.txt' -- eval ate absent.txt est.txt
  refused "one file" 2 'GT and EST; 1 is given' -- eval ate gt.txt
  refused "no metric" 2 'fusebench eval. is given without a verb' -- eval
  refused "unknown protocol" 2 "unknown protocol 'tums'" 'hint:evo, tum' -- eval ate gt.txt est.txt --protocol tums
  refused "unknown relation" 2 'angle' -- eval ate gt.txt est.txt -r angle
  refused "unknown unit" 2 "delta unit 'x'" -- eval rpe gt.txt est.txt -u x
  refused "unit of another kind" 2 'change_unit deg' 'hint:mm' -- eval ate gt.txt est.txt --change_unit deg
  refused "no poses" 2 'downsample: 0 .allowed: above 0' -- eval ape gt.txt est.txt --downsample 0
  refused "less than no poses" 2 'downsample: -3 .allowed: above 0' -- eval ape gt.txt est.txt --downsample -3
  refused "a list of no poses" 2 'downsample: 0 .allowed: above 0' -- eval traj gt.txt --downsample 0
  refused "an alignment of no pairs" 2 'n_to_align: 0 .allowed: above 0' -- eval ape gt.txt est.txt --n_to_align 0 -a
  refused "a motion below zero" 2 'motion_filter: -1 .allowed: 0 or more' -- eval ape gt.txt est.txt --motion_filter -1 0
  refused "an offset that is no number" 2 't_offset: nan .allowed: -4e9 to 4e9' -- eval ape gt.txt est.txt --t_offset nan
  refused "a start that is no number" 2 't_start: nan .allowed: -4e9 to 4e9' -- eval ape gt.txt est.txt --t_start nan
  refused "no frames" 2 'delta = 0 f .allowed: whole frames, 1 to 1e9' -- eval rpe gt.txt est.txt -d 0
  refused "half a frame" 2 'delta = 0.5' -- eval rpe gt.txt est.txt -d 0.5
  refused "deltas of segments" 2 'lengths' -- eval rpe gt.txt est.txt --protocol rpg -d 1
  refused "an offset of a motion about one axis" 3 'does not tell' -- eval ate gt.txt est.txt -a --fit_offset
  refused "a fitted offset of relative errors" 2 'fit_offset' -- eval rpe gt.txt est.txt --fit_offset
  refused "the clock of a steady motion" 3 'clock offset is not observable' -- eval ate gt.txt est.txt --fit-time-offset
  refused "the clocks of steady motions" 3 'est.txt: the clock offset is not observable' -- eval traj est.txt --ref gt.txt --fit-time-offset
  refused "a clock without stamps" 2 'fit-time-offset: the trajectories have no stamps' -- eval ate kitti.txt kitti.txt --fit-time-offset
  refused "a clock without a reference" 2 'fit-time-offset needs a reference' 'hint:--ref' -- eval traj late.txt --fit-time-offset
  refused "kitti's absolute error" 2 'no absolute error' -- eval ate gt.txt est.txt --protocol kitti
  refused "two alignments" 2 'exclude each other' -- eval ate gt.txt est.txt -a --align sim3
  refused "stamps on one side" 2 'no stamps' -- eval ate gt.txt kitti.txt
  refused "numbers by time" 2 'by time' -- eval rpe kitti.txt kitti.txt -d 1 -u s
  curve 1000 1 >other_clock.txt
  refused "another clock" 3 'match within 0.01 s' 'hint:t_offset' -- eval ate gt.txt other_clock.txt
  prints '^rmse' "another clock, moved back" eval ate gt.txt other_clock.txt --t_offset -1000
  awk '{ print $1, NR, 0, 0, 0, 0, 0, 1 }' gt.txt >line.txt
  refused "a line" 3 'along a straight line' 'hint:origin|yaw' -- eval ate -a line.txt est.txt
  refused "a pipe" 3 'cannot be read as a file' -- eval ate gt.txt <(curve 1 1)
  refused "motions too long" 3 'no motion of 60 poses' -- eval rpe gt.txt est.txt -d 1000
  refused "a short row" 3 'short.txt:5' -- eval ate "$(sed '5s/ [^ ]*$//' gt.txt >short.txt && echo short.txt)" est.txt
  refused "not a number" 3 'nan.txt:7' -- eval ate "$(sed '7s/^[^ ]*/nan/' gt.txt >nan.txt && echo nan.txt)" est.txt
  refused "no quaternion" 3 'zero.txt:3.*norm 1e-09' -- \
    eval ate "$(sed '3s/.*/1305031100.2 0 0 0 0 0 0 1e-9/' gt.txt >zero.txt && echo zero.txt)" est.txt
  check_formats
  refused "a repeated stamp" 3 'twice.txt:2.*line 1' 'hint:keep takes both' -- \
    eval ate "$(sed '1p' gt.txt >twice.txt && echo twice.txt)" est.txt
  refused "two trajectories" 3 'two.txt:61: time jumps back' 'hint:split' -- \
    eval ate "$(cat gt.txt est.txt >two.txt && echo two.txt)" est.txt
}

# archived NAME FILE ERRORS KIND ARGUMENT...: the program succeeds, and writes FILE as evo would read it.
archived() {
  local name=$1 file=$2 errors=$3 kind=$4
  shift 4
  checks=$((checks + 1))
  "$binary" "$@" --save_results "$file" --silent >stdout 2>stderr || complain "$name: exit code $?"
  if [[ -s stdout || -s stderr ]]; then complain "$name: --silent says something"; fi
  "$here/evo_archive.py" check "$file" "$errors" "$kind" 2>stderr || complain "$name: not as evo reads it"
}

# What users of evo type.
check_evo() {
  curve 0 1 >gt.txt
  curve 0.004 1.1 >est.txt
  tumble >tumble.txt
  awk '{ a = 0.05 * (NR - 1); printf "%.9f %.9f 0 %s %.9f %.9f 0 %s 0 0 1 %s\n", cos(a), -sin(a), $2, sin(a), cos(a), $3, $4 }' \
    gt.txt >kitti.txt

  prints 'alignment +se3' "evo_ape" eval ape tum gt.txt est.txt -va --no_warnings
  prints 'alignment +se3' "a flag before files" eval ape --align gt.txt est.txt
  prints 'alignment +sim3' "--align as ours" eval ape tum gt.txt est.txt --align sim3
  prints 'alignment +sim3' "--align --correct_scale" eval ape tum gt.txt est.txt --align --correct_scale
  prints 'all, delta 0.3 m' "evo_rpe" eval rpe tum gt.txt est.txt -r angle_deg --delta 0.3 --delta_unit m --all_pairs --debug
  mkdir tum
  prints 'rmse' "a folder named as the format" eval ape tum gt.txt est.txt

  # Results, for evo and for ourselves.
  archived "APE" runs/ape.zip 60 tum eval ape tum gt.txt est.txt
  archived "APE with an alignment" sim3.zip 60 tum eval ape tum "$PWD/gt.txt" ./est.txt -as
  archived "RPE" rpe.zip 59 tum eval rpe tum gt.txt est.txt
  archived "RPE over a path" metres.zip "$("$binary" eval rpe gt.txt est.txt -d 0.3 -u m | awk '/^errors/ { print $2 }')" tum \
    eval rpe gt.txt est.txt -d 0.3 -u m
  archived "poses without stamps" kitti.zip 60 kitti eval ape kitti kitti.txt kitti.txt
  cp runs/ape.zip again.zip
  archived "the same again" again.zip 60 tum eval ape tum gt.txt est.txt
  cmp again.zip runs/ape.zip >stderr || complain "two archives of one evaluation differ"
  "$here/evo_archive.py" write evos.zip some/other.txt 1
  prints 'est.txt +[0-9.e-]+.*60$' "evo_res" eval res runs/ape.zip evos.zip
  prints 'other.txt +0.3 +0.2 +0.2 +0.1 +0.216 +0.14 +0.0816 +3$' "a result of evo's" eval res runs/ape.zip evos.zip --save_table table.csv
  [[ $(head -1 table.csv) == ,max,mean,median,min,rmse,sse,std ]] || complain "evo_res --save_table: $(head -1 table.csv)"
  prints '^evos.zip ' "--use_filenames" eval res runs/ape.zip evos.zip --use_filenames
  prints '"label": "other.txt"' "results as JSON" eval res evos.zip --json
  prints '^est.txt ' "--ignore_title --merge" eval res runs/ape.zip rpe.zip --ignore_title --merge
  refused "other metrics" 2 'rpe.zip is .RPE w.r.t' 'hint:--ignore_title' -- eval res runs/ape.zip rpe.zip
  refused "twice the same" 2 "estimate 'est.txt'" 'hint:--use_filenames' -- eval res runs/ape.zip again.zip
  refused "no archive" 3 'gt.txt: is no ZIP archive' -- eval res gt.txt
  refused "an archive that was cut off" 3 'cut.zip: is no ZIP archive, or was cut off' -- \
    eval res "$(head -c 300 evos.zip >cut.zip && echo cut.zip)"

  # Trajectories.
  prints $'\tt_end \\(s\\)\t1305031105.9' "evo_traj -v" eval traj tum gt.txt -v
  prints $'^infos:\t60 poses, 3.[0-9]+m path length, 5.900s duration$' "evo_traj" eval traj tum gt.txt est.txt --no_warnings
  prints $'\tv_avg \\(m/s\\)\t0.5' "--full_check" eval traj tum gt.txt --full_check
  sed 7p gt.txt >repeated.txt
  prints $'\ttimestamps\twrong, pose 7' "a repeated stamp" eval traj tum repeated.txt -f
  checks=$((checks + 1))
  "$binary" eval traj tum est.txt --ref=gt.txt -as --save_as_tum --save_as_kitti --save_table list.csv >stdout 2>stderr ||
    complain "evo_traj --save_as_tum: exit code $?"
  prints 'rmse +[0-9.]+e-1[0-9]' "what evo_traj aligned" eval ape tum gt.txt est.tum
  [[ $(awk '{ print NF }' est.kitti | sort -u) == 12 ]] || complain "--save_as_kitti: not 12 columns"
  [[ $(head -1 list.csv) == ,est,gt ]] || complain "evo_traj --save_table: $(head -1 list.csv)"
  refused "no reference" 2 'needs a reference' 'hint:--ref' -- eval traj tum est.txt -a
  refused "its own source" 2 'est.tum would be replaced' -- eval traj tum est.tum --save_as_tum
  refused "two of one name" 2 'into gt.tum' -- eval traj tum gt.txt tum/../gt.txt --save_as_tum
  refused "no trajectory" 2 'no trajectory' -- eval traj tum

  # Stamps in other units.
  local unit power
  for unit in milliseconds:3 microseconds:6 nanoseconds:9; do
    power=${unit#*:}
    awk -v power="$power" '{ $1 = sprintf("%.0f", $1 * 10 ^ power); print }' est.txt >units.txt
    checks=$((checks + 1))
    "$binary" eval ape tum gt.txt units.txt >stdout 2>stderr || complain "stamps in ${unit%:*}: exit code $?"
    [[ $(<stderr) == "warning: units.txt:1: stamps are read as ${unit%:*}, by their size" ]] || complain "stamps in ${unit%:*}: not told"
    grep -q '60 of 60 possible' stdout || complain "stamps in ${unit%:*}: not all associated"
  done
  awk '{ $1 = sprintf("%.0f", ($1 - 1305031100) * 1000); print }' gt.txt >relative.txt
  prints '5.900s duration' "a unit that is told" eval traj relative.txt --stamp_unit ms
  refused "an unknown unit" 2 "unit of stamps 'min'" -- eval ape gt.txt est.txt --stamp_unit min
  refused "an unknown second unit" 2 "unit of stamps 'min'" -- eval ape gt.txt est.txt --stamp_unit s,min
  awk '{ $1 = sprintf("%.3f", $1 - 1305031100); print }' gt.txt >seconds.txt
  awk '{ $1 = sprintf("%.0f", ($1 - 1305031100) * 1000000000); print }' gt.txt >nanoseconds.txt
  prints '60 of 60 possible' "a unit for either side" eval ape seconds.txt relative.txt --stamp_unit s,ms
  accepted "one unit for files that can be in it" '60 of 60 possible' 'seconds.txt:1: stamps such as [0-9.]* are no nanoseconds' \
    eval ape tum seconds.txt nanoseconds.txt --stamp_unit ns
  refused "another unit" 3 'match within' 'hint:--stamp_unit REF,EST' -- eval ape seconds.txt relative.txt --t_offset 50
  prints '60 of 60 possible' "a huge limit" eval ape gt.txt est.txt --protocol tum --t_max_diff 1e300

  # What is not understood.
  refused "a bag" 2 'bags are not read' 'hint:--save_as_tum' -- eval ape bag run.bag /gt /est
  refused "a bag of ROS 2" 2 'bags are not read' 'hint:evo_traj bag2' -- eval traj bag2 run.db3 --all_topics
  refused "an unknown format" 2 "trajectory format 'tumm'" -- eval ape tumm gt.txt est.txt
  refused "five files" 2 'two files are required, GT and EST; 5 are given' -- eval ape a b c d e
  refused "a picture that is none" 2 'plot.png: plots are drawn as .svg or .pdf' 'hint:PNG' -- eval ape gt.txt est.txt --plot plot.png
  refused "TUM's flag" 2 "TUM's scripts" 'hint:--t_max_diff' -- eval ate gt.txt est.txt --max_difference 0.02
  refused "TUM's flag of rpe" 2 "TUM's scripts" 'hint:--protocol tum' -- eval rpe gt.txt est.txt --fixed_delta
  refused "a LaTeX table" 2 'only CSV' 'hint:--format latex' -- eval traj tum est.txt --save_table out.tex
  refused "a LaTeX table of results" 2 'only CSV' -- eval res runs/ape.zip --save_table out.tex
  refused "no counterpart" 2 "evo's --rerun has no counterpart" 'hint:--save_plot' -- eval ape tum gt.txt est.txt --rerun
  refused "a misspelt option" 2 'eval ate. has no option --alignn \(nearest: --align\)' -- eval ape gt.txt est.txt --alignn
  refused "an unknown alignment" 2 "no alignment 'foo' .allowed none, se3, " 'hint:without a mode' -- eval ape --align foo gt.txt est.txt
  refused "a misspelt alignment" 2 "no alignment 'smi3' .*nearest: sim3" -- eval ape gt.txt est.txt --align smi3
  refused "an absent file to align" 3 'absent.txt' -- eval ape --align absent.txt est.txt
  refused "an unknown view" 2 'plot_mode' -- eval ape gt.txt est.txt --plot_mode xx
  touch obstacle
  refused "no place for a log" 4 'logfile obstacle/log' -- eval traj gt.txt --silent --logfile obstacle/log
  "$binary" eval traj gt.txt --silent --logfile absent/deep/log >stdout 2>stderr && [[ -s absent/deep/log ]] ||
    complain "--logfile does not make its folder"

  checks=$((checks + 1))
  "$binary" eval ape gt.txt est.txt --silent --logfile log.txt || complain "--logfile: exit code $?"
  "$binary" eval traj gt.txt --silent --logfile log.txt || complain "--logfile again: exit code $?"
  [[ $(grep -cE '^(rmse|infos:)' log.txt) == 2 ]] || complain "--logfile does not hold what was said"

  if ! command -v gnuplot >/dev/null; then return; fi
  local verb
  checks=$((checks + 1))
  "$binary" eval ape tum gt.txt est.txt -vap >/dev/null 2>stderr || complain "-vap: $?"
  "$binary" eval rpe tum gt.txt est.txt -p plots/rpe.pdf --plot_mode xz --plot_x_dimension index >/dev/null 2>stderr || complain "-p FILE: $?"
  "$binary" eval ape kitti kitti.txt kitti.txt --plot --save_plot kitti.svg --plot_mode=xy >/dev/null 2>stderr || complain "--save_plot: $?"
  "$binary" eval traj tum gt.txt est.txt --ref gt.txt -a --plot >/dev/null 2>stderr || complain "evo_traj --plot: $?"
  "$binary" eval res runs/ape.zip evos.zip --save_plot res.svg >/dev/null 2>stderr || complain "evo_res --save_plot: $?"
  [[ $(head -c 4 plots/rpe.pdf) == %PDF ]] || complain "-p FILE.pdf draws no PDF"
  for verb in ape traj res kitti; do
    grep -q '</svg>' $verb.svg || complain "$verb.svg is not drawn"
    ! grep -qi 'nan"\|>nan<' $verb.svg || complain "$verb.svg shows what is no number"
  done
  grep -q 'APE w.r.t. translation part (m) (with SE(3) Umeyama alignment)' ape.svg || complain "ape.svg has no title"
}

# corner_obj FACTOR SHIFT: floor and two walls of a room of 4 x 3 x 2.5 m, times FACTOR, moved by SHIFT along z.
corner_obj() {
  awk -v f="$1" -v d="$2" '{ print "v", f * $1, f * $2, f * $3 + d }' <<'TEXT'
0 0 0
4 0 0
4 3 0
0 3 0
0 0 2.5
4 0 2.5
0 3 2.5
TEXT
  printf 'f 1 2 3 4\nf 1 2 6 5\nf 1 4 7 5\n'
}

check_meshes() {
  corner_obj 1 0 >truth.obj
  corner_obj 1 0.01 >rec.obj
  corner_obj 1000 0 >millimetres.obj
  printf '1 0 0 0\n0 1 0 0\n0 0 1 -0.01\n0 0 0 1\n' >down.txt
  curve 0 1 >gt.txt

  prints 'alignment +none' "no alignment" eval mesh rec.obj truth.obj
  prints 'samples +reconstruction: 200000 even over the area \(seed 1\)' "samples" eval mesh rec.obj truth.obj
  prints 'samples +reconstruction: 7 vertices' "vertices" eval mesh rec.obj truth.obj --samples vertices
  prints 'max +0.01 +0.01' "statistics" eval mesh rec.obj truth.obj --samples vertices
  prints '0.02 +100.00 +100.00 +100.00' "thresholds" eval mesh rec.obj truth.obj --thresholds 0.02,0.005
  prints 'alignment +file: rotated by 0.0000 deg, translated by \(0.0000, 0.0000, -0.0100\) m' "a transform" \
    eval mesh rec.obj truth.obj --align file --transform down.txt
  prints 'alignment +icp: .*-0.0100\) m \([0-9]+ steps from its own pose' "icp" eval mesh rec.obj truth.obj --align icp
  prints 'from the file' "icp from a transform" eval mesh rec.obj truth.obj --align icp --transform down.txt
  prints 'alignment +trajectory: rotated by 0.0000 deg' "trajectories" \
    eval mesh truth.obj truth.obj --align trajectory --trajectories gt.txt gt.txt
  prints 'scale +the reconstruction times 0.001' "millimetres" eval mesh millimetres.obj truth.obj --scale 0.001
  prints '"surfreg_m": 0.0(1|09999)[0-9]*,' "JSON" eval mesh rec.obj truth.obj --json --samples vertices
  { printf 'ply\nformat ascii 1.0\nelement vertex 4\n' && printf 'property float %s\n' x y z nx ny nz radius &&
    printf 'end_header\n0 0 0.01 0 0 1 0.02\n4 0 0.01 0 0 1 0.02\n4 3 0.01 0 0 1 0.02\n0 3 0.01 0 0 1 0.02\n'; } >surfels.ply
  prints 'reconstruction +surfels.ply: 4 surfels, 4 x 3 x 0 m' "the size of surfels" eval mesh surfels.ply truth.obj
  prints 'samples +reconstruction: 4 vertices' "centres of surfels" eval mesh surfels.ply truth.obj --samples vertices
  prints 'SurfReg +0.01 m' "SurfReg's score of surfels" eval mesh surfels.ply truth.obj
  { grep ^v rec.obj && printf 'v 0 0 900\nv 0 0 -900\n' && grep ^f rec.obj; } >loose.obj
  for samples in vertices 1000; do
    checks=$((checks + 1))
    local largest=0.01
    if [[ $samples == vertices ]]; then largest=900; fi
    "$binary" eval mesh loose.obj truth.obj --samples $samples >stdout 2>stderr && grep -qE "^max +$largest " stdout ||
      complain "--samples $samples of vertices of no triangle: not $largest"
    grep -q 'are both meshes in metres' stderr && complain "vertices of no triangle count in the size"
    grep -q '^warning: 2 of 9 vertices of the reconstruction belong to no triangle' stderr || complain "vertices of no triangle are not counted"
  done
  checks=$((checks + 1))
  "$binary" eval mesh rec.obj truth.obj --colored colored.ply >stdout 2>stderr || complain "a coloured mesh: exit code $?"
  grep -q 'yellow at 0.05 m' stderr || complain "a coloured mesh: its range is not told"
  [[ $(head -c 3 colored.ply) == ply ]] || complain "a coloured mesh was not written"
  "$binary" eval mesh rec.obj truth.obj --colored absent/deep/colored.ply >stdout 2>stderr && [[ -s absent/deep/colored.ply ]] ||
    complain "--colored does not make its folder"
  printf half >.again.ply.77.tmp
  touch -d '2 hours ago' .again.ply.77.tmp
  ln -s kept.ply again_link.ply
  "$binary" eval mesh rec.obj truth.obj --colored again.ply >stdout 2>stderr && cmp -s again.ply colored.ply &&
    [[ ! -e .again.ply.77.tmp ]] || complain "--colored leaves what a killed one left"
  printf old >kept.ply
  "$binary" eval mesh rec.obj truth.obj --colored again_link.ply >stdout 2>stderr && [[ ! -L again_link.ply ]] &&
    cmp -s again_link.ply colored.ply && [[ $(cat kept.ply) == old ]] || complain "--colored changes the target of a link"

  awk '/^v/ { print "v", -$3 + 2, $2 * 0.9 - $4 * 0.4 + 3, $2 * 0.4 + $4 * 0.9 - 1; next } { print }' truth.obj >first_camera.obj
  refused "an icp that sticks" 3 'ended in a wrong minimum' 'hint:--trajectories TRUTH ESTIMATE' -- \
    eval mesh first_camera.obj truth.obj --align icp
  awk '/^v/ { print "v", $2 * 0.9063 - $3 * 0.4226, $2 * 0.4226 + $3 * 0.9063, $4; next } { print }' truth.obj >turned.obj
  checks=$((checks + 1))
  "$binary" eval mesh turned.obj truth.obj --align icp >stdout 2>stderr || complain "icp from far: exit code $?"
  grep -q '^warning: icp had no start, moved .*--trajectories TRUTH ESTIMATE' stderr || complain "icp from far is not doubted"
  "$binary" eval mesh turned.obj truth.obj --align icp --json >stdout 2>stderr || complain "icp from far, JSON: exit code $?"
  grep -q '"doubt": "icp had no start, moved .*--trajectories TRUTH ESTIMATE' stdout || complain "the doubt of icp from far is not in JSON"
  prints '"doubt": null' "no doubt of icp in JSON" eval mesh rec.obj truth.obj --align icp --json
  refused "millimetres for metres" 3 'probably not in metres' 'hint:--scale 0.001' -- eval mesh millimetres.obj truth.obj
  refused "a folder as a mesh" 2 '\.: a folder, where a mesh is needed' 'hint:mesh\.ply' -- eval mesh . truth.obj
  refused "no such mesh" 3 'absent.ply' -- eval mesh absent.ply truth.obj
  refused "another ending" 2 "mesh of the unknown ending '.stl'" 'hint:PLY' -- eval mesh rec.stl truth.obj
  refused "an empty mesh" 3 'no triangles' -- eval mesh "$(grep ^v rec.obj >points.obj && echo points.obj)" truth.obj
  refused "a broken vertex" 3 'nan.obj:2' -- eval mesh "$(sed '2s/ 4 / nan /' rec.obj >nan.obj && echo nan.obj)" truth.obj
  refused "a file without its transform" 2 'requires --transform' -- eval mesh rec.obj truth.obj --align file
  refused "a transform without its mode" 2 'does not use --transform' 'hint:--align file' -- \
    eval mesh rec.obj truth.obj --transform down.txt
  refused "a scaling transform" 3 'no rotation' -- \
    eval mesh rec.obj truth.obj --align file --transform "$(printf '2 0 0 0\n0 2 0 0\n0 0 2 0\n' >double.txt && echo double.txt)"
  refused "culling from nowhere" 2 'requires --recording' -- eval mesh rec.obj truth.obj --cull depth
  refused "a recording without culling" 2 '--cull frustum' -- eval mesh rec.obj truth.obj --recording x
  refused "no samples" 2 'samples 0' -- eval mesh rec.obj truth.obj --samples 0
  refused "a threshold of none" 2 'thresholds: 0 .allowed: above 0' -- eval mesh rec.obj truth.obj --thresholds 0
  fresh_copy
  refused "a truth that nobody saw" 3 'observed' 'hint:one frame' -- \
    eval mesh rec.obj truth.obj --cull depth --recording freiburg1_copy --cull-every 1
}

check_imports() {
  fresh_copy
  local truth=freiburg1_copy/groundtruth.txt stamps=freiburg1_copy/rgb.txt
  # The truth at the images' stamps as another system's answer; every pose but that of the third image.
  awk -v rgb="$stamps" '
    BEGIN { while ((getline line < rgb) > 0) if (line !~ /^#/) { split(line, f, " "); t[n++] = f[1] } }
    /^#/ { next }
    { for (i = 0; i < n; i++) { d = $1 - t[i]; if (d < 0) d = -d; if (!(i in best) || d < best[i]) { best[i] = d; row[i] = $0 } } }
    END { for (i = 0; i < n; i++) if (i != 2) print row[i] }' "$truth" >other.txt
  corner_obj 1 0 >other.obj

  checks=$((checks + 1))
  "$binary" import Other other.txt other.obj --recording freiburg1_copy --imu none --out runs >stdout 2>stderr ||
    complain "an import: exit code $?"
  local run
  run=$(cat stdout)
  for name in record.json trajectory.tum truth.tum mesh.ply log.txt; do
    [[ -s $run/$name ]] || complain "an import does not write $name"
  done
  grep -q '4/5 frames' stderr || complain "an import does not tell its frames"
  prints '\| freiburg1_copy +\| recorded +\| none +\| Other +\| ok +\| +- \| +- \| +- \|' "an import in the table" table runs
  checks=$((checks + 1))
  "$binary" report runs --out report.html >stdout 2>stderr || complain "a report of an import: exit code $?"
  grep -q warning stderr && complain "a report of an import warns"

  # The same files again are the same run; corrected ones are no second row of the same name.
  checks=$((checks + 1))
  "$binary" import Other other.txt other.obj --recording freiburg1_copy --imu none --out runs >stdout 2>stderr ||
    complain "an import again: exit code $?"
  [[ $(<stdout) == "$run" ]] || complain "an import again is another run"
  sed 1d other.txt >corrected.txt
  refused "a corrected import" 2 "Other of 'freiburg1_copy' is imported already with other files: $run" 'hint:remove .*Other-2' -- \
    import Other corrected.txt other.obj --recording freiburg1_copy --imu none --out runs
  checks=$((checks + 1))
  "$binary" import Other corrected.txt other.obj --recording freiburg1_copy --imu none --frames 1:5 --out runs >stdout 2>stderr ||
    complain "an import of other frames: exit code $?"

  refused "a variant of ours" 2 'is a variant of this program' 'hint:name of its own' -- \
    import full other.txt --recording freiburg1_copy --out out
  refused "no name of a folder" 2 'no name of a system' -- import a/b other.txt --recording freiburg1_copy --out out
  curve 1000 1 >other_clock.txt
  refused "another clock" 3 'belongs to one of 5 frames' 'hint:colour images' -- \
    import Other other_clock.txt --recording freiburg1_copy --out out
  refused "poses without stamps" 3 '2 poses without stamps for 5 frames' -- \
    import Other "$(printf '1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n' >two.txt && echo two.txt)" \
    --recording freiburg1_copy --out out
  refused "no such mesh" 3 'absent.ply' -- import Other other.txt absent.ply --recording freiburg1_copy --out out
}

check_exports() {
  fresh_copy
  local format place
  mkdir exported
  for format in tum infinitam klg sens open3d euroc; do
    checks=$((checks + 1))
    place=exported/freiburg1_room.$format
    "$binary" export freiburg1_copy --format "$format" --out "$place" --frames 1:3 >stdout 2>stderr ||
      complain "export --format $format: exit code $?"
    [[ -e $place ]] || complain "export --format $format writes nothing"
    grep -qx "$place" stdout || complain "export --format $format does not say where"
    grep -qx "  $format: 2 frames of 640x480 pixels from 'freiburg1_copy'" stdout ||
      complain "export --format $format does not say what"
    grep -q 'lost beyond that range: 0 of ' stdout || complain "export --format $format does not say what was lost"
  done
  refused "an export to .sens without the ending" 2 'out: .*\.sens' 'hint:--out out.sens' -- export freiburg1_copy --format sens --out out
  [[ $(<exported/freiburg1_room.calibration.txt) == '517.306408 516.469215 318.64304 255.313989' ]] ||
    complain "another calibration beside .klg"
  [[ -z $(find exported -name '.*' ! -name .) ]] || complain "an export leaves hidden files"

  # What was exported is a recording again, and its export is the same to the byte, but for the last digit of quaternions,
  # which are normalised again.
  checks=$((checks + 1))
  "$binary" export exported/freiburg1_room.tum --format tum --out exported/again --json >stdout 2>stderr ||
    complain "export of an export: exit code $?"
  grep -q '"frames": 2' stdout || complain "--json does not tell the frames"
  diff -r -x groundtruth.txt exported/freiburg1_room.tum exported/again >stderr || complain "the export of an export differs"

  # Whatever was exported as a recording opens, and `convert` writes the folder that `export --format tum` does.
  for place in exported/freiburg1_room.sens exported/freiburg1_room.euroc exported/freiburg1_room.open3d; do
    checks=$((checks + 1))
    "$binary" convert "$place" --out "exported/converted_${place##*.}" >stdout 2>stderr || complain "convert $place: exit code $?"
    grep -q "^  2 frames of 640x480 pixels from 'freiburg1_room" stdout || complain "convert $place does not say what"
  done
  checks=$((checks + 1))
  "$binary" convert exported/freiburg1_room.tum --out exported/converted >stdout 2>stderr || complain "convert: exit code $?"
  diff -r exported/again exported/converted >stderr || complain "convert writes another folder than export --format tum"
  grep -q '^  next: fusebench inspect exported/converted$' stdout || complain "convert does not say what is next"
  mkdir nothing
  refused "nothing that is known" 3 'nothing: not a recording of a supported format; supported are eth3d ' 'hint:docs/own-camera.md' -- \
    convert nothing --out out
  refused "a file of no known format" 3 'stdout: not a recording of a supported format' -- convert stdout --out out
  mkdir ros2 && : >ros2/room_0.mcap
  refused "a bag of ROS 2" 2 'ros2: bags of ROS 2 ' 'hint:rosbags-convert' -- convert ros2 --out out

  refused "no such format" 2 'format = euroq' 'hint:euroc' -- export freiburg1_copy --format euroq --out out
  refused "a place that is taken" 2 'exported: exists already' 'hint:--out' -- \
    export freiburg1_copy --format tum --out exported
  refused "a place that is taken, of convert" 2 'exported: exists already, and nothing is replaced' 'hint:--out' -- \
    convert freiburg1_copy --out exported
  refused "no such frames" 2 'frames = 4:9' -- export freiburg1_copy --format tum --frames 4:9 --out out
  refused "no such recording to export" 3 'nowhere' -- export nowhere --format tum --out out
  truncate -s 60000 freiburg1_copy/rgb/1305031229.628753.png
  for format in tum klg; do
    refused "a truncated image in an export" 3 'rgb/1305031229.628753.png' -- \
      export freiburg1_copy --format "$format" --out out
  done
}

case "$group" in
  bad-data) check_bad_data ;;
  bad-usage) check_bad_usage ;;
  evaluation) check_evaluation ;;
  evo) check_evo ;;
  meshes) check_meshes ;;
  imports) check_imports ;;
  exports) check_exports ;;
  recordings) check_recordings ;;
  interrupt) check_interrupt ;;
  determinism) check_determinism ;;
  profile) check_profile ;;
  *) usage >&2; exit 2 ;;
esac
if ((failures > 0 || checks == 0)); then
  printf '%s: %d failures in %d checks\n' "$group" "$failures" "$checks" >&2
  exit 1
fi
printf '%s: %d checks passed\n' "$group" "$checks"
