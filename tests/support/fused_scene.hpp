// Analytic scenes fused into a model: what the tests of the model, the raycaster and the mesh start from.
#pragma once

#include <vector>

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "tests/support/analytic_scene.hpp"

namespace fusebench {

/// Fuses one rendered frame a pose; a failure fails the test that calls.
tsdf::TsdfVolume fuse(const AnalyticScene& scene, const PinholeCamera& camera, const std::vector<SE3>& poses,
                      const config::TsdfConfig& tsdf, const config::DepthConfig& depth, int threads = 2);
/// With the default options of depth.
tsdf::TsdfVolume fuse(const AnalyticScene& scene, const PinholeCamera& camera, const std::vector<SE3>& poses,
                      const config::TsdfConfig& tsdf);
/// With the default options.
tsdf::TsdfVolume fuse(const AnalyticScene& scene, const PinholeCamera& camera, const std::vector<SE3>& poses);

/// A room with a ball in it, seen from its middle.
inline AnalyticScene room_with_a_ball() {
  return {{AnalyticBox{{-1.513, -1.207, -1.411}, {1.509, 1.211, 1.607}, true, {90, 100, 110}},
           AnalyticSphere{{0.4, 0.3, 0.9}, 0.3, {200, 20, 20}}}};
}

/// A ball of 0.3 m radius around a point that lies on no symmetry of the lattice.
inline AnalyticScene ball_scene() {
  return {{AnalyticSphere{{0.0137, -0.0211, 0.0073}, 0.3, {180, 90, 30}}}};
}
inline std::vector<SE3> poses_around_ball() { return poses_around({0.0137, -0.0211, 0.0073}, 1.0, 24); }

}  // namespace fusebench
