// The clock of recorded motions: hand-held cameras before a motion capture, and ICL-NUIM's paths.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/reference_clock/time_offset.hpp"
#include "tests/eval/metrics/reference_clock/moving_bodies.hpp"

namespace fusebench {

using namespace reference_clock;
using testing::seen_by;
using testing::with_errors;

namespace {

/// A trajectory below FUSEBENCH_DATA; stamp_s: of a unit of its stamps.
Trajectory recorded(const std::string& name, double stamp_s) {
  const char* const data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) return {};
  std::vector<std::string> warnings;
  auto read = trajectory::read_tum_trajectory(std::filesystem::path(data) / name, warnings);
  if (!read) return {};
  for (StampedPose& pose : *read)
    pose.timestamp_ns = std::llround(stamp_s * static_cast<double>(pose.timestamp_ns));
  return *read;
}

/// What a camera at 30 Hz has of it, but for 0.7 s at either end, on a clock that is offset_s behind.
Trajectory camera_before(const Trajectory& reference, double offset_s) {
  constexpr std::int64_t kMargin_ns = 700'000'000;
  constexpr std::int64_t kInterval_ns = 33'300'000;
  Trajectory camera;
  for (std::int64_t at_ns = reference.front().timestamp_ns + kMargin_ns;
       at_ns < reference.back().timestamp_ns - kMargin_ns; at_ns += kInterval_ns) {
    const auto pose = trajectory::interpolate_pose(reference, at_ns, trajectory::kMaxTruthGap_ns);
    if (pose) camera.push_back({at_ns - std::llround(1e9 * offset_s), *pose});
  }
  return camera;
}

class RecordedClock : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(RecordedClock, ShiftsAreRecoveredAndTheSigmaIsThatOfTheErrors) {
  const Trajectory reference = recorded(GetParam().first, GetParam().second);
  if (reference.empty()) GTEST_SKIP() << "FUSEBENCH_DATA has no " << GetParam().first;
  const SE3 T_body_camera(so3_exp({0.9, 0.7, -1.8}), {0.2, -0.17, 0.14});
  const testing::PoseErrors errors{.white = 0.001, .correlated = 0.002, .correlation_s = 0.3, .walk = 0.003};
  constexpr int kDraws = 20;  // of the errors, at each offset
  unsigned seed = 0;
  std::size_t count = 0, beyond = 0;
  double squares = 0;
  for (const double offset_s : {-0.15, -0.02, 0.0, 0.02, 0.066, 0.15}) {
    const Trajectory exact = seen_by(camera_before(reference, offset_s), T_body_camera, 1.05);
    const auto clean = fitted_time_offset(reference, exact);
    ASSERT_TRUE(clean) << clean.error().message;
    EXPECT_NEAR(clean->offset_s, offset_s, 1e-4);
    for (int draw = 0; draw < kDraws; ++draw) {
      const auto rough = fitted_time_offset(reference, with_errors(exact, errors, ++seed));
      ASSERT_TRUE(rough) << rough.error().message;
      EXPECT_LT(rough->sigma_s, 0.006);
      const double sigmas = (rough->offset_s - offset_s) / rough->sigma_s;
      ++count;
      beyond += std::abs(sigmas) > 3 ? 1 : 0;
      squares += sigmas * sigmas;
    }
  }
  // Of normal errors 0.3 % are beyond three sigmas; of a few seconds, whose variance is known less well, 1.3
  // %, and of 120 draws then more than 4 with a probability of 2 %.
  EXPECT_LE(beyond, 4U) << count;
  const double nees = squares / static_cast<double>(count);
  EXPECT_GT(nees, 0.5);
  EXPECT_LT(nees, 2.0);
}

INSTANTIATE_TEST_SUITE_P(
    , RecordedClock,
    ::testing::Values(std::pair("rgbd_dataset_freiburg1_rpy_first240/groundtruth.txt", 1.0),
                      std::pair("rgbd_dataset_freiburg1_xyz_first150/groundtruth.txt", 1.0),
                      std::pair("icl_nuim_trajectories/livingRoom0.gt.freiburg.derived", 1.0 / 30),
                      std::pair("icl_nuim_trajectories/livingRoom2.gt.freiburg.derived", 1.0 / 30)));

}  // namespace
}  // namespace fusebench
