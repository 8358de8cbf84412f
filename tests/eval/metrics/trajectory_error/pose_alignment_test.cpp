#include "eval/metrics/trajectory_error/pose_alignment.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fusebench {

using namespace trajectory_error;

namespace {

TEST(AlignPoses, IsExactWithoutNoiseAlsoForACameraAtRest) {
  const SE3 T_reference_estimate{so3_exp({2.0, -1.0, 0.5}), {5, -3, 1}};
  std::vector<SE3> reference;
  std::vector<SE3> estimate;
  for (int i = 0; i < 20; ++i) {
    estimate.push_back({so3_exp({0.1 * i, 0.02 * i * i, -0.3}), {1, 2, 3}});  // turns on the spot
    reference.push_back(T_reference_estimate * estimate.back());
  }
  const auto aligned = align_poses(reference, estimate);
  ASSERT_TRUE(aligned.has_value());
  EXPECT_LT(rotation_angle_rad(aligned->rotation, T_reference_estimate.rotation), 1e-12);
  EXPECT_LT((aligned->translation - T_reference_estimate.translation).norm(), 1e-12);
  EXPECT_FALSE(align_poses({}, {}).has_value());
}

TEST(AlignPoses, AveragesErrorsOfOrientation) {
  std::vector<SE3> reference;
  std::vector<SE3> estimate;
  for (int i = 0; i < 10; ++i) {  // errors of opposite sign in pairs
    const Quaterniond exact = so3_exp({0.3 * i, 0, 0.1});
    reference.push_back({exact, {0, 0, 0.1 * i}});
    estimate.push_back({so3_exp({0, i % 2 == 0 ? 0.02 : -0.02, 0}) * exact, {0, 0, 0.1 * i}});
  }
  const auto aligned = align_poses(reference, estimate);
  ASSERT_TRUE(aligned.has_value());
  EXPECT_LT(rotation_angle_rad(aligned->rotation, Quaterniond::Identity()), 1e-12);
  EXPECT_LT(aligned->translation.norm(), 1e-12);
  // Half turns about three axes have no mean.
  const std::vector<SE3> contradicting = {{Quaterniond(1, 0, 0, 0), {}},
                                          {Quaterniond(0, 1, 0, 0), {}},
                                          {Quaterniond(0, 0, 1, 0), {}},
                                          {Quaterniond(0, 0, 0, 1), {}}};
  EXPECT_FALSE(align_poses(contradicting, std::vector<SE3>(4)).has_value());
}

}  // namespace
}  // namespace fusebench
