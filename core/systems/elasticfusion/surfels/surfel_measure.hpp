// What one pixel says of a surfel: how large it is, how much it counts, and how it enters one that is there
// (Whelan et al. 2015, Sec. 3; Keller et al. 2013). Constants are the program's.
#pragma once

#include "core/base/types.hpp"
#include "core/systems/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::systems::elasticfusion::surfels {

/// Of a disc that covers a pixel at this depth, with a normal whose part along the optical axis is normal_z
/// (camera frame): sqrt(2) z / f / |normal_z|, at most twice that of a disc seen from the front.
[[nodiscard]] float radius_of(float depth_m, float normal_z, const PinholeCamera& camera);

/// How much measurements of a frame count by the camera's motion since the one before: 1 at rest, falling to
/// 0.5 from half a centimetre or half a hundredth of a radian on, the larger of the two.
[[nodiscard]] float weight_of_motion(const SE3& T_before_camera);

/// How much a pixel counts: exp(-g^2 / 0.72), where g is its distance from the centre of the image by half
/// of the image's diagonal, times the weight of the motion.
[[nodiscard]] float confidence_of(int x_px, int y_px, const PinholeCamera& camera, float motion_weight);

/// A surfel after a measurement of the same surface. Both are averaged by their confidences, unless the new
/// one is 1.5 times as large or larger: then the confidence alone grows. `updated` is the new one's.
[[nodiscard]] Surfel merged(const Surfel& known, const Surfel& measured);

}  // namespace fusebench::systems::elasticfusion::surfels
