#include "core/estimator/places/appearance.hpp"

#include "core/config/groups/loops_config.hpp"
#include "core/estimator/places/ferns/color_fern_code.hpp"

namespace fusebench::places {

Appearance appearance_of(const RgbdFrame& frame, const PinholeCamera& camera,
                         const config::LoopsConfig& loops, const config::PlaceFeaturesConfig& features,
                         const config::RelocalisationConfig& relocalisation) {
  return {
      ferns::color_fern_code(frame.color, frame.depth_m),
      coarse_landmarks_of(frame.grey, frame.depth_m, camera, loops.max_features, features, relocalisation),
      small_images_of(frame.grey, frame.depth_m)};
}

}  // namespace fusebench::places
