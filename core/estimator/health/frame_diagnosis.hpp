// Diagnosis of a frame from its images and the outcomes of its patches. Reports explain with it why a frame
// was lost or is poorly constrained. The paper does not treat failures.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"

namespace fusebench::health {

/// The first that applies, in this order.
enum class FrameHealth {
  dark,              ///< (nearly) no light: the camera is covered or switched off
  occluded,          ///< a new object covers more than health.covered_share of the patches
  short_of_depth,    ///< most of the image has no usable depth
  short_of_texture,  ///< nearly no gradients to track
  inconsistent,      ///< most patches contradict the pose
  short_of_patches,  ///< too few patches in view, for another reason
  blurred,           ///< predicted blur is longer than a patch
  diverged,          ///< no image update: the state is not finite (state_validity.hpp)
  repeated,          ///< colour, depth or both repeat the previous frame
  revisit_pending,   ///< old surfaces do not fit; they are not fused over until a loop is accepted
  good,
};
[[nodiscard]] std::string_view to_string(FrameHealth health);

/// True unless the images lack light, depth or texture, or were not used: the next frame could be tracked
/// from them.
[[nodiscard]] bool is_sound(FrameHealth health);

/// Share of the pixels with a depth.
[[nodiscard]] double depth_share(const DepthImage& depth_m);

/// Diagnoses a frame from its pyramid, its gated depth, the outcomes of the patches projected into it and the
/// predicted length of its motion blur.
[[nodiscard]] FrameHealth judge_health(const measurement::ObservedFrame& frame,
                                       std::span<const measurement::PatchOutcome> outcomes, double blur_px,
                                       const config::HealthConfig& health, const config::IekfConfig& iekf,
                                       int patch_size_px);

/// Diagnoses a frame as the first one, with `patches` usable patches: good if the next frame can be tracked
/// from it. Without light, or with fewer patches than iekf.min_patches, it cannot.
[[nodiscard]] FrameHealth judge_start(const measurement::ObservedFrame& frame, std::size_t patches,
                                      const config::HealthConfig& health, const config::IekfConfig& iekf,
                                      int patch_size_px);

}  // namespace fusebench::health
