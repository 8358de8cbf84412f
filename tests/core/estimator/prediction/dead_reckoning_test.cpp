// Dead reckoning without an IMU against the ground truth of recorded hand-held motions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/trajectory/trajectory.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "core/config/groups/prediction_config.hpp"
#include "core/estimator/prediction/motion_prior.hpp"

namespace fusebench::prediction {
namespace {

/// At 30 Hz.
std::vector<SE3> camera_poses(const std::string& name) {
  const char* const data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) return {};
  std::vector<std::string> warnings;
  const auto read =
      trajectory::read_tum_trajectory(std::filesystem::path(data) / name / "groundtruth.txt", warnings);
  if (!read || read->empty()) return {};
  constexpr std::int64_t kInterval_ns = 33'333'333;
  std::vector<SE3> poses;
  for (std::int64_t at_ns = read->front().timestamp_ns; at_ns < read->back().timestamp_ns;
       at_ns += kInterval_ns) {
    const auto pose = trajectory::interpolate_pose(*read, at_ns, trajectory::kMaxTruthGap_ns);
    if (!pose) break;
    poses.push_back(*pose);
  }
  return poses;
}

constexpr double kInterval_s = 1.0 / 30;

/// The pose is exact, and the velocities are those of the last two intervals.
filter::FilterState state_at(const std::vector<SE3>& poses, std::size_t frame) {
  filter::FilterState state;
  const SE3& before = poses[frame - 2];
  state.T_world_imu = poses[frame];
  state.velocity_world_mps = (poses[frame].translation - before.translation) / (2 * kInterval_s);
  state.angular_velocity_imu_radps =
      so3_log(before.rotation.conjugate() * poses[frame].rotation) / (2 * kInterval_s);
  return state;
}

/// Squared errors over their claimed variances, per degree of freedom.
struct Nees {
  double position = 0;
  double rotation = 0;
  int count = 0;
};

void add_errors(const std::vector<SE3>& poses, std::size_t frames_ahead, Nees& nees) {
  const config::MotionConfig config;
  MotionScale scale = initial_motion_scale(config);
  for (std::size_t frame = 2; frame + frames_ahead < poses.size(); ++frame) {
    filter::GaussianState state;
    state.mean = state_at(poses, frame);
    state.covariance.setZero();
    scale = followed_scale(scale, state.mean, kInterval_s, config);
    const double ahead_s = kInterval_s * static_cast<double>(frames_ahead);
    const filter::GaussianState predicted = predict_by_motion_model(state, ahead_s, scale, config).state;
    const SE3& truth = poses[frame + frames_ahead];
    const SE3& claimed = predicted.mean.T_world_imu;
    const Vector3d rotation = so3_log(claimed.rotation.conjugate() * truth.rotation);
    nees.position += (truth.translation - claimed.translation).squaredNorm() / 3 /
                     predicted.covariance(filter::kPosition, filter::kPosition);
    nees.rotation += rotation.squaredNorm() / 3 / predicted.covariance(filter::kRotation, filter::kRotation);
    ++nees.count;
  }
}

TEST(DeadReckoning, ClaimsItsErrorOnRecordedMotions) {
  std::vector<std::vector<SE3>> recordings;
  for (const char* name : {"rgbd_dataset_freiburg1_rpy_first240", "rgbd_dataset_freiburg1_xyz_first150"})
    recordings.push_back(camera_poses(name));
  for (const auto& poses : recordings) {
    if (poses.empty()) GTEST_SKIP() << "FUSEBENCH_DATA has no TUM recordings";
  }
  for (const std::size_t frames_ahead : {3U, 10U, 30U, 90U}) {
    Nees nees;
    for (const auto& poses : recordings) add_errors(poses, frames_ahead, nees);
    const double position = nees.position / nees.count, rotation = nees.rotation / nees.count;
    // Two recordings of a few seconds: within a factor of four. Both cameras move about one place, which the
    // model does not assume.
    const double least = frames_ahead <= 30 ? 0.25 : 0;
    EXPECT_GT(position, least) << frames_ahead << " frames";
    EXPECT_LT(position, 4) << frames_ahead << " frames";
    EXPECT_GT(rotation, least) << frames_ahead << " frames";
    EXPECT_LT(rotation, 4) << frames_ahead << " frames";
  }
}

}  // namespace
}  // namespace fusebench::prediction
