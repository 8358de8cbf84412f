// Rolling-shutter frames rendered exactly, row by row, against the global-shutter render of the same instant.
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"
#include "core/config/config.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#include "core/config/variants.hpp"
#include "core/estimator/model/meshing/marching_cubes.hpp"
#include "core/recording_estimator.hpp"
#include "tests/support/rolling_shutter.hpp"
#include "tests/support/simulated_run.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace preprocessing;
using namespace meshing;
using namespace health;
using namespace core;

namespace {

using testing::render_rolling;
using testing::small_camera;
using testing::TexturedRoom;

const SE3 kTRoomCamera{so3_exp({0.05, -0.08, 0.03}), {0.1, -0.1, -0.4}};
/// A Kinect's order of magnitude, each value different so that none can stand in for another.
const SensorTiming kTiming{.color_readout_s = 0.026, .depth_readout_s = 0.021, .depth_delay_s = 0.012};

RgbdFrame rolling_frame(const CameraVelocity& velocity, const SensorTiming& timing) {
  return render_rolling(TexturedRoom{}, small_camera(), timing, [&](double after_s) {
    return kTRoomCamera * SE3{so3_exp(after_s * velocity.angular_radps), after_s * velocity.linear_mps};
  });
}

const RgbdFrame& global_frame() {
  static const RgbdFrame frame = TexturedRoom{}.render(small_camera(), kTRoomCamera, 0);
  return frame;
}

RgbdFrame compensated(const RgbdFrame& frame, const CameraVelocity& velocity, const SensorTiming& timing,
                      int threads = 2) {
  RgbdFrame result;
  const Workers workers(threads);
  compensate_motion(frame, small_camera(), frame_timing(frame, timing), velocity, workers, result);
  compensate_color(frame, small_camera(), frame_timing(frame, timing), velocity, result.depth_m, workers,
                   result.color);
  return result;
}

/// Within `radius_px` of a depth step the true view contains surfaces that the frame never saw.
bool near_depth_edge(const DepthImage& depth_m, int x, int y, int radius_px) {
  float least = depth_m(x, y);
  float most = least;
  for (int v = std::max(y - radius_px, 0); v <= std::min(y + radius_px, depth_m.height - 1); ++v) {
    for (int u = std::max(x - radius_px, 0); u <= std::min(x + radius_px, depth_m.width - 1); ++u) {
      least = std::min(least, depth_m(u, v));
      most = std::max(most, depth_m(u, v));
    }
  }
  return most - least > 0.15F;
}

/// Three different channels, of the grey levels.
void color_in(RgbdFrame& frame) {
  for (std::size_t i = 0; i < frame.color.data.size(); ++i) {
    const std::uint8_t grey = frame.grey.data[i];
    frame.color.data[i] = {grey, static_cast<std::uint8_t>(255 - grey), static_cast<std::uint8_t>(grey / 2)};
  }
}

/// Mean difference of colours from the grey levels, where there is depth.
double color_difference(const RgbdFrame& frame) {
  RgbdFrame expected = frame;
  color_in(expected);
  double sum = 0;
  int pixels = 0;
  for (std::size_t i = 0; i < frame.color.data.size(); ++i) {
    if (!(frame.depth_m.data[i] > 0.0F)) continue;
    for (std::size_t channel = 0; channel < 3; ++channel)
      sum += std::abs(frame.color.data[i][channel] - expected.color.data[i][channel]);
    ++pixels;
  }
  return sum / (3 * pixels);
}

/// Mean absolute differences from the global-shutter frame, over pixels with depth in `mask` and away from
/// depth edges, and how many these are.
struct Difference {
  double grey = 0;
  double depth_m = 0;
  int pixels = 0;
};

Difference difference_from_truth(const RgbdFrame& frame, const DepthImage& mask) {
  Difference sum;
  const RgbdFrame& truth = global_frame();
  for (int y = 0; y < truth.grey.height; ++y) {
    for (int x = 0; x < truth.grey.width; ++x) {
      if (mask(x, y) == 0.0F || near_depth_edge(truth.depth_m, x, y, 4)) continue;
      sum.grey += std::abs(frame.grey(x, y) - truth.grey(x, y));
      sum.depth_m += std::abs(frame.depth_m(x, y) - truth.depth_m(x, y));
      ++sum.pixels;
    }
  }
  return {sum.grey / sum.pixels, sum.depth_m / sum.pixels, sum.pixels};
}

/// A motion, and which share of the errors may be left. What is left is the rounding to whole grey levels
/// (0.2 on average, whatever the motion) and depth of the nearest pixel (half a pixel of the surfaces'
/// slope): small against what a turn does, and less so against a translation of few pixels.
struct Motion {
  const char* name;
  CameraVelocity velocity;
  double grey_share;
  double depth_share;
};

class RollingShutter : public ::testing::TestWithParam<Motion> {};

TEST_P(RollingShutter, IsCompensated) {
  const CameraVelocity& velocity = GetParam().velocity;
  RgbdFrame before = rolling_frame(velocity, kTiming);
  color_in(before);
  const RgbdFrame after = compensated(before, velocity, kTiming);
  const Difference wrong = difference_from_truth(before, after.depth_m);
  const Difference left = difference_from_truth(after, after.depth_m);
  RecordProperty("grey_before", std::to_string(wrong.grey));
  RecordProperty("grey_after", std::to_string(left.grey));
  RecordProperty("depth_before_m", std::to_string(wrong.depth_m));
  RecordProperty("depth_after_m", std::to_string(left.depth_m));
  EXPECT_GT(left.pixels, 40000) << "most of the image survives";
  EXPECT_LT(left.grey, GetParam().grey_share * wrong.grey);
  EXPECT_LT(left.depth_m, GetParam().depth_share * wrong.depth_m);
  EXPECT_LT(left.grey, 0.25);
  EXPECT_LT(left.depth_m, 0.0012);
  EXPECT_EQ(after.depth_offset_ns, 0);
  // Every channel goes where grey goes; what is left is rounding, of each by itself.
  RecordProperty("color_from_grey", std::to_string(color_difference(after)));
  EXPECT_LT(color_difference(after), 0.1);
}

TEST_P(RollingShutter, WithTheOppositeVelocityGetsWorse) {
  const CameraVelocity& velocity = GetParam().velocity;
  const RgbdFrame before = rolling_frame(velocity, kTiming);
  const RgbdFrame after = compensated(before, {-velocity.angular_radps, -velocity.linear_mps}, kTiming);
  EXPECT_GT(difference_from_truth(after, after.depth_m).grey,
            1.3 * difference_from_truth(before, after.depth_m).grey);
}

INSTANTIATE_TEST_SUITE_P(Motions, RollingShutter,
                         ::testing::Values(Motion{"pan", {{0, 2, 0}, {0, 0, 0}}, 0.04, 0.03},
                                           Motion{"pitch", {{2, 0, 0}, {0, 0, 0}}, 0.05, 0.08},
                                           Motion{"roll", {{0, 0, 2}, {0, 0, 0}}, 0.1, 0.3},
                                           Motion{"sideways", {{0, 0, 0}, {1, 0, 0}}, 0.2, 0.3},
                                           Motion{"upwards", {{0, 0, 0}, {0, -1, 0}}, 0.2, 0.4},
                                           Motion{"forwards", {{0, 0, 0}, {0, 0, 1}}, 0.3, 0.12},
                                           Motion{"all", {{-1.2, 1.5, 0.8}, {0.5, -0.4, 0.6}}, 0.04, 0.04}),
                         [](const auto& test) { return test.param.name; });

TEST(MotionCompensation, APanLosesTheColumnsThatLeftTheViewAndNoOthers) {
  const CameraVelocity pan{{0, 2, 0}, Vector3d::Zero()};
  const SensorTiming timing{.color_readout_s = 0.026, .depth_readout_s = 0.026};
  const RgbdFrame after = compensated(rolling_frame(pan, timing), pan, timing);
  // Row 20 was read 10.8 ms early, 21.6 mrad to the left: 5.2 px on the optical axis, and 1 + tan^2 of that
  // at the border of a 67 degree view.
  const auto lost = [&](int first, int last) {
    int count = 0;
    for (int x = first; x <= last; ++x) count += after.depth_m(x, 20) == 0.0F ? 1 : 0;
    return count;
  };
  EXPECT_EQ(lost(0, 300), 0);
  EXPECT_NEAR(lost(301, 319), 5.2 * 1.44, 1.0);
}

TEST(MotionCompensation, WithoutMotionOrWithoutTimingItIsTheIdentity) {
  const CameraVelocity moving{{1, -2, 0.5}, {1, 0.3, -0.6}};
  const RgbdFrame rolling = rolling_frame(moving, kTiming);
  const RgbdFrame still = compensated(rolling, {}, kTiming);
  EXPECT_EQ(still.color.data, rolling.color.data);
  EXPECT_EQ(still.grey.data, rolling.grey.data);
  EXPECT_EQ(still.depth_m.data, rolling.depth_m.data);

  const RgbdFrame instant = compensated(global_frame(), moving, {});
  EXPECT_EQ(instant.color.data, global_frame().color.data);
  EXPECT_EQ(instant.grey.data, global_frame().grey.data);
  EXPECT_EQ(instant.depth_m.data, global_frame().depth_m.data);
}

TEST(MotionCompensation, MissingDepthStaysMissingAndItsColourTurnsAsIfFarAway) {
  const CameraVelocity pan{{0, 2, 0}, Vector3d::Zero()};
  RgbdFrame frame = rolling_frame(pan, kTiming);
  const RgbdFrame with_depth = compensated(frame, pan, kTiming);
  std::fill(frame.depth_m.data.begin(), frame.depth_m.data.end(), 0.0F);
  const RgbdFrame without = compensated(frame, pan, kTiming);
  EXPECT_TRUE(std::all_of(without.depth_m.data.begin(), without.depth_m.data.end(),
                          [](float depth_m) { return depth_m == 0.0F; }));
  // A rotation moves pixels whatever their depth.
  EXPECT_EQ(without.grey.data, with_depth.grey.data);
}

// Sizes that fit no vector, tile or cell, and velocities of an estimate that has diverged.
TEST(MotionCompensation, AnySizeAndVelocityStaysInsideTheImage) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::array<Vector3d, 4> values = {Vector3d(0, 0, 0), Vector3d(0.5, -2, 1),
                                          Vector3d(1e30, -1e30, 1e30), Vector3d(nan, nan, nan)};
  for (const auto& [width, height] : {std::pair{8, 2}, {9, 3}, {65, 17}, {71, 49}}) {
    const PinholeCamera camera{width, height, 60, 60, 0.5 * width, 0.5 * height};
    RgbdFrame frame;
    frame.grey = GreyImage(width, height);
    frame.depth_m = DepthImage(width, height, 1.5F);
    frame.color = ColorImage(width, height);
    for (std::size_t i = 0; i < frame.grey.data.size(); ++i) {
      frame.grey.data[i] = static_cast<std::uint8_t>(i % 256);
      frame.color.data[i] = {frame.grey.data[i], 7, 9};
      // None, or nearer than any camera measures.
      if (i % 5 == 0) frame.depth_m.data[i] = i % 2 == 0 ? 0.0F : 1e-4F;
    }
    for (const Vector3d& turn_radps : values) {
      for (const Vector3d& move_mps : values) {
        const CameraVelocity velocity{turn_radps, move_mps};
        const Workers workers(1);
        RgbdFrame result;
        compensate_motion(frame, camera, frame_timing(frame, kTiming), velocity, workers, result);
        compensate_color(frame, camera, frame_timing(frame, kTiming), velocity, result.depth_m, workers,
                         result.color);
        ASSERT_EQ(result.grey.data.size(), frame.grey.data.size());
        ASSERT_EQ(result.color.data.size(), frame.color.data.size());
        for (const float depth_m : result.depth_m.data) ASSERT_TRUE(depth_m >= 0.0F) << width;
        if (!turn_radps.isZero() || !move_mps.isZero()) continue;
        EXPECT_EQ(result.grey.data, frame.grey.data);
        EXPECT_EQ(result.depth_m.data, frame.depth_m.data);
        EXPECT_EQ(result.color.data, frame.color.data);
      }
    }
  }
}

