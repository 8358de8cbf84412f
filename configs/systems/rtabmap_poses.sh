#!/bin/sh
# RTAB-Map over an export of the format tum: rtabmap_poses.sh EXPORT CALIBRATION OUTPUT. Needs rtabmap-rgbd_dataset in PATH;
# writes OUTPUT/rtabmap_poses.txt.
set -eu
export_folder=$1
calibration=$2
output=$3
# The program takes the camera from the folder's name.
fx=$(awk '$1 == "Camera1.fx:" { printf "%.1f", $2 }' "$calibration")
case $fx in
  517.3) camera=freiburg1 ;;
  520.9) camera=freiburg2 ;;
  535.4) camera=freiburg3 ;;
  *)
    printf 'rtabmap-rgbd_dataset knows the cameras of freiburg1, 2 and 3 only, and not one of fx = %s\n' "$fx" >&2
    exit 2
    ;;
esac
mkdir "$output/$camera"
ln -s "$export_folder/rgb" "$output/$camera/rgb_sync"
ln -s "$export_folder/depth" "$output/$camera/depth_sync"
exec rtabmap-rgbd_dataset --quiet --output "$output" --Rtabmap/DetectionRate 0 --RGBD/LinearUpdate 0 --RGBD/AngularUpdate 0 \
  "$output/$camera"
