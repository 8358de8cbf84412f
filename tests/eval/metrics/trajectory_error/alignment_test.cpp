// Which motions determine an alignment, and how exact it is far from the origin.
#include "eval/metrics/trajectory_error/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "eval/metrics/trajectory_error/pose_nees.hpp"
#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"
#include "eval/metrics/trajectory_files/coordinate_rounding.hpp"

namespace fusebench {

using namespace trajectory_files;
using namespace trajectory_error;

namespace {

using PositionAt = std::function<Vector3d(double t)>;
constexpr std::size_t kCameras = 200;
constexpr double kDoubles = 0;  // as decimal: no rounding but that of doubles

double rounded(double value, double decimal) {
  return decimal > 0 ? std::nearbyint(value / decimal) * decimal : value;
}

/// A camera at given positions that turns, with positions rounded to a decimal (m).
Trajectory camera_at(const PositionAt& position_at, double decimal = kDoubles) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < kCameras; ++i) {
    const double t = static_cast<double>(i) / 30.0;
    SE3 pose{so3_exp({0.3 * std::sin(0.7 * t), 0.4 * t, 0.2 * std::cos(t)}), position_at(t)};
    for (double& coordinate : pose.translation) coordinate = rounded(coordinate, decimal);
    trajectory.push_back({static_cast<std::int64_t>(i) * 33'333'333, pose});
  }
  return trajectory;
}

Vector3d hand_path(double t) {
  return {std::sin(t), 0.5 * std::cos(1.3 * t), 0.2 * t + 0.1 * std::sin(2.1 * t)};
}

/// A path whose positions are turned and moved: full numbers of doubles.
PositionAt moved_path(const PositionAt& path, const SE3& T) {
  return [=](double t) { return T * path(t); };
}

const SE3 kElsewhere{so3_exp({0.4, -1.1, 2.0}), {3.0, -7.0, 0.5}};

Result<TrajectoryEvaluation> ate_of(const Trajectory& reference, const Trajectory& estimate,
                                    AlignmentMode mode, Protocol protocol = Protocol::evo) {
  TrajectoryRequest request = request_for(protocol, TrajectoryMetric::ate).value();
  request.alignment.mode = mode;
  return evaluate(reference, estimate, request);
}

constexpr AlignmentMode kByPositions[] = {AlignmentMode::se3, AlignmentMode::sim3, AlignmentMode::scale,
                                          AlignmentMode::yaw};