TEST(MotionCompensation, ThreadCountDoesNotShow) {
  const CameraVelocity velocity{{-1.2, 1.5, 0.8}, {0.5, -0.4, 0.6}};
  const RgbdFrame frame = rolling_frame(velocity, kTiming);
  const RgbdFrame one = compensated(frame, velocity, kTiming, 1);
  for (const int threads : {2, 8}) {
    const RgbdFrame many = compensated(frame, velocity, kTiming, threads);
    EXPECT_EQ(one.color.data, many.color.data) << threads << " threads";
    EXPECT_EQ(one.grey.data, many.grey.data) << threads << " threads";
    EXPECT_EQ(one.depth_m.data, many.depth_m.data) << threads << " threads";
  }
}

TEST(MotionCompensation, IsNeededIfAnythingIsReadAtAnotherTime) {
  RgbdFrame together;
  RgbdFrame apart;
  apart.depth_offset_ns = -1;
  EXPECT_TRUE(frame_timing(together, {}).is_one_instant());
  EXPECT_FALSE(frame_timing(together, {.color_readout_s = 0.02}).is_one_instant());
  EXPECT_FALSE(frame_timing(together, {.depth_readout_s = 0.02}).is_one_instant());
  EXPECT_FALSE(frame_timing(apart, {}).is_one_instant());
  // Readers have added the delay to the offset, so by itself it has no effect.
  EXPECT_TRUE(frame_timing(together, {.depth_delay_s = 0.02}).is_one_instant());
}

