#include "datasets/simulator/simulation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/open_recording.hpp"
#include "tests/datasets/simulator/box_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace trajectory;
using namespace recording;
using namespace datasets;
using namespace simulator::motion;
using namespace simulator::layouts;
using namespace simulator;

namespace {

namespace fs = std::filesystem;

class Simulation : public testing::InTemporaryFolder {
 protected:
  /// Four small frames, with all noise.
  [[nodiscard]] SimulationOptions small_options(RecordingLayout layout = RecordingLayout::zr300) const {
    SimulationOptions options = simulation_defaults(layout, MotionPreset::fast, {80, 60}).value();
    options.motion.from_rest = false;
    options.duration_s = 4 / 30.0;
    options.blur_samples = 2;
    options.scene_file = box_;
    return options;
  }

  static std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) {
        files[fs::relative(entry.path(), folder).string()] = testing::read_bytes(entry.path());
      }
    }
    return files;
  }

  const Workers one_{1};
  const testing::TemporaryFolder scene_;
  const fs::path box_ = testing::write_box_scene(scene_.path());
};

TEST_F(Simulation, SameOptionsSameBytesWithAnyThreads) {
  for (const RecordingLayout layout : {RecordingLayout::tum, RecordingLayout::icl, RecordingLayout::zr300}) {
    SCOPED_TRACE(to_string(layout));
    const SimulationOptions options = small_options(layout);
    const std::string name(to_string(layout));
    const Workers three(3);
    const auto a = simulate(options, folder_ / (name + "_a"), one_, {});
    const auto b = simulate(options, folder_ / (name + "_b"), three, {});
    ASSERT_TRUE(a) << a.error().message;
    ASSERT_TRUE(b) << b.error().message;
    const auto files_a = files_in(folder_ / (name + "_a"));
    const auto files_b = files_in(folder_ / (name + "_b"));
    EXPECT_GE(files_a.size(), 8U + 5U);
    ASSERT_EQ(files_a.size(), files_b.size());
    for (const auto& [file, bytes] : files_a) EXPECT_TRUE(files_b.at(file) == bytes) << file;
  }
}

TEST_F(Simulation, RoutesGoThroughTheirOwnScenesWithTheSameBytes) {
  SimulationOptions options = small_options(RecordingLayout::tum);
  options.preset = MotionPreset::corridor;
  options.motion = motion_preset(options.preset);
  options.room = room_of(options.preset);
  const auto refused = simulate(options, folder_ / "box", one_, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("preset = corridor"), std::string::npos);
  options.scene_file.clear();
  ASSERT_TRUE(simulate(options, folder_ / "a", one_, {}));
  ASSERT_TRUE(simulate(options, folder_ / "b", Workers(3), {}));
  const auto files_a = files_in(folder_ / "a");
  EXPECT_EQ(files_a, files_in(folder_ / "b"));
  EXPECT_NE(files_a.at("simulation.toml").find("corridor of the seed"), std::string::npos);
}

TEST_F(Simulation, SeedsMakeDifferentRecordings) {
  SimulationOptions options = small_options();
  options.scene_file.clear();  // the room is the seed's, too
  const auto a = simulate(options, folder_ / "a", one_, {});
  options.seed = 2;
  const auto b = simulate(options, folder_ / "b", one_, {});
  ASSERT_TRUE(a && b);
  EXPECT_NE(a->identity, b->identity);
  const auto files_a = files_in(folder_ / "a");
  const auto files_b = files_in(folder_ / "b");
  for (const std::string file :
       {"color/755000.png", "depth/755000.png", "IMU.txt", "groundtruth.txt", "scene.ply"}) {
    ASSERT_TRUE(files_a.contains(file) && files_b.contains(file)) << file;
    EXPECT_FALSE(files_a.at(file) == files_b.at(file)) << file;
  }
}

