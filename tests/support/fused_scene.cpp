#include "tests/support/fused_scene.hpp"

#include <gtest/gtest.h>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"

namespace fusebench {

tsdf::TsdfVolume fuse(const AnalyticScene& scene, const PinholeCamera& camera, const std::vector<SE3>& poses,
                      const config::TsdfConfig& tsdf, const config::DepthConfig& depth, int threads) {
  const Workers workers(threads);
  tsdf::TsdfVolume volume(tsdf);
  for (const SE3& T_world_camera : poses) {
    const auto fused =
        volume.integrate(scene.render(camera, T_world_camera), camera, T_world_camera, depth, workers);
    EXPECT_TRUE(fused.has_value()) << fused.error().message;
  }
  return volume;
}

tsdf::TsdfVolume fuse(const AnalyticScene& scene, const PinholeCamera& camera, const std::vector<SE3>& poses,
                      const config::TsdfConfig& tsdf) {
  return fuse(scene, camera, poses, tsdf, config::DepthConfig{});
}

tsdf::TsdfVolume fuse(const AnalyticScene& scene, const PinholeCamera& camera,
                      const std::vector<SE3>& poses) {
  return fuse(scene, camera, poses, config::TsdfConfig{});
}

}  // namespace fusebench
