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
for variant in full dm no-imu; do
  profile=()
  if [[ $variant == no-imu ]]; then profile=(--profile); fi
  "$binary" run recording --variant "$variant" --out runs "${profile[@]}" >/dev/null 2>&1 || failed "the run $variant fails"
done
# A run that failed before its first frame has a record and nothing else.
lost=runs/recording/planar/00000000
mkdir -p "$lost"
sed -e 's/"status": "ok"/"status": "failed"/' -e 's/"reason": ""/"reason": "<b>no \& such<\/b> thing"/' \
  -e 's/"variant": "full"/"variant": "planar"/' runs/recording/full/*/record.json >"$lost/record.json"

"$binary" report runs --out report.html 2>stderr || failed "no report: $(cat stderr)"
(($(stat -c %s report.html) < 15000000)) || failed "the report is larger than 15 MB"
# Pictures are letters too, among which there may be any three by chance.
grep -q 'NaN\|>nan<\|>inf<' <(sed -e '/<script/,/<\/script>/d' -e 's/data:image[^"]*"/"/g' report.html) && failed "the report shows what is no number"
grep -q '&lt;b&gt;no &amp; such' report.html || failed "a reason is not escaped"
for part in 'Trajectories' 'Errors' 'Motion and intensity' 'Patches' 'Models' 'Health and time' 'Profiles' 'Configuration'; do
  grep -q "<h3[^>]*>$part" report.html || failed "the report has no part '$part'"
done
if command -v gnuplot >/dev/null; then
  for format in svg pdf; do
    "$binary" report runs --out again.html --figures figures --figure-format "$format" 2>stderr ||
      failed "no figures: $(cat stderr)"
    for figure in x_y_view position_error relative_error_over_segments_of_the_path time_of_the_stages average_intensity_error \
      time_of_the_stages_over_the_frames_no_imu; do
      [[ -s figures/recording-$figure.$format ]] || failed "no figure $figure.$format"
    done
  done
  cmp report.html again.html || failed "the report is not the same twice"
fi
exec /usr/bin/python3 "$here/page_test.py" report.html "${screenshots[@]}"
