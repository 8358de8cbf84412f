#include "datasets/simulator/motion/motion.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "datasets/simulator/motion/motion_file.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/simulator/scene/room.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace synthetic_imu;
using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::motion;

namespace {

constexpr std::array kPresets = {MotionPreset::slow, MotionPreset::fast, MotionPreset::shake};
constexpr std::int64_t kStep_ns = 1'000'000;
const Eigen::AlignedBox3d kBox(Vector3d(-1.0, -0.9, 0.9), Vector3d(1.1, 0.8, 1.6));

MotionSpan span_of(double duration_s) {
  return {5'000'000, 755'000'000, 755'000'000 + std::llround(1e9 * duration_s)};
}

MotionOptions options_of(MotionPreset preset, bool from_rest) {
  MotionOptions options = motion_preset(preset);
  options.from_rest = from_rest;
  return options;
}

/// The largest speeds, sampled more finely than the generator does.
PeakSpeeds measured_peaks(const PoseSpline& motion, const MotionSpan& span) {
  PeakSpeeds peaks;
  for (std::int64_t t = span.first_frame_ns; t <= span.last_frame_ns; t += kStep_ns) {
    const Kinematics k = motion.evaluate(t);
    peaks.speed_mps = std::max(peaks.speed_mps, k.velocity_world_mps.norm());
    peaks.rate_radps = std::max(peaks.rate_radps, k.angular_velocity_body_radps.norm());
  }
  return peaks;
}

/// Runs the check for all presets, both beginnings and several seeds.
template <class Check>
void for_all_motions(const Check& check) {
  const MotionSpan span = span_of(8);
  for (const MotionPreset preset : kPresets) {
    for (const bool from_rest : {true, false}) {
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE(::testing::Message() << to_string(preset) << " rest " << from_rest << " seed " << seed);
        const MotionOptions options = options_of(preset, from_rest);
        const auto motion = hand_held_motion(options, span, kBox, seed);
        ASSERT_TRUE(motion) << motion.error().message;
        check(options, *motion, span);
      }
    }
  }
}

TEST(HandHeldMotion, ReachesItsPeakSpeedsAndNoMore) {
  for_all_motions([](const MotionOptions& options, const PoseSpline& motion, const MotionSpan& span) {
    const PeakSpeeds peaks = measured_peaks(motion, span);
    EXPECT_NEAR(peaks.speed_mps / options.peak_speed_mps, 1, 0.01);
    EXPECT_NEAR(peaks.rate_radps / options.peak_rate_radps, 1, 0.01);
  });
}

TEST(HandHeldMotion, ReportsTheReachedPeaksOnFailure) {
  MotionOptions options = options_of(MotionPreset::slow, false);
  options.peak_speed_mps = 0.01;
  options.tremor_m = 0.005;  // moves faster than that on its own
  const auto motion = hand_held_motion(options, span_of(8), kBox, 1);
  ASSERT_FALSE(motion);
  EXPECT_EQ(motion.error().code, ErrorCode::configuration);
  EXPECT_NE(motion.error().message.find("peak_speed_mps = 0.01"), std::string::npos);
  EXPECT_NE(motion.error().message.find("were reached"), std::string::npos) << motion.error().message;
}

TEST(HandHeldMotion, StaysInTheBoxAndUpright) {
  for_all_motions([](const MotionOptions&, const PoseSpline& motion, const MotionSpan& span) {
    for (std::int64_t t = span.begin_ns; t <= span.last_frame_ns; t += 10 * kStep_ns) {
      const SE3 pose = motion.evaluate(t).T_world_body;
      ASSERT_LT(kBox.exteriorDistance(pose.translation), 1e-9) << t;
      const Vector3d right_world = pose.rotation * Vector3d::UnitX();
      const Vector3d down_world = pose.rotation * Vector3d::UnitY();
      const Vector3d forward_world = pose.rotation * Vector3d::UnitZ();
      ASSERT_LT(down_world.z(), 0) << t;
      ASSERT_LT(std::abs(std::asin(forward_world.z())), radians(45)) << t;
      ASSERT_LT(std::abs(std::asin(right_world.z())), radians(35)) << t;
    }
  });
}