void expect_refused(const Trajectory& reference, const Trajectory& estimate, AlignmentMode mode,
                    const std::string& why, const std::string& what) {
  const auto error = ate_of(reference, estimate, mode);
  ASSERT_FALSE(error.has_value()) << what << ", " << to_string(mode) << ": rmse "
                                  << error->series[0].stats.rmse;
  EXPECT_EQ(error.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(error.error().message.find(why), std::string::npos) << what << ": " << error.error().message;
  EXPECT_NE(error.error().hint.find("--align origin"), std::string::npos) << error.error().hint;
  EXPECT_NE(error.error().hint.find("in place of -a, -s"), std::string::npos) << error.error().hint;
}

/// Positions that are equal but for errors of the numbers, as files and transforms make them.
std::vector<std::pair<std::string, Trajectory>> still_cameras() {
  std::mt19937 random(4);
  const auto jitter = [&](const Vector3d& at, double step) {
    return [=, &random](double) {
      std::uniform_int_distribution<int> steps(-1, 1);
      const double x = steps(random), y = steps(random);
      return Vector3d(at + step * Vector3d(x, y, steps(random)));
    };
  };
  const auto at = [](const Vector3d& position) { return [=](double) { return position; }; };
  return {{"equal", camera_at(at({1.1, 2.2, 3.3}))},
          {"at zero", camera_at(at({0, 0, 0}))},
          {"a last digit of nine decimals", camera_at(jitter({1.1, 2.2, 3.3}, 1e-9), 1e-9)},
          {"a last digit of four decimals", camera_at(jitter({1.1, 2.2, 3.3}, 1e-4), 1e-4)},
          {"rounding of doubles", camera_at(jitter({1.1, -2.2, 3.3}, 4.5e-16))},
          {"rounding of doubles far away", camera_at(jitter({1e6, -2e6, 3e6}, 4.7e-10))},
          {"a last digit far away", camera_at(jitter({1e6, -2e6, 10}, 1e-3), 1e-3)}};
}

TEST(Alignment, OfASideThatDoesNotMoveIsRefused) {
  const Trajectory moving = camera_at(hand_path);
  for (const auto& [what, still] : still_cameras()) {
    for (const AlignmentMode mode : kByPositions) {
      expect_refused(still, moving, mode, "the reference does not move", what);
      expect_refused(moving, still, mode, "the estimate does not move", what);
      expect_refused(still, still, mode, "the reference does not move", what);
    }
    for (const AlignmentMode mode : {AlignmentMode::none, AlignmentMode::origin}) {
      EXPECT_TRUE(ate_of(still, moving, mode).has_value()) << what;
      EXPECT_TRUE(ate_of(moving, still, mode).has_value()) << what;
    }
  }
}

TEST(Alignment, OfAStillSideIsRefusedByEveryProtocolThatAligns) {
  const Trajectory moving = camera_at(hand_path);
  const Trajectory still = camera_at([](double) { return Vector3d(1.1, 2.2, 3.3); });
  for (const auto& [reference, estimate] : {std::pair(still, moving), std::pair(moving, still)}) {
    for (const Protocol protocol : {Protocol::tum, Protocol::rpg, Protocol::eth3d}) {
      const auto request = request_for(protocol, TrajectoryMetric::ate);
      EXPECT_FALSE(evaluate(reference, estimate, *request).has_value()) << to_string(protocol);
    }
    for (const Protocol protocol :
         {Protocol::evo, Protocol::tum, Protocol::rpg, Protocol::eth3d, Protocol::kitti}) {
      auto request = request_for(protocol, TrajectoryMetric::rpe);
      request->alignment.mode = AlignmentMode::sim3;
      EXPECT_FALSE(evaluate(reference, estimate, *request).has_value()) << to_string(protocol);
    }
    LoadedTrajectory covered;
    covered.poses = estimate;
    covered.covariances.assign(estimate.size(), {Matrix3d::Identity(), Matrix3d::Identity()});
    for (const AlignmentMode mode : {AlignmentMode::se3, AlignmentMode::yaw})
      EXPECT_FALSE(pose_consistency(reference, covered, {}, {mode}).has_value()) << to_string(mode);
    EXPECT_TRUE(pose_consistency(reference, covered, {}, {AlignmentMode::origin}).has_value());
  }
}

TEST(Alignment, OfAStraightLineIsRefusedHoweverItIsWritten) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (const double decimal : {1e-3, 1e-4, 1e-6, 1e-9, kDoubles}) {
    for (int k = 0; k < 20; ++k) {
      const double x = normal(random), y = normal(random);
      const Vector3d direction = Vector3d(x, y, normal(random)).normalized();
      const PositionAt line = [=](double t) {
        return Vector3d(Vector3d(0.3, -0.2, 1.7) + (0.4 * t + 0.2 * std::sin(t)) * direction);
      };
      const Trajectory reference = camera_at(line, decimal);
      const Trajectory same = camera_at(moved_path(line, kElsewhere), decimal);
      const Trajectory other = camera_at(hand_path, decimal);
      const std::string what = "decimal " + std::to_string(decimal);
      for (const AlignmentMode mode : {AlignmentMode::se3, AlignmentMode::sim3, AlignmentMode::scale}) {
        expect_refused(reference, reference, mode, "the reference moves along a straight line", what);
        expect_refused(reference, same, mode, "the reference moves along a straight line", what);
        expect_refused(reference, other, mode, "the reference moves along a straight line", what);
        expect_refused(other, reference, mode, "the estimate moves along a straight line", what);
      }
      EXPECT_TRUE(ate_of(reference, same, AlignmentMode::yaw).has_value()) << "it moves horizontally";
    }
  }
}