/// Largest angle between an estimated orientation and the ground truth.
double worst_angle_rad(const testing::SimulatedRun& run, const std::vector<FrameReport>& reports) {
  double worst = 0;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    worst = std::max(worst,
                     rotation_angle_rad(reports[k].T_world_camera.rotation, run.T_first_camera[k].rotation));
  }
  return worst;
}

TEST(MotionCompensation, MakesFastMotionTrackableThroughARollingShutter) {
  // 2 rad/s: 12 pixels of shear in this small image. A shear looks like a turn above all; what it does to the
  // position depends on the axis, and is little without an IMU, where the map drifts as much by itself.
  const std::array<Vector3d, 6> turns_radps = {Vector3d(0.5, 1.8, -0.7), Vector3d(0.5, -1.8, -0.7),
                                               Vector3d(1.8, 0.5, -0.7), Vector3d(-1.2, 1.2, 0.9),
                                               Vector3d(0.7, 1.7, 0.9),  Vector3d(1.8, -0.9, -1.0)};
  struct Row {
    const char* variant;
    double largest_error_m;
    double largest_angle_rad;
    double share_m;  ///< of the errors without compensation
  };
  for (const Row& row : {Row{"full", 0.005, 0.003, 0.75}, Row{"no-imu", 0.015, 0.005, 1.5}}) {
    Config with = variant_config(*find_variant(row.variant)).values();
    with.terms.motion_compensation = true;
    Config without = with;
    without.terms.motion_compensation = false;
    double sum_with_m = 0, sum_without_m = 0, sum_with_rad = 0, sum_without_rad = 0;
    for (const Vector3d& turn_radps : turns_radps) {
      const testing::SimulatedRun run = testing::simulate(10, kTiming, turn_radps);
      const auto tracked = testing::track(run, with, 2);
      const auto sheared = testing::track(run, without, 2);
      EXPECT_LT(testing::worst_error_m(run, tracked), row.largest_error_m)
          << row.variant << ", " << turn_radps.transpose();
      EXPECT_LT(worst_angle_rad(run, tracked), row.largest_angle_rad)
          << row.variant << ", " << turn_radps.transpose();
      sum_with_m += testing::worst_error_m(run, tracked);
      sum_without_m += testing::worst_error_m(run, sheared);
      sum_with_rad += worst_angle_rad(run, tracked);
      sum_without_rad += worst_angle_rad(run, sheared);
    }
    EXPECT_LT(sum_with_m, row.share_m * sum_without_m) << row.variant;
    EXPECT_LT(sum_with_rad, 0.15 * sum_without_rad) << row.variant;
  }
}

