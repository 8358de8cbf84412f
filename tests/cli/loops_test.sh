#!/usr/bin/env bash
# Loops as a user meets them: what each mode writes, and that the number of threads does not show.
set -uo pipefail

if (($# != 1)); then
  printf 'Usage: tests/cli/loops_test.sh BINARY\n' >&2
  exit 2
fi
binary=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
checks=0
failures=0

check() {
  local what=$1
  shift
  checks=$((checks + 1))
  if ! "$@" >check_output 2>&1; then
    failures=$((failures + 1))
    printf 'FAILED: %s\n' "$what" >&2
    sed 's/^/    /' check_output >&2
  fi
}

# run MODE THREADS [OPTION...]: its folder on standard output.
run() {
  local mode=$1 threads=$2
  shift 2
  "$binary" run room --imu auto --set "loops.mode=$mode" --set loops.least_age_s=1 --threads "$threads" --out "runs_${mode}_$threads" "$@" 2>"${mode}_$threads.log"
}

"$binary" simulate --format tum --preset slow --duration 3 --seed 3 --size 320x240 --blur-samples 1 --out room >/dev/null 2>&1 || exit 1
off=$(run off 2)
detect=$(run detect 2)
one=$(run final 1)
two=$(run final 2)
# Without drift nothing would be corrected: every loop is taken to contradict the poses.
eager=(--set loops.online_every=20 --set loops.online_translation_m=0 --set loops.online_rotation_deg=0 --set loops.max_chi2=1)
online_one=$(run online 1 "${eager[@]}")
online_two=$(run online 2 "${eager[@]}")
if [[ -z $off || -z $detect || -z $one || -z $two || -z $online_one || -z $online_two ]]; then
  cat ./*.log >&2
  exit 1
fi

check 'off writes no loops' test ! -e "$off/loops.csv"
check 'off has no final poses' test ! -e "$off/final.tum"
check 'the log counts loops' grep -qE '^loops: [0-9]+ places, [0-9]+ candidates, [1-9][0-9]* accepted' "$detect/log.txt"
"$binary" run room --variant opencv-rgbd --set loops.mode=online --out runs_opencv >/dev/null 2>opencv.log
check 'a system without loops.mode says so' grep -qE 'warning: without effect: loops.mode .*opencv_odometry' opencv.log
check 'and nothing is said where it has an effect' sh -c '! grep -q "without effect" final_1.log'
check 'detect changes no pose' cmp "$off/trajectory.tum" "$detect/trajectory.tum"
check 'detect changes no model' cmp "$off/mesh.ply" "$detect/mesh.ply"
check 'detect has no final poses' test ! -e "$detect/final.tum"
check 'detect lists its places' grep -qE '^[0-9.]+,[0-9.]+,[0-9]+,[1-9]' "$detect/places.csv"
check 'detect says what its loops are worth' grep -q '"oracle_ate_m"' "$detect/record.json"
check 'detect says what it found' grep -q ',accepted,' "$detect/loops.csv"
check 'final changes no pose online' cmp "$off/trajectory.tum" "$one/trajectory.tum"
# Without the decision, which the optimisation can revise.
candidates() { cut -d, -f1-18 "$1/loops.csv"; }
check 'final finds the candidates of detect' test "$(candidates "$detect")" = "$(candidates "$one")"
check 'as many final poses as online ones' test "$(wc -l <"$one/final.tum")" = "$(wc -l <"$one/trajectory.tum")"
check 'the record has metrics of both' grep -q '"final_metrics"' "$one/record.json"
check 'the summary says both' grep -q 'ATE .* (final .* cm)' final_1.log
for file in trajectory.tum final.tum loops.csv places.csv mesh.ply; do
  check "$file does not depend on threads" cmp "$one/$file" "$two/$file"
done
check 'online corrects on the way' grep -q 'a loop corrected the poses: .* frames fused again' "$online_one/log.txt"
check 'online changes later poses' bash -c "! cmp -s '$off/trajectory.tum' '$online_one/trajectory.tum'"
for file in trajectory.tum final.tum loops.csv mesh.ply; do
  check "$file of online does not depend on threads" cmp "$online_one/$file" "$online_two/$file"
done
"$binary" table runs_final_1 --systems >table 2>&1
check 'the table has a row for the poses of the end' grep -qE 'full.*final' table

printf '%d checks, %d failures\n' "$checks" "$failures"
((failures == 0))
