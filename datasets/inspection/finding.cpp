#include "datasets/inspection/finding.hpp"

#include <array>

namespace fusebench::inspection {

std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::error:
      return "error";
    case Severity::warning:
      return "warning";
    case Severity::note:
      return "note";
  }
  return "unknown";
}

namespace {

constexpr auto kCodes = std::to_array<FindingCode>({
    // Reading
    {"cannot-open", "the recording's reader refused it"},
    {"frame-unreadable", "a sampled frame could not be loaded"},
    {"reader-warning", "the reader's own warning, such as images without a partner"},
    {"reader-note", "changes that the reader made to the data"},
    // Stamps of the images
    {"frames-time-unit", "the spacing of the frames is not that of seconds"},
    {"frames-duplicate-stamp", "two frames have one stamp"},
    {"frames-out-of-order", "a frame is earlier than the one before it"},
    {"frames-incomplete", "the recording has another number of frames than is published"},
    {"frames-gap", "the images pause"},
    {"frames-dropped", "single frames are missing"},
    {"frames-duplicate-image", "a frame's colour image is the one before it again"},
    {"depth-reused", "one depth image belongs to two frames"},
    {"depth-frozen", "a frame's depth image is the one before it again"},
    {"association-loose", "colour and depth images of a frame are taken far apart in time"},
    // Images
    {"underexposed", "the images are dark"},
    {"overexposed", "much of the images is saturated"},
    {"brightness-drift", "the mean brightness changes over the recording"},
    {"color-mirrored", "colour is mirrored or upside down against depth"},
    {"motion-fast", "the paper's class of the motion: fast"},
    {"motion-slow", "the paper's class of the motion: slow"},
    // Depth
    {"depth-empty", "there are frames without any depth"},
    {"depth-holes", "much of the depth images is without measurement"},
    {"depth-range",
     "depth is measured where no RGB-D sensor for rooms measures: the scale is probably wrong"},
    {"depth-scale", "the ground truth contradicts the scale of depth"},
    {"depth-along-ray", "depth is the distance along the ray of a pixel, not its z component"},
    {"depth-time-offset", "depth images were taken at times that differ from their stamps and delay"},
    {"depth-misregistered", "edges of depth and colour do not coincide"},
    // Ground truth
    {"truth-none", "there is no ground truth"},
    {"truth-coverage", "frames have no ground truth around them"},
    {"truth-time-unit", "the spacing of the ground truth is not that of seconds"},
    {"truth-out-of-order", "poses of the ground truth do not increase in time"},
    {"truth-gap", "the ground truth pauses"},
    {"truth-jump", "the ground truth jumps"},
    {"truth-time-offset", "the clock of the ground truth is not that of the images, or its rows are shifted"},
    {"truth-not-reflected", "poses of a y-up camera are used with a y-down one, or fy is negative"},
    {"truth-inverted", "the poses map from the world to the camera"},
    {"truth-rotation-inverted", "the rotations are inverted, the positions are not"},
    {"truth-quaternion-order", "quaternions were read in the wrong order"},
    {"truth-camera-axes", "the poses are those of a camera with other axes than right, down, forward"},
    {"truth-position-axes", "the positions have other axes than the rotations, such as left-handed ones"},
    {"truth-constant", "the ground truth stands still while the images move"},
    {"truth-inconsistent", "the ground truth explains the images no better than no motion at all"},
    {"focal-length", "the ground truth contradicts the focal length"},
    {"image-size", "the intrinsics are those of images of another size"},
    {"reprojection-untested", "no pair of frames could test the calibration"},
    // IMU
    {"imu-none", "there is no IMU"},
    {"imu-time-unit", "the spacing of the IMU's samples is not that of seconds"},
    {"imu-duplicate-stamp", "two samples of the IMU have one stamp"},
    {"imu-out-of-order", "samples of the IMU do not increase in time"},
    {"imu-gap", "the IMU pauses"},
    {"imu-rate-low", "the IMU is too slow to integrate"},
    {"imu-coverage", "frames have no IMU samples around them"},
    {"imu-stuck", "the IMU repeats one value"},
    {"imu-spike",
     "samples of the IMU jump away from their neighbours and back, or are beyond what a sensor measures"},
    {"gyroscope-saturated", "the gyroscope reached the end of its range"},
    {"gyroscope-unit", "angular velocities are in degrees or another unit"},
    {"gyroscope-axes", "the gyroscope's axes are exchanged or mirrored, the accelerometer's are not"},
    {"gyroscope-scale", "the gyroscope turns further, or less, than the camera"},
    {"gyroscope-bias", "the gyroscope has a large bias"},
    {"accelerometer-saturated", "the accelerometer reached the end of its range"},
    {"accelerometer-unit", "specific forces are in units of gravity or another unit"},
    {"accelerometer-axes", "the accelerometer's axes are exchanged or mirrored, the gyroscope's are not"},
    {"accelerometer-without-gravity", "gravity has been taken out of the accelerometer's values"},
    {"accelerometer-sign", "the accelerometer's values have the wrong sign"},
    {"accelerometer-bias", "the accelerometer has a large bias"},
    {"gravity-magnitude", "gravity, as measured, has an implausible magnitude"},
    {"imu-time-offset", "the clocks of the IMU and the images differ"},
    {"imu-axes-swapped", "the IMU's axes are exchanged, mirrored or turned far against its calibration"},
    {"extrinsic-rotated", "the rotation between IMU and camera is not that of the calibration"},
    {"imu-unrelated", "the IMU does not turn as the camera does"},
    {"imu-alignment-untested", "the motion does not suffice to compare IMU and camera"},
});

}  // namespace

std::span<const FindingCode> finding_codes() { return kCodes; }

}  // namespace fusebench::inspection
