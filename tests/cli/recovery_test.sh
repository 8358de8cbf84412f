#!/usr/bin/env bash
# Recovery of `no-imu` on a real recording with damaged stretches: it has a pose for nearly every good frame, and no wrong one.
set -uo pipefail

if (($# != 1)); then
  printf 'Usage: tests/cli/recovery_test.sh BINARY\n' >&2
  exit 2
fi
binary=$1
recording=${FUSEBENCH_DATA:-}/rgbd_dataset_freiburg1_xyz_first150
if [[ ! -d $recording ]]; then
  printf 'skipped: FUSEBENCH_DATA has no rgbd_dataset_freiburg1_xyz_first150\n'
  exit 77
fi
damage=$(cd "$(dirname "${BASH_SOURCE[0]}")/../support" && pwd)/damage_recording.py
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

# expect KIND LEAST [FRAME:COUNT]: at least so many frames with a pose, an ATE of at most 1 cm, no more than 2 silent failures.
expect() {
  local kind=$1 least=$2 folder
  shift 2
  python3 "$damage" "$kind" "$recording" "rgbd_dataset_freiburg1_xyz_$kind" "$@" || exit 1
  folder=$("$binary" run "rgbd_dataset_freiburg1_xyz_$kind" --variant no-imu --threads 2 --out runs 2>log) || cat log >&2
  if ! python3 - "$folder/record.json" "$least" <<'PYTHON'; then
import json, sys
record = json.load(open(sys.argv[1]))
frames = record["frames"]
# Frames of segments have poses in the map once all segments are joined.
joined = frames.get("other_segments", 0) if frames.get("segments") == frames.get("segments_joined") else 0
tracked, ate_m = frames["tracked"] + joined, record["metrics"]["ate"]["stats"]["rmse"]
silent = record["metrics"]["silent_failures"]["silent"]
print(f"{tracked} of {frames['total']} frames, ATE {ate_m:.4f} m, {silent} silent failures")
sys.exit(0 if tracked >= int(sys.argv[2]) and ate_m <= 0.01 and silent <= 2 else 1)
PYTHON
    printf 'FAILED: %s, expected at least %d frames\n' "$kind" "$least" >&2
    failures=1
  fi
}

# 144 frames, of which 30 are damaged.
expect covered 111 60:30
expect colour 125 60:30
expect depth 141 60:30
expect gap 70
exit "$failures"
