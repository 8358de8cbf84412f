// The probe patches of a frame, and where their pixels are.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "datasets/simulator/rays/ray_caster.hpp"

namespace fusebench::pose_intensity {

/// One pixel of frame k-1.
struct Probe {
  Vector3d point_camera = Vector3d::Zero();  ///< metres, frame of the camera then
  double grey = 0;
};

/// Where a point of frame k-1 is in frame k.
[[nodiscard]] Vector2d landed_px(const PinholeCamera& camera, const SE3& T_now_before, const Vector3d& point);

/// Squares around corners; pixels without depth are left out, and squares of fewer than
/// patches.min_valid_px. depth_m: gated. `true_depth` replaces the measured depth.
[[nodiscard]] std::vector<Probe> probes_of(const GreyImage& grey, const DepthImage& depth_m,
                                           const PinholeCamera& camera, const config::PatchConfig& patches,
                                           const DepthImage* true_depth_m);

/// Whether a probe is seen in the frame: it lands inside, and what is measured there, if anything, is it.
[[nodiscard]] bool is_seen(const Vector3d& point_now, const PinholeCamera& camera, const DepthImage& depth_m,
                           const config::PatchConfig& patches, const config::DepthConfig& depth);

/// Depth of the true surface at all pixels; 0 where there is none.
[[nodiscard]] DepthImage true_depth_m(const simulator::rays::RayCaster& scene, const PinholeCamera& camera,
                                      const SE3& T_truth_camera);

}  // namespace fusebench::pose_intensity
