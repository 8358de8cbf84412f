// Depth that is registered to a colour camera with distortion.
#pragma once

#include <cstdint>

#include "core/base/image.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::simulator::sensors {

/// Puts depth of the ideal pinhole camera onto the pixels of the distorted image: each takes the nearest
/// measurement, since interpolation would invent surfaces, so values are off by up to half a pixel sideways.
/// 0 where there is none. The image has the size of camera.pinhole (checked).
[[nodiscard]] Image<std::uint16_t> distort_depth(const Image<std::uint16_t>& ideal,
                                                 const calibration::CalibratedCamera& camera);

}  // namespace fusebench::simulator::sensors
