// Depth registered to a colour camera with distortion.
#pragma once

#include <cstdint>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::simulator::sensors {

/// Maps depth of the ideal pinhole camera to the pixels of the distorted image. Each pixel takes the nearest
/// measurement, since interpolation would create false surfaces; the lateral error is up to half a pixel. 0
/// without a measurement.
class DepthDistortion {
 public:
  DepthDistortion(const calibration::CalibratedCamera& camera, const Workers& workers);

  /// The image must have the size of camera.pinhole (checked).
  [[nodiscard]] Image<std::uint16_t> distorted(const Image<std::uint16_t>& ideal) const;

 private:
  Image<std::int32_t> source_;  ///< index of the ideal pixel, -1: outside of the image
};

}  // namespace fusebench::simulator::sensors