TEST_F(Simulation, AFolderIsReusedOrLeftAlone) {
  SimulationOptions options = small_options();
  const fs::path out = folder_ / "new" / "recording";
  const auto first = simulate(options, out / "", one_, {});  // with a slash at the end
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_FALSE(first->reused);
  EXPECT_EQ(first->frames, 4U);
  const auto written = fs::last_write_time(out / "IMU.txt");
  const auto again = simulate(options, out, one_, {});
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->reused);
  EXPECT_EQ(again->identity, first->identity);
  EXPECT_EQ(fs::last_write_time(out / "IMU.txt"), written);
  const fs::path image = fs::directory_iterator(out / "color")->path();
  fs::rename(image, folder_ / "image.png");
  const auto damaged = simulate(options, out, one_, {});
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().message.find("damaged"), std::string::npos) << damaged.error().message;
  fs::rename(folder_ / "image.png", image);
  options.exposure_s = 0.009;
  const auto other = simulate(options, out, one_, {});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::usage);
  EXPECT_NE(other.error().message.find("recording"), std::string::npos);
  const auto strange = simulate(options, folder_, one_, {});
  ASSERT_FALSE(strange);
  EXPECT_TRUE(fs::exists(out / "IMU.txt"));
}

TEST_F(Simulation, StoppedOrFailedItLeavesNothing) {
  const std::atomic<bool> stop = true;
  SimulationControl control;
  control.stop = &stop;
  const auto stopped = simulate(small_options(), folder_ / "stopped", one_, control);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::run_failed);
  const auto blocked = simulate(small_options(), write("file", "x") / "below", one_, {});
  ASSERT_FALSE(blocked);
  EXPECT_EQ(blocked.error().code, ErrorCode::io);
  EXPECT_EQ(files_in(folder_).size(), 1U);
  EXPECT_FALSE(fs::exists(folder_ / "stopped"));
}

TEST_F(Simulation, ReportsProgressAndPeaks) {
  SimulationControl control;
  std::vector<std::size_t> seen;
  control.progress = [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 4U);
    seen.push_back(done);
  };
  const auto report = simulate(small_options(), folder_ / "a", one_, control);
  ASSERT_TRUE(report);
  EXPECT_EQ(seen, (std::vector<std::size_t>{1, 2, 3, 4}));
  EXPECT_NEAR(report->peaks.speed_mps, 2, 0.03);
  EXPECT_NEAR(report->peaks.rate_radps, 3, 0.04);
}

TEST_F(Simulation, ErrorsNameTheOption) {
  const auto message = [&](const auto& change, RecordingLayout layout = RecordingLayout::zr300) {
    SimulationOptions options = small_options(layout);
    change(options);
    const auto result = simulate(options, folder_ / "never", one_, {});
    return result ? std::string("no error") : result.error().message;
  };
  EXPECT_NE(message([](auto& o) { o.blur_samples = -1; }).find("blur_samples = -1"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.exposure_s = NAN; }).find("exposure_s"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.duration_s = 0; }).find("duration_s"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.rate_hz = 25; }, RecordingLayout::icl).find("rate_hz = 25"),
            std::string::npos);
  // The zr300 reader derives the unit of stamps from their spacing.
  EXPECT_NE(message([](auto& o) { o.rate_hz = 3; }).find("zr300 layout: 4 .. 200"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.rate_hz = 201; }).find("rate_hz = 201"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.rig.color.timing.depth_delay_s = 1; }).find("delay_s = 1"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.trajectory_file = "/none.txt"; }).find("/none.txt"), std::string::npos);
  const auto size = simulation_defaults(RecordingLayout::tum, MotionPreset::slow, {0, 0});
  ASSERT_FALSE(size);
  EXPECT_NE(size.error().message.find("0x0"), std::string::npos);
}