TEST(HandHeldMotion, FromRestIsStillForASecondAndThenMoves) {
  for_all_motions([](const MotionOptions& options, const PoseSpline& motion, const MotionSpan& span) {
    if (!options.from_rest) return;
    const SE3 first = motion.evaluate(span.begin_ns).T_world_body;
    // One knot spacing before the start, the spline begins to look ahead.
    const std::int64_t rest_end_ns = span.first_frame_ns + 960'000'000;
    for (std::int64_t t = span.begin_ns; t < rest_end_ns; t += 7 * kStep_ns) {
      const Kinematics k = motion.evaluate(t);
      ASSERT_LT(k.velocity_world_mps.norm(), 1e-12) << t;
      ASSERT_LT(k.acceleration_world_mps2.norm(), 1e-9) << t;
      ASSERT_LT(k.angular_velocity_body_radps.norm(), 1e-12) << t;
      ASSERT_LT((k.T_world_body.translation - first.translation).norm(), 1e-12) << t;
    }
    // No jerk that a hand cannot do: half-way through the start the acceleration has not exceeded that of
    // full motion.
    const Kinematics started = motion.evaluate(span.first_frame_ns + 2'200'000'000);
    EXPECT_GT(started.velocity_world_mps.norm() + started.angular_velocity_body_radps.norm(), 0.02);
  });
}

TEST(HandHeldMotion, FromRestTakesTwoSecondsLessAFrame) {
  const MotionOptions options = options_of(MotionPreset::slow, true);
  const auto whole = hand_held_motion(options, span_of(2 - 1.0 / 30), kBox, 1);
  EXPECT_TRUE(whole) << whole.error().message;
  const auto brief = hand_held_motion(options, span_of(1.5), kBox, 1);
  ASSERT_FALSE(brief);
  EXPECT_EQ(brief.error().code, ErrorCode::configuration);
  EXPECT_EQ(brief.error().hint, "--duration 2 or more, or --in-motion to begin in full motion");
}

TEST(HandHeldMotion, InMotionMovesFromTheFirstFrame) {
  for_all_motions([](const MotionOptions& options, const PoseSpline& motion, const MotionSpan& span) {
    if (options.from_rest) return;
    const Kinematics first = motion.evaluate(span.first_frame_ns);
    EXPECT_GT(first.velocity_world_mps.norm(), 0.25 * options.peak_speed_mps);
    EXPECT_GT(first.angular_velocity_body_radps.norm(), 0.25 * options.peak_rate_radps);
  });
}

TEST(HandHeldMotion, DerivativesAreThoseOfThePoseAndContinuous) {
  for_all_motions([](const MotionOptions&, const PoseSpline& motion, const MotionSpan& span) {
    constexpr std::int64_t kHalf_ns = 50'000;
    constexpr double kWhole_s = 1e-4;
    double largest_jump = 0;
    for (std::int64_t t = span.begin_ns + kStep_ns; t < span.last_frame_ns; t += 23 * kStep_ns) {
      const Kinematics before = motion.evaluate(t - kHalf_ns);
      const Kinematics here = motion.evaluate(t);
      const Kinematics after = motion.evaluate(t + kHalf_ns);
      const Vector3d velocity = (after.T_world_body.translation - before.T_world_body.translation) / kWhole_s;
      const Vector3d acceleration = (after.velocity_world_mps - before.velocity_world_mps) / kWhole_s;
      const Vector3d rate =
          so3_log(before.T_world_body.rotation.conjugate() * after.T_world_body.rotation) / kWhole_s;
      ASSERT_LT((velocity - here.velocity_world_mps).norm(), 1e-5) << t;
      ASSERT_LT((acceleration - here.acceleration_world_mps2).norm(), 0.05) << t;
      ASSERT_LT((rate - here.angular_velocity_body_radps).norm(), 1e-4) << t;
      largest_jump =
          std::max(largest_jump, (after.acceleration_world_mps2 - before.acceleration_world_mps2).norm());
    }
    EXPECT_LT(largest_jump, 0.1);  // 0.1 ms apart: a jump would be of the order of the acceleration itself
  });
}

TEST(HandHeldMotion, SeedsDecide) {
  const MotionSpan span = span_of(4);
  const MotionOptions options = options_of(MotionPreset::fast, false);
  const auto a = hand_held_motion(options, span, kBox, 1);
  const auto again = hand_held_motion(options, span, kBox, 1);
  const auto b = hand_held_motion(options, span, kBox, 2);
  ASSERT_TRUE(a && again && b);
  EXPECT_EQ(a->position_world_m, again->position_world_m);
  double difference_m = 0;
  for (std::size_t i = 0; i < a->position_world_m.size(); ++i) {
    difference_m = std::max(difference_m, (a->position_world_m[i] - b->position_world_m[i]).norm());
  }
  EXPECT_GT(difference_m, 0.2);
}

TEST(HandHeldMotion, ShakesAtItsFrequency) {
  // Zero crossings of the acceleration about its mean: two a period.
  const MotionSpan span = span_of(10);
  const auto motion = hand_held_motion(options_of(MotionPreset::shake, false), span, kBox, 3);
  ASSERT_TRUE(motion);
  int crossings = 0;
  double last = 0;
  for (std::int64_t t = span.first_frame_ns; t <= span.last_frame_ns; t += 5 * kStep_ns) {
    const double x = motion->evaluate(t).acceleration_world_mps2.x();
    if (x * last < 0) ++crossings;
    last = x;
  }
  EXPECT_GT(crossings / 20.0, 2);
  EXPECT_LT(crossings / 20.0, 4.5);
}

TEST(HandHeldMotion, ErrorsNameTheOption) {
  MotionOptions options = options_of(MotionPreset::fast, false);
  const Eigen::AlignedBox3d tiny(Vector3d(0, 0, 1), Vector3d(1e-4, 1e-4, 1.0001));
  const auto cramped = hand_held_motion(options, span_of(4), tiny, 1);
  ASSERT_FALSE(cramped);
  EXPECT_EQ(cramped.error().code, ErrorCode::configuration);
  EXPECT_NE(cramped.error().message.find("peak_speed_mps"), std::string::npos) << cramped.error().message;
  options.from_rest = true;
  const auto brief = hand_held_motion(options, span_of(1.5), kBox, 1);
  ASSERT_FALSE(brief);
  EXPECT_NE(brief.error().message.find("duration_s"), std::string::npos) << brief.error().message;
  options.peak_rate_radps = -1;
  const auto negative = hand_held_motion(options, span_of(4), kBox, 1);
  ASSERT_FALSE(negative);
  EXPECT_NE(negative.error().message.find("peak_rate_radps"), std::string::npos) << negative.error().message;
}

TEST(BodyMotion, CarriesTheCamera) {
  const SE3 T_body_camera{so3_exp({0.3, -1.2, 0.8}), {0.094, 0.003, -0.02}};
  const MotionSpan span = span_of(6);
  const auto camera = hand_held_motion(options_of(MotionPreset::fast, false), span, kBox, 4);
  ASSERT_TRUE(camera);
  const PoseSpline body = body_motion(*camera, T_body_camera);
  for (std::int64_t t = span.begin_ns; t < span.last_frame_ns; t += 11 * kStep_ns) {
    const Kinematics c = camera->evaluate(t);
    const Kinematics b = body.evaluate(t);
    const SE3 carried = b.T_world_body * T_body_camera;
    EXPECT_LT((carried.translation - c.T_world_body.translation).norm(), 2e-4);
    EXPECT_LT(rotation_angle_rad(carried.rotation, c.T_world_body.rotation), 1e-12);
    EXPECT_LT(
        (T_body_camera.rotation.conjugate() * b.angular_velocity_body_radps - c.angular_velocity_body_radps)
            .norm(),
        1e-12);
  }
  const PeakSpeeds peaks = peak_speeds(body, T_body_camera, span.first_frame_ns, span.last_frame_ns);
  EXPECT_NEAR(peaks.speed_mps, 2.0, 0.02);
  EXPECT_NEAR(peaks.rate_radps, 3.0, 0.03);
}

TEST(PathClock, StandsStartsAndRuns) {
  const PathClock clock{1.5, 2.0, 3.0, 0.25};
  EXPECT_EQ(clock.path_s(-1), 0.25);
  EXPECT_EQ(clock.path_s(1.5), 0.25);
  EXPECT_NEAR(clock.path_s(3.5), 0.25 + 3, 1e-12);  // the start covers half of its time
  EXPECT_NEAR(clock.path_s(4.5) - clock.path_s(3.5), 3, 1e-12);
  for (double t = 0; t < 5; t += 0.01) EXPECT_GE(clock.path_s(t + 0.01), clock.path_s(t));
}

TEST(HandHeldMotion, KeepsItsDistanceInTheFurnishedRoom) {
  const Workers workers(1);
  const SimulatedScene room = make_room(1);
  const Renderer renderer(room);
  const PinholeCamera camera{32, 24, 30, 30, 15.5, 11.5};
  const MotionSpan span = span_of(8);
  for (const MotionPreset preset : kPresets) {
    const auto motion = hand_held_motion(options_of(preset, false), span, room.free_space, 1);
    ASSERT_TRUE(motion) << motion.error().message;
    std::vector<float> depths;
    Image<Renderer::Surface> surfaces;
    for (std::int64_t t = span.first_frame_ns; t < span.last_frame_ns; t += 200'000'000) {
      renderer.render_surfaces(camera, {{motion->evaluate(t).T_world_body}}, workers, surfaces);
      for (const Renderer::Surface& surface : surfaces.data) depths.push_back(surface.depth_m);
    }
    std::ranges::sort(depths);
    EXPECT_GT(depths.front(), 0.5F) << to_string(preset);
    EXPECT_GT(depths[depths.size() / 2], 1.0F) << to_string(preset);
    EXPECT_LT(depths[depths.size() / 2], 3.5F) << to_string(preset);
  }
}

TEST(HeadingTexture, TurnsAMotionToWhereTheTextureIs) {
  HeadingTexture texture;
  // Nothing between 90 and 180 degrees: a camera that sweeps must keep away from there.
  for (std::size_t i = 0; i < texture.share.size(); ++i) texture.share[i] = i >= 6 && i <= 12 ? 0 : 0.8;
  EXPECT_NEAR(texture.at(0), 0.8, 1e-12);
  EXPECT_NEAR(texture.at(radians(-360 + 135)), 0, 1e-12);
  EXPECT_NEAR(texture.at(radians(82.5)), 0.4, 1e-12);  // half-way to the first blank one
  const MotionSpan span = span_of(8);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto motion = hand_held_motion(options_of(MotionPreset::slow, false), span, kBox, seed, texture);
    ASSERT_TRUE(motion);
    int blank = 0;
    int count = 0;
    for (std::int64_t t = span.first_frame_ns; t < span.last_frame_ns; t += 50'000'000) {
      const Vector3d forward = motion->evaluate(t).T_world_body.rotation * Vector3d::UnitZ();
      if (texture.at(std::atan2(forward.y(), forward.x())) < 0.1) ++blank;
      ++count;
    }
    EXPECT_EQ(blank, 0) << seed << " of " << count;
  }
}

