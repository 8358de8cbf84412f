// Measurement of a surfel by one pixel: radius, confidence and merging with an existing surfel (Whelan et al.
// 2015, Sec. 3; Keller et al. 2013). The constants are those of the published program.
#pragma once

#include "core/base/types.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

/// Radius of a disc that covers a pixel at this depth, with normal_z the component of the normal along the
/// optical axis: sqrt(2) z / f / |normal_z|, at most twice the radius of a frontal disc.
[[nodiscard]] float radius_of(float depth_m, float normal_z, const PinholeCamera& camera);

/// Weight of a frame by the motion of the camera since the previous frame: 1 at rest, decreasing to 0.5 at
/// half a centimetre or half a hundredth of a radian, by the larger of the two.
[[nodiscard]] float weight_of_motion(const SE3& T_before_camera);

/// Confidence of a pixel: exp(-g^2 / 0.72) * weight of the motion, where g is its distance from the image
/// centre divided by half of the image diagonal.
[[nodiscard]] float confidence_of(int x_px, int y_px, const PinholeCamera& camera, float motion_weight);

/// Surfel after a measurement: mean weighted by confidence. If the measured radius is at least 1.5 times as
/// large, only the confidence increases. `updated` is that of the measurement.
[[nodiscard]] Surfel merged(const Surfel& known, const Surfel& measured);

}  // namespace fusebench::baselines::elasticfusion::surfels