TEST_F(Simulation, TheWholeOfATrajectoryIsNotTooLong) {
  std::string path;
  for (const double t : {0, 1000, 2000, 3000, 4000}) path += fmt::format("{} {} 0 1 0 0 0 1\n", t, t / 4000);
  SimulationOptions options = small_options();
  options.trajectory_file = write("path.txt", path);
  options.duration_s = 0;
  const auto longer = simulate(options, folder_ / "never", one_, {});
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().code, ErrorCode::configuration);
  EXPECT_NE(longer.error().message.find("up to 3600 s"), std::string::npos) << longer.error().message;
  for (const double speed : {0.0, 1e-9, -1.0, std::nan("")}) {
    options.file_motion.speed = speed;
    const auto refused = simulate(options, folder_ / "never", one_, {});
    ASSERT_FALSE(refused) << speed;
    EXPECT_NE(refused.error().message.find("speed ="), std::string::npos) << refused.error().message;
  }
}

TEST_F(Simulation, TakesDepthAsMuchLaterAsTheCalibrationSays) {
  SimulationOptions options = small_options();
  remove_noise(options);
  options.rate_hz = 25;
  options.duration_s = 4 / 25.0;
  ASSERT_TRUE(simulate(options, folder_ / "plain", one_, {}));
  options.rig.color.timing.depth_delay_s = 0.04;  // one frame
  ASSERT_TRUE(simulate(options, folder_ / "late", one_, {}));
  auto plain = files_in(folder_ / "plain");
  auto late = files_in(folder_ / "late");
  EXPECT_TRUE(late.at("depth/755000.png") == plain.at("depth/795000.png"));
  EXPECT_FALSE(late.at("depth/755000.png") == plain.at("depth/755000.png"));
  EXPECT_TRUE(late.at("color/755000.png") == plain.at("color/755000.png"));
  const auto recording = open_recording(folder_ / "late");
  ASSERT_TRUE(recording) << recording.error().message;
  const FrameEntry& frame = recording->frames.front();
  EXPECT_EQ(frame.depth_capture_ns - frame.capture_ns, 40'000'000);
}

TEST_F(Simulation, FollowsATrajectoryFile) {
  std::string path = "# timestamp tx ty tz qx qy qz qw\n";
  for (int k = 0; k < 60; ++k) {
    // Level, looking along x, with 0.2 m/s to the left.
    path += fmt::format("{:.6f} 0 {:.9f} 1.3 -0.5 0.5 -0.5 0.5\n", 5 + k / 30.0, 0.2 * k / 30.0);
  }
  SimulationOptions options = small_options(RecordingLayout::tum);
  options.trajectory_file = write("path.txt", path);
  options.file_motion.speed = 3;
  options.duration_s = 0.2;
  const auto report = simulate(options, folder_ / "a", one_, {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->trajectory_shrunk, 1);
  std::vector<std::string> warnings;
  const auto truth = read_tum_trajectory(folder_ / "a" / "groundtruth.txt", warnings);
  ASSERT_TRUE(truth);
  const SE3 moved = truth->front().T_world_camera.inverse() * truth->back().T_world_camera;
  const double duration_s = seconds_between(truth->front().timestamp_ns, truth->back().timestamp_ns);
  EXPECT_NEAR(duration_s, 5 / 30.0 + 2 / 90.0, 1e-5);  // the ground truth has one more pose at both ends
  EXPECT_LT((moved.translation - Vector3d(-0.6 * duration_s, 0, 0)).norm(), 2e-3);  // left of the camera
  EXPECT_NEAR(report->peaks.speed_mps, 0.6, 0.02);
  options.file_motion.in_place = true;
  const auto kept = simulate(options, folder_ / "c", one_, {});
  ASSERT_TRUE(kept) << kept.error().message;
  const auto poses = read_tum_trajectory(folder_ / "c" / "groundtruth.txt", warnings);
  ASSERT_TRUE(poses);
  EXPECT_LT((poses->front().T_world_camera.translation.cwiseProduct(Vector3d(1, 0, 1)) - Vector3d(0, 0, 1.3))
                .norm(),
            2e-3);
  options.file_motion.in_place = false;
  options.duration_s = 0;
  const auto whole = simulate(options, folder_ / "b", one_, {});
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_NEAR(static_cast<double>(whole->frames), 30 * (59 / 30.0 / 3 - 0.25 - 0.1), 1);
}

}  // namespace
}  // namespace fusebench
