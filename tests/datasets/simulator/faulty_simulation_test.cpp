// Effect of each fault on the files of a recording.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/simulator/simulation.hpp"
#include "tests/datasets/simulator/box_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;
using namespace datasets;
using namespace simulator::texture;
using namespace simulator::motion;
using namespace simulator::faults;
using namespace simulator::layouts;
using namespace simulator;

namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 160;
constexpr int kHeight = 120;

class FaultySimulation : public testing::InTemporaryFolder {
 protected:
  /// Four frames, with all noise; frame k is at k / 30 s.
  [[nodiscard]] SimulationOptions options(std::string_view fault = {},
                                          RecordingLayout layout = RecordingLayout::tum) const {
    SimulationOptions options = simulation_defaults(layout, MotionPreset::fast, {kWidth, kHeight}).value();
    options.motion.from_rest = false;
    options.duration_s = 4 / 30.0;
    options.blur_samples = 2;
    options.scene_file = box_;
    if (!fault.empty()) options.faults = {parse_fault(fault).value()};
    return options;
  }

  /// A recording of its own folder; the reader takes it.
  fs::path simulated(const SimulationOptions& options, int threads = 1) {
    const fs::path folder = folder_ / std::to_string(count_++);
    const auto report = simulate(options, folder, Workers(threads));
    EXPECT_TRUE(report) << (report ? "" : report.error().message);
    const auto recording = open_recording(folder);
    EXPECT_TRUE(recording) << (recording ? "" : recording.error().message);
    return folder;
  }

  static std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file())
        files[fs::relative(entry.path(), folder).string()] = testing::read_bytes(entry.path());
    }
    return files;
  }

  /// Images of the TUM layout in the order of time.
  static fs::path nth(const fs::path& folder, std::size_t k) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::ranges::sort(files);
    return files.at(k);
  }
  static ColorImage color(const fs::path& folder, std::size_t k) {
    return read_color(nth(folder / "rgb", k)).value();
  }
  static Image<std::uint16_t> depth(const fs::path& folder, std::size_t k) {
    return read_depth16(nth(folder / "depth", k)).value();
  }

  /// True if the images of a frame have the same bytes in two recordings.
  static bool same_images(const fs::path& a, const fs::path& b, std::size_t k) {
    return testing::read_bytes(nth(a / "rgb", k)) == testing::read_bytes(nth(b / "rgb", k)) &&
           testing::read_bytes(nth(a / "depth", k)) == testing::read_bytes(nth(b / "depth", k));
  }

  const testing::TemporaryFolder scene_;
  const fs::path box_ = testing::write_box_scene(scene_.path());
  int count_ = 0;
};

double mean_of(const ColorImage& image) {
  double sum = 0;
  for (const Rgb& pixel : image.data) sum += pixel[0] + pixel[1] + pixel[2];
  return sum / (3.0 * static_cast<double>(image.data.size()));
}

double linear_mean_of(const ColorImage& image) {
  double sum = 0;
  for (const Rgb& pixel : image.data) sum += linear_from_srgb(pixel[1] / 255.0);
  return sum / static_cast<double>(image.data.size());
}

/// Standard deviation of the green channel.
double contrast_of(const ColorImage& image) {
  double sum = 0;
  double squares = 0;
  for (const Rgb& pixel : image.data) {
    sum += pixel[1];
    squares += pixel[1] * pixel[1];
  }
  const auto count = static_cast<double>(image.data.size());
  return std::sqrt(std::max(0.0, squares / count - sum * sum / count / count));
}

std::size_t measured(const Image<std::uint16_t>& depth) {
  return depth.data.size() - static_cast<std::size_t>(std::ranges::count(depth.data, 0));
}

/// Pixels that differ between two images of one size.
std::size_t changed_pixels(const ColorImage& a, const ColorImage& b) {
  std::size_t changed = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) changed += a.data[i] != b.data[i] ? 1 : 0;
  return changed;
}

TEST_F(FaultySimulation, HoldForTheirFramesAndNoOthers) {
  const fs::path plain = simulated(options());
  for (const FaultDescription& kind : fault_kinds()) {
    if (kind.kind == FaultKind::drop) continue;
    SCOPED_TRACE(kind.name);
    const fs::path faulty = simulated(options(fmt::format("{}=0.03:0.09", kind.name)));  // frames 1 and 2
    EXPECT_TRUE(same_images(plain, faulty, 0));
    EXPECT_FALSE(same_images(plain, faulty, 1));
    EXPECT_FALSE(same_images(plain, faulty, 2));
    EXPECT_TRUE(same_images(plain, faulty, 3));
    auto a = files_in(plain);
    auto b = files_in(faulty);
    for (const char* file : {"rgb.txt", "depth.txt", "associations.txt", "imu.csv", "groundtruth.txt",
                             "calibration.toml", "state_groundtruth.csv", "scene.ply"}) {
      EXPECT_TRUE(a.at(file) == b.at(file)) << file;
    }
    EXPECT_NE(b.at("simulation.toml").find(fmt::format("list = [\"{}=0.03:0.09", kind.name)),
              std::string::npos);
  }
}

