#include "core/estimator/model/tsdf/trilinear.hpp"

#include <gtest/gtest.h>

namespace fusebench::tsdf {
namespace {

using simd::all_lanes;

/// The distance a.x of a plane through the origin at the voxels of a lattice; `first`: its first voxel.
struct PlaneCube {
  std::array<float, 3> slope_m{};  ///< per voxel
  int first = 0;
  int unobserved_x = -100;  ///< voxels there were not observed

  [[nodiscard]] simd::Float8 distance_m(int x, int y, int z) const {
    if (first + x == unobserved_x) return not_a_number();
    return all_lanes(slope_m[0] * static_cast<float>(first + x) + slope_m[1] * static_cast<float>(first + y) +
                     slope_m[2] * static_cast<float>(first + z));
  }
  [[nodiscard]] simd::Pairs pair_m(int x, int y, int z) const {
    return {distance_m(x, y, z), distance_m(x + 1, y, z)};
  }
};

constexpr std::array<float, 3> kSlope_m = {0.003F, -0.002F, 0.005F};
const simd::Points kPoint = {all_lanes(2.25F), all_lanes(2.5F), all_lanes(2.875F)};

TEST(Trilinear, InterpolatesAPlaneExactly) {
  const simd::Float8 distance_m = interpolated_m(TrilinearCell(kPoint), PlaneCube{kSlope_m, 2});
  EXPECT_NEAR(distance_m[0], 2.25F * kSlope_m[0] + 2.5F * kSlope_m[1] + 2.875F * kSlope_m[2], 1e-8);
}

TEST(Trilinear, TheGradientOfAPlaneIsItsSlope) {
  const simd::Points gradient = interpolated_gradient(TrilinearCell(kPoint), PlaneCube{kSlope_m, 1});
  EXPECT_NEAR(gradient.x[0], kSlope_m[0], 1e-8);
  EXPECT_NEAR(gradient.y[0], kSlope_m[1], 1e-8);
  EXPECT_NEAR(gradient.z[0], kSlope_m[2], 1e-8);
}

TEST(Trilinear, TheGradientNextToUnobservedVoxelsIsOneSided) {
  const simd::Points gradient = interpolated_gradient(TrilinearCell(kPoint), PlaneCube{kSlope_m, 1, 1});
  EXPECT_NEAR(gradient.x[0], kSlope_m[0], 1e-8);
}

}  // namespace
}  // namespace fusebench::tsdf
