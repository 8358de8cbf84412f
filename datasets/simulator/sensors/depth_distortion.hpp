// Depth that is registered to a colour camera with distortion.
#pragma once

#include <cstdint>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::simulator::sensors {

/// Puts depth of the ideal pinhole camera onto the pixels of the distorted image: each takes the nearest
/// measurement, since interpolation would invent surfaces, so values are off by up to half a pixel sideways.
/// 0 where there is none.
class DepthDistortion {
 public:
  DepthDistortion(const calibration::CalibratedCamera& camera, const Workers& workers);

  /// The image has the size of camera.pinhole (checked).
  [[nodiscard]] Image<std::uint16_t> distorted(const Image<std::uint16_t>& ideal) const;

 private:
  Image<std::int32_t> source_;  ///< index of the ideal pixel, -1: outside of the image
};

}  // namespace fusebench::simulator::sensors
