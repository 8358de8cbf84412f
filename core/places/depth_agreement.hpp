// Two places against each other at a pose: what the depth and the intensities of one say about the other.
#pragma once

#include <optional>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/places/small_images.hpp"

namespace fusebench::places {

/// Of the pixels with depth of one place, seen from another one.
struct DepthAgreement {
  double overlap = 0;     ///< share that falls on depth of the other
  double consistent = 0;  ///< share that lies on the surface which the other sees there
  double violating = 0;   ///< of those that overlap, the share that lies where the other saw free space
};

/// On the surface: within LoopsConfig::depth_sigmas of the depth noise, and 1 cm more.
[[nodiscard]] DepthAgreement depth_agreement(const SmallImages& from, const SmallImages& to,
                                             const SE3& T_to_from, const PinholeCamera& camera,
                                             const config::DepthConfig& depth,
                                             const config::LoopsConfig& loops);

/// How well intensities correlate (ZNCC) where the depth of `from` lies on the surface of `to`; nothing if
/// one of them has less contrast there than `min_contrast_grey`.
[[nodiscard]] std::optional<double> grey_correlation(const SmallImages& from, const SmallImages& to,
                                                     const SE3& T_to_from, const PinholeCamera& camera,
                                                     const config::DepthConfig& depth,
                                                     const config::LoopsConfig& loops,
                                                     double min_contrast_grey);

}  // namespace fusebench::places
