#!/bin/sh
# The original InfiniTAM over an export of the format infinitam: infinitam_poses.sh EXPORT OUTPUT. Needs InfiniTAM_cli in PATH,
# built with OUTPUT_TRAJECTORY_QUATERNIONS; writes OUTPUT/trajectory.tum with the stamps of the frames.
set -eu
export_folder=$1
output=$2
cd "$export_folder"
InfiniTAM_cli calib.txt 'color/%04i.ppm' 'depth/%04i.pgm' >"$output/printed.txt" 2>"$output/poses.txt" </dev/null
# A pose a frame, in order; frame_times.txt has "number stamp" a frame.
grep -E '^ *-?[0-9.]+( -?[0-9.]+){6} *$' "$output/poses.txt" >"$output/only_poses.txt"
awk 'NR == FNR { if ($1 !~ /^#/) stamp[n++] = $2; next } { print stamp[i++], $0 }' frame_times.txt "$output/only_poses.txt" \
  >"$output/trajectory.tum"