TEST(Alignment, OfYawNeedsHorizontalMotion) {
  const PositionAt up = [](double t) { return Vector3d(0.71, -0.33, std::sin(t)); };
  std::mt19937 random(2);
  for (const double decimal : {1e-4, 1e-9, kDoubles}) {
    std::uniform_real_distribution<double> error(-0.5 * decimal, 0.5 * decimal);
    const PositionAt nearly_up = [&](double t) {
      const double x = error(random);
      return Vector3d(up(t) + Vector3d(x, error(random), 0));
    };
    const Trajectory moving = camera_at(hand_path, decimal);
    const Trajectory rising = camera_at(decimal > 0 ? nearly_up : up, decimal);
    expect_refused(rising, moving, AlignmentMode::yaw, "the reference does not move horizontally", "up");
    expect_refused(moving, rising, AlignmentMode::yaw, "the estimate does not move horizontally", "up");
  }
  // A line is enough, and so are two poses; one has its orientation.
  const PositionAt along = [](double t) { return Vector3d(0.02 * t, 0.01 * t, 1); };
  const SE3 turn{so3_exp({0, 0, 1.2}), {1, 2, 3}};
  const Trajectory line = camera_at(along);
  Trajectory turned = line;
  for (StampedPose& pose : turned) pose.T_world_camera = turn * pose.T_world_camera;
  for (const std::size_t poses : {kCameras, std::size_t{2}, std::size_t{1}}) {
    const auto error = ate_of(Trajectory(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(poses)),
                              Trajectory(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(poses)),
                              AlignmentMode::yaw);
    ASSERT_TRUE(error.has_value()) << poses << ": " << error.error().message;
    EXPECT_LT(rotation_angle_rad(error->alignment.rigid.rotation, turn.rotation), 1e-9) << poses;
  }
}

TEST(Alignment, OfTheYawOfOnePoseNeedsZAxesThatAreNotOpposite) {
  const auto one_pose = [](const Vector3d& rotation_vector) {
    return Trajectory{{0, {so3_exp(rotation_vector), {1, 2, 3}}}};
  };
  constexpr double kPi = std::numbers::pi;
  for (const double off_rad : {0.0, 1e-4, -1e-3}) {
    expect_refused(one_pose({0, 0, 0}), one_pose({kPi + off_rad, 0, 0}), AlignmentMode::yaw,
                   "the z axes of the only pair of poses are opposite", "upside down");
  }
  const auto tilted = ate_of(one_pose({0, 0, 0.7}), one_pose({kPi - 0.01, 0, 0}), AlignmentMode::yaw);
  ASSERT_TRUE(tilted) << tilted.error().message;
  EXPECT_NEAR(rotation_angle_rad(tilted->alignment.rigid.rotation, so3_exp({0, 0, 0.7})), 0, 1e-9);
}

TEST(Alignment, OfSmallOrFlatMotionIsFound) {
  struct Path {
    const char* what;
    PositionAt at;
    double decimal;
    double exact_rad;
  };
  const PositionAt flat = [](double t) { return Vector3d(std::sin(t), 0.3 * std::cos(1.7 * t), 0); };
  const auto times = [](const PositionAt& path, double factor) {
    return PositionAt([=](double t) { return Vector3d(factor * path(t)); });
  };
  for (const Path& path :
       {Path{"hand held", hand_path, 1e-4, 1e-4}, Path{"flat", flat, kDoubles, 1e-12},
        Path{"flat, rounded", flat, 1e-4, 1e-4}, Path{"1 cm", times(hand_path, 0.01), 1e-4, 1e-2},
        Path{"0.1 mm", times(hand_path, 1e-4), 1e-9, 1e-5},
        Path{"1e-9 m", times(hand_path, 1e-9), 1e-16, 1e-7},
        Path{"nearly a line", [](double t) { return Vector3d(t, 0.01 * std::sin(t), 0); }, 1e-6, 1e-4},
        Path{"1 km", times(hand_path, 1e3), 1e-4, 1e-6}}) {
    const Trajectory estimate = camera_at(path.at, path.decimal);
    const Trajectory reference =
        camera_at(moved_path(path.at, SE3{kElsewhere.rotation, Vector3d::Zero()}), path.decimal);
    for (const AlignmentMode mode : {AlignmentMode::se3, AlignmentMode::sim3}) {
      const auto error = ate_of(reference, estimate, mode);
      ASSERT_TRUE(error.has_value()) << path.what << ": " << error.error().message;
      EXPECT_LT(rotation_angle_rad(error->alignment.rigid.rotation, kElsewhere.rotation), path.exact_rad)
          << path.what;
    }
  }
}

