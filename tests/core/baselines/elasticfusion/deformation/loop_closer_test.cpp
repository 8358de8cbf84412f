#include "core/baselines/elasticfusion/deformation/loop_closer.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/baselines/elasticfusion/surfels/surfel_fusion.hpp"
#include "tests/core/baselines/elasticfusion/room_views.hpp"

namespace fusebench {

using namespace baselines::elasticfusion;

namespace {

constexpr std::int32_t kFramesOfAVisit = 50;
constexpr std::size_t kStride = 7919;  // a prime

config::ElasticfusionConfig local_loops() {
  config::ElasticfusionConfig config;
  config.loops = config::ElasticfusionLoops::local;
  return config;
}

/// A camera with repeated views of one part of the room, each with the accumulated drift.
class LoopCloser : public ::testing::Test {
 protected:
  /// The part in the frames before `last`, for an estimated pose T_world_camera. Returns the index of the
  /// first of its surfels.
  std::size_t visit(const SE3& T_world_camera, std::int32_t last) {
    surfels::SurfelMap seen;
    fusion_.start(live_, {T_world_camera, last}, seen);
    const std::size_t first = map_.size();
    // Each frame adds some everywhere.
    for (std::size_t i = 0; i < seen.size(); ++i) {
      surfels::Surfel surfel = seen.at(i * kStride % seen.size());
      surfel.created = last - kFramesOfAVisit +
                       static_cast<std::int32_t>(i * static_cast<std::size_t>(kFramesOfAVisit) / seen.size());
      surfel.confidence = 2 * static_cast<float>(config_.stable_confidence);
      map_.add(surfel);
    }
    poses_.push_back({last, last, T_world_camera});
    return first;
  }

  bool close(std::int32_t time) {
    const surfels::SurfelChoice active{time, config_.time_window, true,
                                       static_cast<float>(config_.stable_confidence)};
    surfels::SurfelView view;
    surfels::ViewRenderer().render(map_, testing::small_camera(), poses_.back().T_world_camera, active,
                                   workers_, view);
    return closer_.close(live_, view, time, map_, poses_);
  }

  /// Distance of the surfels of a visit, which all show the same part, to those of the first visit.
  [[nodiscard]] double mean_distance_m(std::size_t first, std::size_t count) const {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i)
      sum += static_cast<double>((map_.position[first + i] - first_seen_.position[i]).norm());
    return sum / static_cast<double>(count);
  }

  Workers workers_{2};
  config::ElasticfusionConfig config_ = local_loops();
  surfels::LiveFrame live_ = testing::live_at(SE3{}, workers_);
  surfels::SurfelFusion fusion_{testing::small_camera(), 10, 200, workers_};
  deformation::LoopCloser closer_{config_, testing::small_camera(), workers_};
  surfels::SurfelMap map_, first_seen_;
  std::vector<deformation::TimedPose> poses_;
};

TEST_F(LoopCloser, TheActiveModelComesToTheInactiveOne) {
  visit(SE3{}, 50);
  first_seen_ = map_;
  const std::size_t again = visit({so3_exp({0.002, -0.003, 0.001}), {0.006, -0.004, 0.008}}, 300);
  const double apart_m = mean_distance_m(again, again);
  ASSERT_TRUE(close(300));
  EXPECT_LT(poses_.back().T_world_camera.translation.norm(), 5e-4);
  EXPECT_LT(mean_distance_m(0, again), 5e-4);
  // Surfels created early in the visit are between both.
  EXPECT_LT(mean_distance_m(again, again), 0.5 * apart_m);
}

TEST_F(LoopCloser, WhatWasThereWhenAnEarlierLoopClosedStays) {
  visit(SE3{}, 50);
  const std::size_t count = map_.size();
  visit({Quaterniond::Identity(), {0.006, -0.004, 0.008}}, 300);
  ASSERT_TRUE(close(300));
  const surfels::SurfelMap bent = map_;
  const std::vector<deformation::TimedPose> poses = poses_;
  const Vector3d drift_m(-0.006, 0.005, 0.004);
  visit({so3_exp({-0.002, 0.002, 0}), drift_m}, 600);
  ASSERT_TRUE(close(600));
  for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(map_.position[i], bent.position[i]) << "surfel " << i;
  EXPECT_LT((poses_[0].T_world_camera.translation - poses[0].T_world_camera.translation).norm(), 1e-12);
  // The camera comes to where the model is.
  EXPECT_LT(poses_.back().T_world_camera.translation.norm(), 0.75 * drift_m.norm());
}

}  // namespace
}  // namespace fusebench