TEST_F(FaultySimulation, SameOptionsSameBytesWithAnyThreads) {
  SimulationOptions faulty = options("hand=0:1:0.3");
  faulty.faults.push_back(parse_fault("no-texture=0.03:0.07").value());
  faulty.faults.push_back(parse_fault("drop=0.09:1").value());
  faulty.calibration_error = {1, 1};
  faulty.untold_time_offset_s = 0.01;
  EXPECT_TRUE(files_in(simulated(faulty, 1)) == files_in(simulated(faulty, 3)));
}

TEST_F(FaultySimulation, EachChangesTheIdentityAndNoneLeavesIt) {
  std::vector<std::string> identities{simulation_identity(options()).value()};
  for (const FaultDescription& kind : fault_kinds())
    identities.push_back(simulation_identity(options(fmt::format("{}=0.03:0.09", kind.name))).value());
  identities.push_back(simulation_identity(options("hand=0.03:0.09:0.2")).value());
  SimulationOptions miscalibrated = options();
  miscalibrated.calibration_error = {1, 0};
  identities.push_back(simulation_identity(miscalibrated).value());
  SimulationOptions late = options();
  late.untold_time_offset_s = 0.01;
  identities.push_back(simulation_identity(late).value());
  std::ranges::sort(identities);
  EXPECT_EQ(std::ranges::adjacent_find(identities), identities.end());
  // Recordings that were made before there were faults keep theirs.
  const std::string text = simulation_text(options(), "x", {0, 0, -9.81});
  EXPECT_EQ(text.find("fault"), std::string::npos);
  EXPECT_EQ(text.find("untold"), std::string::npos);
}

TEST_F(FaultySimulation, BlackHasOnlyNoise) {
  const fs::path folder = simulated(options("black=0:1"));
  const ColorImage image = color(folder, 1);
  EXPECT_LT(mean_of(image), 2);
  EXPECT_GT(contrast_of(image), 0.2);  // read noise stays
  EXPECT_EQ(measured(depth(folder, 1)), 0U);
}

TEST_F(FaultySimulation, NoDepthLeavesTheColour) {
  const fs::path plain = simulated(options());
  const fs::path folder = simulated(options("no-depth=0:1"));
  EXPECT_EQ(measured(depth(folder, 2)), 0U);
  EXPECT_GT(measured(depth(plain, 2)), 1000U);
  EXPECT_TRUE(testing::read_bytes(nth(folder / "rgb", 2)) == testing::read_bytes(nth(plain / "rgb", 2)));
}

TEST_F(FaultySimulation, NoTextureIsOneGreyAndLeavesTheDepth) {
  SimulationOptions clean = options("no-texture=0:1");
  remove_noise(clean);
  const fs::path folder = simulated(clean);
  const ColorImage image = color(folder, 1);
  EXPECT_EQ(contrast_of(image), 0);
  EXPECT_GT(mean_of(image), 50);
  EXPECT_LT(mean_of(image), 220);
  SimulationOptions usual = options();
  remove_noise(usual);
  const fs::path plain = simulated(usual);
  EXPECT_GT(contrast_of(color(plain, 1)), 3);
  EXPECT_TRUE(depth(folder, 1).data == depth(plain, 1).data);
}

TEST_F(FaultySimulation, AHandCoversItsShareOfColourAndDepth) {
  SimulationOptions usual = options();
  remove_noise(usual);
  usual.exposure_s = 0;
  const fs::path plain = simulated(usual);
  for (const double share : {0.05, 0.3, 0.6, 0.9}) {
    SCOPED_TRACE(share);
    SimulationOptions faulty = usual;
    faulty.faults = {{FaultKind::hand, 0, 1, share}};
    const fs::path folder = simulated(faulty);
    const Image<std::uint16_t> with = depth(folder, 1);
    const Image<std::uint16_t> without = depth(plain, 1);
    std::size_t near = 0;
    for (std::size_t i = 0; i < with.data.size(); ++i) {
      if (with.data[i] == without.data[i]) continue;
      ++near;
      EXPECT_GE(with.data[i], 5000 * 0.36);  // 5000 units a metre
      EXPECT_LE(with.data[i], 5000 * 0.41);
    }
    const std::size_t changed = changed_pixels(color(folder, 1), color(plain, 1));
    const auto pixels = static_cast<double>(with.data.size());
    EXPECT_NEAR(static_cast<double>(near) / pixels, share, 0.02 + 0.05 * share);
    EXPECT_NEAR(static_cast<double>(changed) / pixels, share, 0.03 + 0.05 * share);
  }
}

