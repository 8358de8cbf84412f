// Consistency of the depth and intensities of two places at a relative pose.
#pragma once

#include <optional>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/small_images.hpp"

namespace fusebench::places {

/// Shares of the pixels with depth of one place, projected into another one.
struct DepthAgreement {
  double overlap = 0;     ///< share that projects to a pixel with depth
  double consistent = 0;  ///< share that is on the surface measured there
  double violating = 0;   ///< of the overlapping pixels, the share in measured free space
};

/// On the surface: within LoopsConfig::depth_sigmas of the depth noise plus 1 cm.
[[nodiscard]] DepthAgreement depth_agreement(const SmallImages& from, const SmallImages& to,
                                             const SE3& T_to_from, const PinholeCamera& camera,
                                             const config::DepthConfig& depth,
                                             const config::LoopsConfig& loops);

/// ZNCC of the intensities where the depth of `from` is on the surface of `to`; nothing if the contrast of
/// either is below `min_contrast_grey`.
[[nodiscard]] std::optional<double> grey_correlation(const SmallImages& from, const SmallImages& to,
                                                     const SE3& T_to_from, const PinholeCamera& camera,
                                                     const config::DepthConfig& depth,
                                                     const config::LoopsConfig& loops,
                                                     double min_contrast_grey);

}  // namespace fusebench::places