TEST(MotionCompensation, FramesAreFusedWithTheirOwnColour) {
  // Frames of one colour each: whatever the motion, what all of them saw has their mean.
  testing::SimulatedRun run = testing::simulate(3, kTiming, {0.5, 1.8, -0.7});
  const std::array<Rgb, 3> colors = {Rgb{200, 30, 90}, Rgb{10, 220, 40}, Rgb{70, 80, 250}};
  for (std::size_t k = 0; k < run.frames.size(); ++k)
    run.frames[k].color = ColorImage(run.frames[k].grey.width, run.frames[k].grey.height, colors[k]);
  const Workers workers(1);
  RecordingEstimator pipeline(variant_config(*find_variant("full")).values(), run.rig, run.imu, workers);
  for (const RgbdFrame& frame : run.frames) ASSERT_TRUE(pipeline.process(frame).has_value());
  const Mesh mesh = extract_mesh(pipeline.model(), 0.0, workers);
  ASSERT_FALSE(mesh.colors.empty());
  const auto is_mean = [&](const Rgb& color) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const int mean = (colors[0][channel] + colors[1][channel] + colors[2][channel]) / 3;
      if (std::abs(color[channel] - mean) > 2) return false;
    }
    return true;
  };
  const auto means = std::count_if(mesh.colors.begin(), mesh.colors.end(), is_mean);
  EXPECT_GT(static_cast<double>(means), 0.5 * static_cast<double>(mesh.colors.size()));
}

}  // namespace
}  // namespace fusebench
