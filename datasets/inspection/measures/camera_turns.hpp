// How the camera turns over short intervals: from ground truth, or measured in the images.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::inspection::measures {

/// The turn of the camera over [begin, end] as a rotation vector: R_begin_end = Exp(turn), in the camera's
/// axes.
struct CameraTurn {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  Vector3d turn_rad = Vector3d::Zero();
};

struct CameraTurns {
  std::string source;  ///< "ground truth", "images", or empty
  std::vector<CameraTurn> turns;
};

/// Between poses of the ground truth that are about 33 ms apart, within two seconds of the frames. Raw poses:
/// their own stamps are part of what is tested.
[[nodiscard]] CameraTurns turns_from_truth(const recording::Recording& recording);

/// Between neighbouring frames where the gyroscope turns most, `count` of them in up to six runs spread over
/// the recording: corners are followed by Lucas and Kanade's method, and the pose of their depths is found by
/// RANSAC (OpenCV). Needs an IMU (for the choice of frames).
[[nodiscard]] CameraTurns turns_from_images(const recording::Recording& recording, const Workers& workers,
                                            std::size_t count);

/// Median distance (px) that corners of an image move to the other one; nothing if fewer than 40 are
/// followed.
[[nodiscard]] std::optional<double> image_motion_px(const GreyImage& from, const GreyImage& to);

}  // namespace fusebench::inspection::measures