TEST_F(FaultySimulation, APersonIsInColourAndDepthAtItsDistance) {
  SimulationOptions usual = options();
  remove_noise(usual);
  usual.exposure_s = 0;
  SimulationOptions faulty = usual;
  faulty.faults = {{FaultKind::person, 0, 1, 1.0}};
  const fs::path plain = simulated(usual);
  const fs::path folder = simulated(faulty);
  const Image<std::uint16_t> with = depth(folder, 1);
  const Image<std::uint16_t> without = depth(plain, 1);
  std::size_t nearer = 0;
  for (std::size_t i = 0; i < with.data.size(); ++i) {
    if (with.data[i] == without.data[i]) continue;
    ++nearer;
    EXPECT_GE(with.data[i], 5000 * 0.6);
    EXPECT_LE(with.data[i], 5000 * 1.3);
  }
  EXPECT_GT(nearer, with.data.size() / 20);
  const std::size_t changed = changed_pixels(color(folder, 1), color(plain, 1));
  EXPECT_NEAR(static_cast<double>(changed), static_cast<double>(nearer), 0.3 * static_cast<double>(nearer));
}

TEST_F(FaultySimulation, AHandMovesAndHasTexture) {
  SimulationOptions faulty = options("hand=0:1:0.3");
  remove_noise(faulty);
  const fs::path folder = simulated(faulty);
  const Image<std::uint16_t> first = depth(folder, 0);
  const Image<std::uint16_t> last = depth(folder, 3);
  const auto centre = [](const Image<std::uint16_t>& image) {
    Vector2d sum = Vector2d::Zero();
    int count = 0;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        if (image(u, v) == 0 || image(u, v) > 5000 * 0.41) continue;
        sum += Vector2d(u, v);
        ++count;
      }
    }
    return Vector2d(sum / std::max(1, count));
  };
  EXPECT_GT((centre(first) - centre(last)).norm(), 1);  // 0.1 s at up to 0.6 m/s
  const ColorImage image = color(folder, 0);
  const Vector2d middle = centre(first);
  const int left = static_cast<int>(middle.x()) - 20;
  const int top = static_cast<int>(middle.y()) - 15;
  double sum = 0;
  double squares = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const double value = image(left + x, top + y)[1];
      sum += value / 1200;
      squares += value * value / 1200;
    }
  }
  EXPECT_GT(std::sqrt(squares - sum * sum), 4);
}

TEST_F(FaultySimulation, AZr300SeesTheHandByDepthFromWhereItsDepthCameraIs) {
  SimulationOptions faulty = options("hand=0:1:0.3", RecordingLayout::zr300);
  remove_noise(faulty);
  const fs::path folder = simulated(faulty);
  const auto recording = open_recording(folder);
  ASSERT_TRUE(recording);
  // Registered to colour: nearly all pixels with near depth have the colour of the hand (without the room's
  // light), and the hand appears once only.
  const RgbdFrame frame = recording->load_frame(1).value();
  std::size_t near = 0;
  for (const float z : frame.depth_m.data) near += z > 0.3F && z < 0.45F ? 1U : 0U;
  EXPECT_NEAR(static_cast<double>(near) / static_cast<double>(frame.depth_m.data.size()), 0.3, 0.05);
}

TEST_F(FaultySimulation, BrightnessIsAFactorOnTheLight) {
  SimulationOptions usual = options();
  remove_noise(usual);
  const double before = linear_mean_of(color(simulated(usual), 1));
  for (const double factor : {0.3, 0.5, 1.2}) {
    SimulationOptions faulty = usual;
    faulty.faults = {{FaultKind::brightness, 0, 1, factor}};
    const double after = linear_mean_of(color(simulated(faulty), 1));
    EXPECT_NEAR(after / before, factor, 0.02 * factor) << "rounding to 8 bits, and what saturates";
  }
}

