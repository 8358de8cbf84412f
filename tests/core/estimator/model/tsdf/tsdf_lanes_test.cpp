#include "core/estimator/model/tsdf/tsdf_lanes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "tests/support/fused_scene.hpp"
#include "tests/support/plain_field.hpp"

namespace fusebench {

using namespace simd;
using namespace tsdf;

namespace {

TEST(TsdfLanes, SamplesByTrilinearInterpolation) {
  const TsdfVolume volume = fuse(ball_scene(), test_camera(160, 120, 60.0), poses_around_ball());
  const TsdfLanes lanes(volume, Vector3d(0.1, -0.2, 0.3), 1.0);
  testing::PlainField field(volume);
  int valid = 0;
  int unknown = 0;
  for (int i = 0; i < 250; ++i) {
    Points at{};
    std::array<std::optional<double>, kLanes> expected_m;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // Points on a spiral through the band and beyond on either side; lattice coordinates of both signs.
      const int n = static_cast<int>(kLanes) * i + static_cast<int>(lane);
      const double angle = 0.37 * n, height = -0.9 + 1.8 * n / 2000.0;
      const double radius_m = 0.22 + 0.02 * ((n * 7) % 8);
      const double ring = std::sqrt(1.0 - height * height);
      const Vector3d point = radius_m * Vector3d(ring * std::cos(angle), ring * std::sin(angle), height);
      expected_m[lane] = field.distance_m(point);
      const Eigen::Vector3f from_origin = (point / volume.voxel_m() - lanes.origin_voxel()).cast<float>();
      at.x[lane] = from_origin.x();
      at.y[lane] = from_origin.y();
      at.z[lane] = from_origin.z();
    }
    const Float8 distance_m = lanes.sample(at);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      ASSERT_EQ(std::isnan(distance_m[lane]), !expected_m[lane].has_value());
      ++(expected_m[lane] ? valid : unknown);
      if (!expected_m[lane]) continue;
      EXPECT_NEAR(static_cast<double>(distance_m[lane]), expected_m[lane].value_or(0.0), 1e-6);
    }
  }
  EXPECT_GT(valid, 500);
  EXPECT_GT(unknown, 50);
}

}  // namespace
}  // namespace fusebench
