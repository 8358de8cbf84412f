// Errors of depth sensors beyond their noise models: errors that are constant over all images, and missing
// light.
#pragma once

#include <cstdint>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/simulator/sensors/native_pixels.hpp"

namespace fusebench::simulator::sensors {

/// All off by default. Disparity in pixels of the sensor (native_pixels.hpp).
struct DepthErrors {
  double scale = 0;         ///< measured depth / true depth - 1
  double smooth_px = 0;     ///< standard deviation of a smooth disparity error over the image
  double pattern_px = 0;    ///< standard deviation of an independent disparity error of each pixel
  bool border = false;      ///< no depth at the borders, as for depth registered to colour
  bool lost_light = false;  ///< no depth at grazing angles and on dark or glossy surfaces

  [[nodiscard]] bool any() const {
    return scale != 0 || smooth_px > 0 || pattern_px > 0 || border || lost_light;
  }
};

/// Applies the fixed errors to the measured surfaces; depth is 0 where light is lost. sensor_key: of the
/// device, equal for all its images; frame_key: of the image. Disparity is for a baseline of 0.075 m in
/// pixels of the sensor (native_pixels.hpp). With lost_light, surfaces need their material.
void apply_depth_errors(const DepthErrors& errors, const NativePixels& native, std::uint64_t sensor_key,
                        std::uint64_t frame_key, const Workers& workers,
                        Image<render::Renderer::Surface>& surfaces);

}  // namespace fusebench::simulator::sensors
