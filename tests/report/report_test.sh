#!/usr/bin/env bash
# The report of a small simulated suite: made, and read in headless Chromium. Exit code 77: no browser to read it with.
set -uo pipefail

usage() {
  cat <<'TEXT'
Usage: tests/report/report_test.sh BINARY [SCREENSHOT_FOLDER]
TEXT
}

if (($# < 1 || $# > 2)); then
  usage >&2
  exit 2
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
binary=$(realpath -- "$1")
screenshots=()
if (($# == 2)); then screenshots=("$(realpath -m -- "$2")"); fi
unset FUSEBENCH_DATA

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2

failed() {
  printf 'FAILED: %s\n' "$1" >&2
  exit 1
}

"$binary" simulate --preset fast --in-motion --duration 0.7 --size 320x240 --out recording >/dev/null 2>&1 ||
  failed "the recording is not made"
for variant in full dm no-imu infinitam; do
  options=()
  if [[ $variant == no-imu ]]; then options=(--profile); fi
  # The camera has no time to return anywhere: loops are taken that depth would refuse.
  if [[ $variant == full ]]; then
    for option in mode=final least_age_s=0.5 query_every=2 max_violating_share=1 max_features=800; do options+=(--set "loops.$option"); done
  fi
  "$binary" run recording --variant "$variant" --out runs "${options[@]}" >/dev/null 2>&1 || failed "the run $variant fails"
done
grep -q accepted runs/recording/full/*/loops.csv || failed "there is no loop to draw"
# A run that failed before its first frame has a record and nothing else.
lost=runs/recording/planar/00000000
mkdir -p "$lost"
sed -e 's/"status": "ok"/"status": "failed"/' -e 's/"reason": ""/"reason": "<b>no \& such<\/b> thing"/' \
  -e 's/"variant": "full"/"variant": "planar"/' runs/recording/full/*/record.json >"$lost/record.json"

# From where the recording is not, since it is looked for by its name.
mkdir elsewhere
report_from_elsewhere() { (cd elsewhere && "$binary" report ../runs "$@") 2>stderr; }
figures_as() { if command -v gnuplot >/dev/null; then figures=(--figures "$1" --figure-format "$2"); else figures=(); fi; }
report_from_elsewhere --out ../report.html || failed "no report: $(cat stderr)"
cp stderr stderr.report
(($(stat -c %s report.html) < 15000000)) || failed "the report is larger than 15 MB"
# Pictures are letters too, among which there may be any three by chance.
grep -q 'NaN\|>nan<\|>inf<' <(sed -e '/<script/,/<\/script>/d' -e 's/data:image[^"]*"/"/g' report.html) && failed "the report shows what is no number"
grep -q '&lt;b&gt;no &amp; such' report.html || failed "a reason is not escaped"
for part in 'Trajectories' 'Errors' 'Motion and intensity' 'Patches' 'Models' 'Health and time' 'Profiles' 'Configuration'; do
  grep -q "<h3[^>]*>$part" report.html || failed "the report has no part '$part'"
done
grep -q '<h2[^>]*>What was found' report.html || failed "the report does not say what was found"
grep -q '<p>[^<]* ATE on one simulated recording: [^<]*no evidence' report.html || failed "the report does not say that one recording is no evidence"
grep -q '<p>1 of 5 runs did not end well: planar' report.html || failed "the report does not say what failed"
grep -q '<td class="best">' report.html || failed "no best value is marked"
grep -q 'No images of the recording (' report.html ||
  failed "the report does not say that the recording is not there"
grep -q 'data FOLDER' report.html || failed "the report does not say how images are shown"
grep -q 'warning: .*no images of the recording.*--data FOLDER' stderr.report || failed "the terminal does not say how images are shown: $(cat stderr.report)"
for part in 'Loops and final poses' 'Trajectories with loops' 'Loops over time' 'How to read the table of systems'; do
  grep -q "<h3[^>]*>$part" report.html || failed "the report has no part '$part'"
done
# Where the recording is: its first frame, the worst one of runs, and some in between.
"$binary" report runs --data . --out with_images.html 2>stderr || failed "no report with images: $(cat stderr)"
grep -q '<figcaption>largest error of full' with_images.html || failed "the worst frame is not shown"
(($(grep -c '<figure data-time=' with_images.html) > 10)) || failed "there are no images over time"
# Runs may lie in a folder that is called as engines call that of simulated recordings.
mkdir -p simulated/recording
cp -r runs/recording/no-imu simulated/recording
"$binary" report simulated --data . --out of_simulated.html 2>stderr || failed "no report of runs in a folder called simulated: $(cat stderr)"
if grep -q 'no images of the recording' stderr; then failed "runs are taken for recordings: $(cat stderr)"; fi
rm -r simulated
(($(stat -c %s with_images.html) < $(stat -c %s report.html) + 400000)) || failed "images take more than 400 kB"
# A camera that only the command line said is in the record, and the report reads images with it.
"$binary" simulate --preset fast --in-motion --duration 0.2 --size 160x120 --format tum --out uncalibrated >/dev/null 2>&1 ||
  failed "the recording without a calibration is not made"
rm uncalibrated/calibration.toml
"$binary" run uncalibrated --camera 131.25,131,79.5,59.5 --depth-units 5001 --variant no-imu --out camera_runs >/dev/null 2>&1
grep -q '"units_per_metre": 5001' camera_runs/uncalibrated/no-imu/*/record.json || failed "the record does not have the depth units"
figures_as camera_figures pdf
"$binary" report camera_runs --data . --out camera.html "${figures[@]}" 2>stderr || failed "no report of a run with a given camera: $(cat stderr)"
grep -q '<figure data-time=' camera.html || failed "images are not read with the camera of the record: $(cat stderr)"
# Its rows are those that `table` prints, online and final apart.
"$binary" table runs --systems | grep '^|' | tail -n +3 |
  sed -E 's/^\| */<td>/; s/ *\|$/<\/td>/; s/ *\| */<\/td><td>/g' >systems_rows
grep -q '<td>full</td><td>final</td>' systems_rows || failed "no row of final poses: $(cat systems_rows)"
grep -q '<td>infinitam</td><td>online</td>' systems_rows || failed "no row of another system: $(cat systems_rows)"
sed 's/<td class="best">/<td>/g' report.html >plain.html
while IFS= read -r row; do
  grep -qF -- "$row" plain.html || failed "the report does not have the row of systems $row"
done <systems_rows
figures_as ../figures svg
report_from_elsewhere --out ../again.html "${figures[@]}" || failed "no figures: $(cat stderr)"
cmp report.html <(sed 's/<a href="again-/<a href="report-/g' again.html) || failed "the report is not the same twice"
for variant in full dm no-imu infinitam; do
  picture=$(compgen -G "report-recording_${variant//-/_}*.png") || failed "no picture of the model of $variant: $(ls)"
  [[ $(head -c 4 "$picture") == $'\x89PNG' ]] || failed "no PNG: $picture"
  (($(grep -c "<a href=\"$picture\">" report.html) >= 2)) || failed "the tables do not lead to $picture"
  cmp "$picture" "again${picture#report}" || failed "the picture of $variant is not the same twice"
done
if command -v gnuplot >/dev/null; then
  for figure in x_y_view position_error relative_error_over_segments_of_the_path time_of_the_stages average_intensity_error \
    time_of_the_stages_over_the_frames_no_imu x_z_view_with_loops_full candidates_for_loops_full \
    position_error_before_and_after_full; do
    # A run with edited options has them in its name.
    compgen -G "figures/recording-$figure*.svg" >/dev/null || failed "no figure $figure: $(ls figures)"
  done
  [[ $(head -c 4 camera_figures/*-position_error.pdf) == %PDF ]] || failed "no figure as PDF: $(ls camera_figures)"
fi
exec /usr/bin/python3 -B "$here/page_test.py" with_images.html "${screenshots[@]}"
