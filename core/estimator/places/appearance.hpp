// Data for the recognition of a frame.
#pragma once

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/ferns/fern_code.hpp"
#include "core/estimator/places/landmarks.hpp"
#include "core/estimator/places/small_images.hpp"

namespace fusebench::places {

struct Appearance {
  ferns::FernCode code{};
  Landmarks landmarks;
  SmallImages small;
};

[[nodiscard]] Appearance appearance_of(const RgbdFrame& frame, const PinholeCamera& camera,
                                       const config::LoopsConfig& loops,
                                       const config::PlaceFeaturesConfig& features,
                                       const config::RelocalisationConfig& relocalisation);

}  // namespace fusebench::places