TEST(HeadingTexture, LookingAroundFindsThePlainWall) {
  const Workers workers(1);
  const SimulatedScene room = make_room(1);
  const HeadingTexture texture = look_around(Renderer(room), room.free_space, workers);
  const auto [least, most] = std::ranges::minmax(texture.share);
  EXPECT_LT(least, 0.3);
  EXPECT_GT(most, 0.6);
}

class MotionFile : public testing::InTemporaryFolder {
 protected:
  /// A camera with motion along and about all axes: right-handed, world z up.
  static SE3 pose_at(double t) {
    const Quaterniond level((Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished());
    return {(level * so3_exp({0.2 * std::sin(t), 0.4 * std::sin(0.7 * t), 0.1 * t})).normalized(),
            {0.3 * std::sin(0.9 * t), 0.2 * std::cos(t), 1.2 + 0.1 * std::sin(1.3 * t)}};
  }
  static constexpr int kPoses = 240;

  /// The same path in the convention of ICL-NUIM's renderer: y up and left-handed, matrices instead of
  /// quaternions.
  static Eigen::Matrix4d icl_pose(int k) {
    Eigen::Matrix4d upright = Eigen::Matrix4d::Identity();  // z up to y up (right-handed: z backwards)
    upright.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    Eigen::Matrix4d camera = Eigen::Matrix4d::Identity();
    const SE3 pose = pose_at(k / 30.0);
    camera.topLeftCorner<3, 3>() = pose.rotation_matrix();
    camera.topRightCorner<3, 1>() = pose.translation;
    const Eigen::Matrix4d flip_world =
        Eigen::Vector4d(1, 1, -1, 1).asDiagonal();  // to left-handed, y stays up
    const Eigen::Matrix4d flip_camera = Eigen::Vector4d(1, -1, 1, 1).asDiagonal();  // y down to y up
    return flip_world * upright * camera * flip_camera;
  }

  static void expect_path(const FilePath& path) {
    ASSERT_EQ(path.poses.size(), static_cast<std::size_t>(kPoses));
    EXPECT_NEAR(path.length_s(), (kPoses - 1) / 30.0, 1e-6);
    const SE3 first = path.poses.front().T_world_camera;
    for (int k = 0; k < kPoses; ++k) {
      const StampedPose& read = path.poses[static_cast<std::size_t>(k)];
      EXPECT_NEAR(seconds_between(0, read.timestamp_ns), k / 30.0, 1e-6);
      const SE3 relative = first.inverse() * read.T_world_camera;
      const SE3 truth = pose_at(0).inverse() * pose_at(k / 30.0);
      ASSERT_LT((relative.translation - truth.translation).norm(), 1e-6) << k;
      ASSERT_LT(rotation_angle_rad(relative.rotation, truth.rotation), 1e-6) << k;
      // Up is up: heights, not only shapes.
      ASSERT_NEAR(read.T_world_camera.translation.z() - first.translation.z(),
                  pose_at(k / 30.0).translation.z() - pose_at(0).translation.z(), 1e-6);
    }
  }
};

TEST_F(MotionFile, ThreeKindsOfFilesGiveTheSamePath) {
  std::string tum = "# timestamp tx ty tz qx qy qz qw\n";
  std::string matrices = "# index c2w\n";
  std::string freiburg;
  for (int k = 0; k < kPoses; ++k) {
    const SE3 pose = pose_at(k / 30.0);
    const Vector3d& t = pose.translation;
    const Quaterniond& q = pose.rotation;
    tum += fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", 77 + k / 30.0, t.x(),
                       t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
    const Eigen::Matrix4d m = icl_pose(k);
    const Quaterniond p(Matrix3d(m.topLeftCorner<3, 3>()));
    ASSERT_NEAR(m.topLeftCorner(3, 3).determinant(), 1, 1e-9);
    matrices += fmt::format("{}", k);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) matrices += fmt::format(" {:.9f}", m(r, c));
    }
    matrices += "\n";
    freiburg += fmt::format("{} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", k + 1, m(0, 3), m(1, 3),
                            m(2, 3), p.x(), p.y(), p.z(), p.w());
  }
  for (const auto& file :
       {write("path.txt", tum), write("camera.txt", matrices), write("lr.gt.freiburg", freiburg)}) {
    SCOPED_TRACE(file.string());
    const auto path = read_file_path(file);
    ASSERT_TRUE(path) << path.error().message;
    expect_path(*path);
  }
}

