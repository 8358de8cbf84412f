#include "core/places/appearance.hpp"

#include "core/ferns/color_fern_code.hpp"

namespace fusebench::places {

Appearance appearance_of(const RgbdFrame& frame, const PinholeCamera& camera, const config::Config& config) {
  return {ferns::color_fern_code(frame.color, frame.depth_m),
          coarse_landmarks_of(frame.grey, frame.depth_m, camera, config.loops.max_features, config),
          small_images_of(frame.grey, frame.depth_m)};
}

}  // namespace fusebench::places
