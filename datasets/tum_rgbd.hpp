// TUM RGB-D recordings (Sturm et al., A benchmark for the evaluation of RGB-D SLAM systems, IROS 2012).
#pragma once

#include <filesystem>
#include <optional>

#include "core/error.hpp"
#include "datasets/camera_model.hpp"
#include "datasets/recording.hpp"

namespace fusebench {

struct TumOptions {
  std::optional<CalibratedCamera> camera;  ///< without it, the one that the folder's name tells
  double depth_factor = 5000;      ///< value of one metre in the depth images, which are already scaled
  double max_difference_s = 0.02;  ///< between a colour image and its depth image
  bool regular_stamps = true;      ///< remove the jitter of the stamps (see regular_stamps.hpp)
};

/// Opens a folder with rgb.txt, depth.txt and, if present, groundtruth.txt and accelerometer.txt. Checks all
/// lists, pairs colour with depth by TUM's rule, and reads every used image once for the fingerprint. Images
/// are undistorted when loaded. Errors: configuration (unknown camera, option out of range), data_missing,
/// data_corrupt.
[[nodiscard]] Result<Recording> open_tum_rgbd(const std::filesystem::path& folder, const TumOptions& options);

}  // namespace fusebench