TEST(Alignment, WithoutAUniqueRotationIsRefused) {
  // A mirrored cross with two equal arms: each half turn about an axis in their plane is as good.
  const auto cross = [](double z) {
    Trajectory poses;
    for (int k = 0; k < 6; ++k) {
      Vector3d arm = (k % 2 == 0 ? 1 : -1) * Vector3d::Unit(k / 2);
      arm.z() *= z;
      poses.push_back({k * 1'000'000'000LL, {Quaterniond::Identity(), arm}});
    }
    return poses;
  };
  expect_refused(cross(1), cross(-1), AlignmentMode::se3, "no unique best rotation", "mirrored");
  EXPECT_TRUE(ate_of(cross(1), cross(2), AlignmentMode::se3).has_value());
}

TEST(Alignment, TheMessageNamesTheSideAndItsExtent) {
  const auto error = ate_of(camera_at(hand_path), camera_at([](double) { return Vector3d(1.1, 2.2, 3.3); }),
                            AlignmentMode::sim3);
  ASSERT_FALSE(error.has_value());
  EXPECT_EQ(
      error.error().message,
      "the trajectory cannot be aligned: the estimate does not move: its 200 matched positions extend over "
      "0 m");
}

/// The same trajectory elsewhere. Positions are multiples of 2^-30 m, so that the sums are exact.
Trajectory far_away(Trajectory trajectory, const Vector3d& shift) {
  for (StampedPose& pose : trajectory) pose.T_world_camera.translation += shift;
  return trajectory;
}

TEST(Alignment, FarFromTheOriginIsAsExact) {
  constexpr double kDecimal = 0x1p-30;
  const Trajectory reference = camera_at(hand_path, kDecimal);
  const Trajectory estimate = camera_at(
      [](double t) {
        return Vector3d(hand_path(t) + 0.02 * Vector3d(std::sin(5 * t), std::cos(3 * t), std::sin(7 * t)));
      },
      kDecimal);
  const Vector3d far(0x1p20, -0x1p21, 0x1p19);
  struct Sides {
    Trajectory reference;
    Trajectory estimate;
  };
  const std::vector<Sides> shifted = {{far_away(reference, far), estimate},
                                      {reference, far_away(estimate, far)},
                                      {far_away(reference, far), far_away(estimate, far)}};
  for (const AlignmentMode mode :
       {AlignmentMode::se3, AlignmentMode::sim3, AlignmentMode::yaw, AlignmentMode::origin}) {
    for (const Protocol protocol : {Protocol::evo, Protocol::tum, Protocol::rpg, Protocol::eth3d}) {
      const auto near = ate_of(reference, estimate, mode, protocol);
      ASSERT_TRUE(near.has_value());
      for (const Sides& sides : shifted) {
        const auto far_error = ate_of(sides.reference, sides.estimate, mode, protocol);
        ASSERT_TRUE(far_error.has_value());
        for (std::size_t i = 0; i < kCameras; ++i)
          ASSERT_NEAR(far_error->series[0].errors[i], near->series[0].errors[i], 1e-13) << to_string(mode);
      }
    }
  }
  for (const Protocol protocol : {Protocol::evo, Protocol::tum, Protocol::rpg}) {
    TrajectoryRequest request = request_for(protocol, TrajectoryMetric::rpe).value();
    const auto near = evaluate(reference, estimate, request);
    ASSERT_TRUE(near.has_value()) << near.error().message;
    for (const Sides& sides : shifted)
      EXPECT_NEAR(evaluate(sides.reference, sides.estimate, request)->series[0].stats.rmse,
                  near->series[0].stats.rmse, 1e-12)
          << to_string(protocol);
  }
}

TEST(CoordinateRounding, IsHalfOfTheLastDecimal) {
  const auto of = [](std::vector<Vector3d> positions) { return coordinate_rounding(positions); };
  EXPECT_DOUBLE_EQ(of({{1, 2, 3}, {0, 0, 1}}), 5e-4) << "at most half a millimetre";
  EXPECT_DOUBLE_EQ(of({{1.5, 0.25, 0.125}}), 5e-4);
  EXPECT_DOUBLE_EQ(of({{1, 2, 3}, {0, 0.1234, 1}}), 5e-5);
  EXPECT_DOUBLE_EQ(of({{1.1, 2.2, 3.300000001}}), 5e-10);
  EXPECT_LT(of({{std::sqrt(2.0), 0, 0}}), 1e-14);
  EXPECT_GT(of({{1e6 * std::sqrt(2.0), 0, 0}}), 1e-10);
  EXPECT_LT(of({{1e-6 * std::sqrt(2.0), 0, 0}}), 1e-16);
}

}  // namespace
}  // namespace fusebench