TEST_F(FaultySimulation, DroppedFramesAreNowhere) {
  for (const RecordingLayout layout : {RecordingLayout::tum, RecordingLayout::icl, RecordingLayout::zr300}) {
    SCOPED_TRACE(to_string(layout));
    SimulationOptions longer = options({}, layout);
    longer.duration_s = 8 / 30.0;
    SimulationOptions faulty = longer;
    faulty.faults = {parse_fault("drop=0.09:0.16").value()};  // frames 3 and 4
    const auto plain = open_recording(simulated(longer));
    const auto recording = open_recording(simulated(faulty));
    ASSERT_TRUE(plain && recording);
    ASSERT_EQ(plain->frames.size(), 8U);
    ASSERT_EQ(recording->frames.size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t original = k < 3 ? k : k + 2;
      EXPECT_EQ(recording->frames[k].timestamp_ns, plain->frames[original].timestamp_ns);
      EXPECT_NEAR(static_cast<double>(recording->frames[k].capture_ns - plain->frames[original].capture_ns),
                  0, 2e5);
      EXPECT_TRUE(testing::read_bytes(recording->frames[k].color_file) ==
                  testing::read_bytes(plain->frames[original].color_file));
    }
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(recording->frames[0].color_file.parent_path()))
      files += entry.is_regular_file() ? 1 : 0;
    EXPECT_EQ(files, 6U);
    EXPECT_EQ(recording->ground_truth.size(), plain->ground_truth.size());
    EXPECT_EQ(recording->imu.size(), plain->imu.size());
  }
}

TEST_F(FaultySimulation, BlurIsThatOfALongerExposure) {
  SimulationOptions faulty = options("blur=0:1:0.03");
  remove_noise(faulty);
  SimulationOptions exposed = options();
  remove_noise(exposed);
  exposed.exposure_s = 0.03;
  exposed.blur_samples = 8;  // 2 x 0.03 / 0.008, rounded up
  EXPECT_TRUE(color(simulated(faulty), 1).data == color(simulated(exposed), 1).data);
}

TEST_F(FaultySimulation, AWrongCalibrationIsOnlyInTheCalibration) {
  SimulationOptions faulty = options();
  faulty.calibration_error = {1, 2};
  auto wrong = files_in(simulated(faulty));
  auto right = files_in(simulated(options()));
  for (const auto& [file, bytes] : right) {
    EXPECT_EQ(bytes == wrong.at(file), file != "calibration.toml" && file != "simulation.toml") << file;
  }
  const auto recording = open_recording(folder_ / "0");
  ASSERT_TRUE(recording);
  const SE3& truth = faulty.rig.imu->T_imu_camera;
  EXPECT_NEAR(rotation_angle_rad(recording->rig.T_imu_camera.rotation, truth.rotation), radians(1.0), 1e-6);
  EXPECT_NEAR((recording->rig.T_imu_camera.translation - truth.translation).norm(), 0.02, 1e-6);
}

TEST_F(FaultySimulation, AnUntoldOffsetMovesTheStampsOfTheImuAlone) {
  SimulationOptions told = options();
  told.imu.time_offset_s = 0.005;
  const auto right = open_recording(simulated(told));
  for (const double untold_s : {0.01, -0.04}) {
    SimulationOptions faulty = told;
    faulty.untold_time_offset_s = untold_s;
    const auto wrong = open_recording(simulated(faulty));
    ASSERT_TRUE(right && wrong);
    ASSERT_GE(wrong->imu.size(), right->imu.size());
    for (std::size_t i = 0; i < right->imu.size(); ++i) {
      EXPECT_EQ(wrong->imu[i].timestamp_ns - right->imu[i].timestamp_ns, std::llround(1e9 * untold_s));
      EXPECT_EQ(wrong->imu[i].specific_force_mps2, right->imu[i].specific_force_mps2);
    }
    EXPECT_GT(wrong->imu.back().timestamp_ns, wrong->frames.back().capture_ns + 40'000'000);
    EXPECT_EQ(wrong->ground_truth.front().timestamp_ns, right->ground_truth.front().timestamp_ns);
  }
}

TEST_F(FaultySimulation, RejectsInvalidOptionsWithoutAFolder) {
  const auto message = [&](const auto& change) {
    SimulationOptions faulty = options();
    change(faulty);
    const auto result = simulate(faulty, folder_ / "never", Workers(1));
    EXPECT_FALSE(fs::exists(folder_ / "never"));
    return result ? std::string("no error") : result.error().message;
  };
  EXPECT_NE(message([](auto& o) {
              o.faults = {{FaultKind::black, 5, 6, 0}};
            }).find("no frame is within it"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.calibration_error.rotation_deg = 90; }).find("rotation_deg = 90"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.untold_time_offset_s = 0.05; }).find("untold_time_offset_s = 0.05"),
            std::string::npos);
}

}  // namespace
}  // namespace fusebench