TEST_F(MotionFile, DrivesFasterAndShrinksIntoTheBox) {
  FilePath path;
  for (int k = 0; k < 600; ++k) path.poses.push_back({std::llround(k / 30.0 * 1e9), pose_at(k / 30.0)});
  const MotionSpan span = span_of(4);
  FileMotionOptions options;
  const Eigen::AlignedBox3d wide(Vector3d(-5, -5, 0), Vector3d(5, 5, 3));
  const auto once = file_motion(path, options, span, wide);
  options.speed = 2;
  const auto twice = file_motion(path, options, span, wide);
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(once->shrunk, 1);
  // At twice the speed, the same pose at half the time.
  const auto pose = [&](const FileMotion& motion, std::int64_t after_ns) {
    const std::int64_t begin = span.begin_ns;
    return motion.camera.evaluate(begin).T_world_body.inverse() *
           motion.camera.evaluate(begin + after_ns).T_world_body;
  };
  for (std::int64_t after = 100'000'000; after < 2'000'000'000; after += 100'000'000) {
    EXPECT_LT((pose(*once, 2 * after).translation - pose(*twice, after).translation).norm(), 1e-3);
    EXPECT_NEAR(twice->camera.evaluate(span.begin_ns + after).velocity_world_mps.norm(),
                2 * once->camera.evaluate(span.begin_ns + 2 * after).velocity_world_mps.norm(), 5e-3);
  }
  const Eigen::AlignedBox3d small(Vector3d(1, 1, 1), Vector3d(1.2, 1.2, 1.3));
  const auto shrunk = file_motion(path, options, span, small);
  ASSERT_TRUE(shrunk);
  EXPECT_LT(shrunk->shrunk, 1);
  for (std::int64_t t = span.begin_ns; t <= span.last_frame_ns; t += 10'000'000) {
    EXPECT_LT(small.exteriorDistance(shrunk->camera.evaluate(t).T_world_body.translation), 1e-9);
  }
  options.from_rest = true;
  const auto rested = file_motion(path, options, span, wide);
  ASSERT_TRUE(rested);
  EXPECT_LT(rested->camera.evaluate(span.first_frame_ns + 900'000'000).velocity_world_mps.norm(), 1e-12);
  EXPECT_GT(rested->camera.evaluate(span.first_frame_ns + 2'500'000'000).velocity_world_mps.norm(), 0.1);
}

TEST_F(MotionFile, ErrorsNameFileAndLine) {
  const auto missing = read_file_path(folder_ / "none.txt");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::data_missing);
  const auto skewed = read_file_path(write("m.txt", "# c2w\n0 1 0 0 0 0 1 0 0 0 0 2 0\n"));
  ASSERT_FALSE(skewed);
  EXPECT_NE(skewed.error().message.find("m.txt:2"), std::string::npos) << skewed.error().message;
  const auto empty = read_file_path(write("e.txt", "# nothing\n"));
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, ErrorCode::data_corrupt);
  const auto wide = read_file_path(write("w.txt", "# c2w\n" + std::string(70'000, '7')));
  ASSERT_FALSE(wide);
  EXPECT_NE(wide.error().message.find("w.txt:2: line is longer than"), std::string::npos)
      << wide.error().message;
  FilePath path;
  for (int k = 0; k < 60; ++k) path.poses.push_back({std::llround(k / 30.0 * 1e9), pose_at(k / 30.0)});
  for (const double speed : {0.0, 1e-9, 1e9, std::nan("")}) {
    FileMotionOptions options;
    options.speed = speed;
    const auto refused = file_motion(path, options, span_of(1), kBox);
    ASSERT_FALSE(refused) << speed;
    EXPECT_EQ(refused.error().code, ErrorCode::configuration);
  }
  const auto longer = file_motion(path, {}, span_of(4), kBox);
  ASSERT_FALSE(longer);
  EXPECT_NE(longer.error().message.find("duration_s"), std::string::npos) << longer.error().message;
}

TEST(MotionFileReal, BothPackingsOfIclNuimGiveTheSamePath) {
  const char* data = std::getenv("FUSEBENCH_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(data == nullptr ? "" : data) / "icl_nuim_trajectories";
  if (data == nullptr || !std::filesystem::exists(folder)) {
    GTEST_SKIP() << "FUSEBENCH_DATA does not name a folder with icl_nuim_trajectories";
  }
  for (const std::string kt : {"0", "2"}) {
    const auto matrices = read_file_path(folder / ("povray_camera_kt" + kt + ".txt"));
    const auto freiburg = read_file_path(folder / ("livingRoom" + kt + ".gt.freiburg.derived"));
    ASSERT_TRUE(matrices) << matrices.error().message;
    ASSERT_TRUE(freiburg) << freiburg.error().message;
    // The published trajectory begins with frame 1.
    const SE3 first_a = matrices->poses[1].T_world_camera;
    const SE3 first_b = freiburg->poses[0].T_world_camera;
    for (std::size_t k = 0; k < freiburg->poses.size(); k += 7) {
      const SE3 a = first_a.inverse() * matrices->poses[k + 1].T_world_camera;
      const SE3 b = first_b.inverse() * freiburg->poses[k].T_world_camera;
      ASSERT_LT((a.translation - b.translation).norm(), 1e-4) << kt << " " << k;
      ASSERT_LT(rotation_angle_rad(a.rotation, b.rotation), 1e-4) << kt << " " << k;
      // A camera that a hand holds: upright.
      ASSERT_LT((matrices->poses[k + 1].T_world_camera.rotation * Vector3d::UnitY()).z(), -0.5);
    }
  }
}

}  // namespace
}  // namespace fusebench
