// Errors of depth sensors that their noise models lack: what stays the same from image to image, and where a
// pattern of light does not come back.
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
  double scale = 0;         ///< measured depth over true depth, minus 1
  double smooth_px = 0;     ///< standard deviation of an error of disparity that varies over the image
  double pattern_px = 0;    ///< the same, of each pixel on its own
  bool border = false;      ///< no depth at the borders, as of depth that is registered to colour
  bool lost_light = false;  ///< no depth where the projector's light does not come back: at grazing angles,
                            ///< on dark surfaces, on glossy ones

  [[nodiscard]] bool any() const {
    return scale != 0 || smooth_px > 0 || pattern_px > 0 || border || lost_light;
  }
};

/// What the sensor sees instead of the surfaces: depth with the fixed errors, 0 where light is lost.
/// sensor_key: of the device, the same for all of its images; frame_key: of the image. The disparity is that
/// of a baseline of 0.075 m, in pixels of the sensor (native_pixels.hpp). Surfaces need their material where
/// lost_light is on.
void apply_depth_errors(const DepthErrors& errors, const NativePixels& native, std::uint64_t sensor_key,
                        std::uint64_t frame_key, const Workers& workers,
                        Image<render::Renderer::Surface>& surfaces);

}  // namespace fusebench::simulator::sensors
