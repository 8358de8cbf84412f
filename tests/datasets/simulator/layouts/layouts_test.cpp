// Recordings in every layout, read back by the readers of the formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>

#include "core/base/io/stamped_rows.hpp"
#include "core/base/mesh/ply_file.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "core/config/toml_document.hpp"
#include "core/estimator/prediction/imu_preintegration.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/simulator/simulation.hpp"
#include "tests/datasets/simulator/box_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;
using namespace config;
using namespace trajectory;
using namespace mesh;
using namespace prediction;
using namespace calibration;
using namespace recording;
using namespace datasets;
using namespace simulator::motion;
using namespace simulator::layouts;
using namespace simulator;

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxGap_ns = 50'000'000;

/// A row of state_groundtruth.csv.
struct StateRow {
  std::int64_t timestamp_ns = 0;
  SE3 T_world_imu;
  Vector3d velocity_world_mps;
  Vector3d gyroscope_bias_radps;
  Vector3d accelerometer_bias_mps2;
};

std::vector<StateRow> read_states(const fs::path& file) {
  std::vector<StateRow> rows;
  const auto done = for_each_stamped_row(
      file, "t px py pz qw qx qy qz vx vy vz gx gy gz ax ay az", TimeOrder::increasing,
      [&](const TextTable& table, std::int64_t time_ns) -> Result<void> {
        std::array<double, 16> v{};
        if (auto read = table.numbers(1, v); !read) return read;
        rows.push_back({time_ns,
                        {Quaterniond(v[3], v[4], v[5], v[6]), {v[0], v[1], v[2]}},
                        {v[7], v[8], v[9]},
                        {v[10], v[11], v[12]},
                        {v[13], v[14], v[15]}});
        return {};
      },
      TimeUnit::nanoseconds);
  EXPECT_TRUE(done) << done.error().message;
  return rows;
}

Vector3d read_gravity(const fs::path& folder) {
  Vector3d gravity = Vector3d::Zero();
  const auto document = read_toml(folder / "simulation.toml");
  EXPECT_TRUE(document) << document.error().message;
  for (const TomlEntry& entry : document->entries) {
    if (entry.key != "gravity_world_mps2") continue;
    const auto& list = std::get<TomlList>(entry.value);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto* number = std::get_if<double>(&list[i]);
      gravity[static_cast<Eigen::Index>(i)] =
          number != nullptr ? *number : static_cast<double>(std::get<std::int64_t>(list[i]));
    }
  }
  return gravity;
}

class Layouts : public ::testing::TestWithParam<RecordingLayout> {
 protected:
  /// Ten frames in fast motion, without noise by default.
  Recording make(bool noise = false, double time_offset_s = 0) {
    options_ = simulation_defaults(GetParam(), MotionPreset::fast, {160, 120}).value();
    options_.motion.from_rest = false;
    options_.duration_s = 10 / 30.0;
    options_.blur_samples = 4;
    options_.exposure_s = 0.001;
    options_.imu.time_offset_s = time_offset_s;
    options_.scene_file = testing::write_box_scene(temporary_.path());
    if (!noise) remove_noise(options_);
    const Workers workers(1);
    const auto report = simulate(options_, path(noise), workers, {});
    EXPECT_TRUE(report) << report.error().message;
    auto recording = open_recording(path(noise));
    EXPECT_TRUE(recording) << recording.error().message;
    return recording.value();
  }
  [[nodiscard]] fs::path path(bool noise = false) const {
    return temporary_.path() / (noise ? "noisy" : "recording");
  }
  static SE3 pose_of(const Recording& recording, std::size_t frame) {
    return interpolate_pose(recording.ground_truth, recording.frames[frame].capture_ns, kMaxGap_ns).value();
  }

  const testing::TemporaryFolder temporary_;
  SimulationOptions options_;
};

TEST_P(Layouts, ReadsBackAsWhatItIs) {
  const Recording recording = make();
  EXPECT_EQ(recording.format, to_string(GetParam()));
  EXPECT_TRUE(recording.simulated);
  EXPECT_EQ(recording.imu_source, ImuSource::recorded);
  // As published, the first frame of ICL-NUIM has no pose, which is only noted.
  EXPECT_EQ(recording.warnings, std::vector<std::string>{});
  ASSERT_EQ(recording.frames.size(), 10U);
  const LayoutDescription& layout = describe(GetParam());
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    EXPECT_EQ(recording.frames[k].timestamp_ns, layout.frame_ns(k, 30)) << k;
    EXPECT_LT(std::abs(recording.frames[k].capture_ns - layout.frame_ns(k, 30)), 2'000) << k;
    EXPECT_LT(std::abs(recording.frames[k].depth_capture_ns - layout.frame_ns(k, 30)), 2'000) << k;
  }
  const RigCalibration& rig = options_.rig;
  const PinholeCamera& camera = recording.rig.camera;
  EXPECT_EQ(camera.width_px, 160);
  EXPECT_NEAR(camera.fx_px, rig.color.pinhole.fx_px, 1e-9);
  EXPECT_NEAR(camera.fy_px, rig.color.pinhole.fy_px, 1e-9);
  EXPECT_NEAR(camera.cx_px, rig.color.pinhole.cx_px, 1e-9);
  EXPECT_NEAR(camera.cy_px, rig.color.pinhole.cy_px, 1e-9);
  const SE3 off = recording.rig.T_imu_camera.inverse() * rig.imu->T_imu_camera;
  EXPECT_LT(off.translation.norm(), 1e-9);
  EXPECT_LT(so3_log(off.rotation).norm(), 1e-9);
  EXPECT_EQ(recording.rig.imu_noise.gyroscope_radps_sqrthz, rig.imu->noise.gyroscope_radps_sqrthz);
}

TEST_P(Layouts, ImuBeginsBeforeTheImagesAndSurroundsThem) {
  const Recording recording = make();
  const double lead_s =
      seconds_between(recording.imu.front().timestamp_ns, recording.frames.front().timestamp_ns);
  EXPECT_NEAR(lead_s, GetParam() == RecordingLayout::zr300 ? 0.75 : 0.25, 1e-9);
  EXPECT_GT(recording.imu.back().timestamp_ns, recording.frames.back().timestamp_ns + 20'000'000);
  for (std::size_t i = 1; i < recording.imu.size(); ++i) {
    EXPECT_EQ(recording.imu[i].timestamp_ns - recording.imu[i - 1].timestamp_ns, 5'000'000);
  }
}

TEST_P(Layouts, GroundTruthOfTheCameraFollowsFromTheBody) {
  const Recording recording = make();
  Trajectory body;
  for (const StateRow& row : read_states(path() / "state_groundtruth.csv"))
    body.push_back({row.timestamp_ns, row.T_world_imu});
  for (std::size_t k = 1; k < recording.frames.size(); ++k) {  // ICL-NUIM's frame 0 has no pose
    const auto imu = interpolate_pose(body, recording.frames[k].capture_ns, kMaxGap_ns);
    ASSERT_TRUE(imu);
    const SE3 off = pose_of(recording, k).inverse() * (*imu * recording.rig.T_imu_camera);
    // Linear interpolation over 5 ms at 6 m/s^2 and 30 rad/s^2.
    EXPECT_LT(off.translation.norm(), 1e-4) << k;
    EXPECT_LT(so3_log(off.rotation).norm(), 3e-4) << k;
  }
}

TEST_P(Layouts, ImuFromTheTrueStateFollowsTheGroundTruth) {
  const Recording recording = make();
  const Vector3d gravity = read_gravity(path());
  EXPECT_NEAR(gravity.norm(), kGravity_mps2, 1e-9);
  const std::vector<StateRow> states = read_states(path() / "state_groundtruth.csv");
  const StateRow& a = states[2];
  const StateRow& b = states[states.size() - 3];
  const auto sum = preintegrate(recording.imu, a.timestamp_ns, b.timestamp_ns,
                                {a.gyroscope_bias_radps, a.accelerometer_bias_mps2}, recording.rig.imu_noise);
  ASSERT_TRUE(sum);
  const double t = sum->duration_s;
  EXPECT_GT(t, 0.5);
  const SE3& T = a.T_world_imu;
  const Vector3d position =
      T.translation + t * a.velocity_world_mps + 0.5 * t * t * gravity + T.rotation * sum->delta_position_m;
  EXPECT_LT((position - b.T_world_imu.translation).norm(), 2e-4);
  EXPECT_LT(rotation_angle_rad(T.rotation * sum->delta_rotation, b.T_world_imu.rotation), 2e-4);
}

TEST_P(Layouts, StatesTheTimeOffsetOfItsImu) {
  const Recording plain = make();
  const std::int64_t first_ns = plain.imu.front().timestamp_ns;
  fs::remove_all(path());
  const Recording late = make(false, 0.02);
  const auto calibration = read_calibration_beside(path());
  ASSERT_TRUE(calibration && *calibration);
  EXPECT_EQ((*calibration)->imu->time_offset_s, 0.02);
  // The reader puts the samples, which are 20 ms late in the file, back on the images' clock.
  const std::vector<StateRow> states = read_states(path() / "state_groundtruth.csv");
  EXPECT_EQ(states.front().timestamp_ns, first_ns);
  EXPECT_EQ(late.imu.front().timestamp_ns, first_ns);
}

/// Depth of frame a projected into frame b with the relative pose T_b_a.
struct Overlap {
  double depth_m = 0;    ///< median difference
  double intensity = 0;  ///< mean difference, grey levels
  std::size_t pixels = 0;
};

Overlap overlap(const PinholeCamera& camera, const RgbdFrame& a, const RgbdFrame& b, const SE3& T_b_a) {
  std::vector<double> depth;
  double intensity = 0;
  for (int v = 2; v < camera.height_px - 2; ++v) {
    for (int u = 2; u < camera.width_px - 2; ++u) {
      const float depth_m = a.depth_m(u, v);
      if (depth_m <= 0) continue;
      const Vector3d point = T_b_a * camera.back_project(u, v, static_cast<double>(depth_m));
      if (point.z() < 0.1) continue;
      const Vector2d pixel = camera.project(point);
      const int x = static_cast<int>(std::lround(pixel.x()));
      const int y = static_cast<int>(std::lround(pixel.y()));
      if (x < 2 || y < 2 || x >= camera.width_px - 2 || y >= camera.height_px - 2) continue;
      const float seen_m = b.depth_m(x, y);
      if (seen_m <= 0 || std::abs(seen_m - point.z()) > 0.3) continue;  // hidden
      depth.push_back(std::abs(seen_m - point.z()));
      intensity += std::abs(sample_bilinear(b.grey, pixel.x(), pixel.y()).value - a.grey(u, v));
    }
  }
  EXPECT_GT(depth.size(), 2000U);
  std::ranges::nth_element(depth, depth.begin() + static_cast<std::ptrdiff_t>(depth.size() / 2));
  return {depth[depth.size() / 2], intensity / static_cast<double>(depth.size()), depth.size()};
}

TEST_P(Layouts, FramesReprojectOntoEachOther) {
  const Recording recording = make();
  const auto a = recording.load_frame(2);
  const auto b = recording.load_frame(7);
  ASSERT_TRUE(a && b);
  const PinholeCamera& camera = recording.rig.camera;
  const SE3 T_b_a = pose_of(recording, 7).inverse() * pose_of(recording, 2);
  EXPECT_GT(T_b_a.translation.norm() + so3_log(T_b_a.rotation).norm(), 0.1);
  const Overlap truth = overlap(camera, *a, *b, T_b_a);
  EXPECT_LT(truth.depth_m, 0.008);  // nearest pixels of 1/150 rad on tilted surfaces
  EXPECT_LT(truth.intensity, 10);
  EXPECT_GT(overlap(camera, *a, *b, SE3{}).depth_m, 3 * truth.depth_m);
  // The true pose fits better than its neighbours in all directions.
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const SE3 shifted{Quaterniond::Identity(), sign * 0.03 * Vector3d::Unit(axis)};
      const SE3 turned{so3_exp(sign * radians(1.0) * Vector3d::Unit(axis)), Vector3d::Zero()};
      EXPECT_GT(overlap(camera, *a, *b, shifted * T_b_a).intensity, truth.intensity) << axis << sign;
      EXPECT_GT(overlap(camera, *a, *b, turned * T_b_a).intensity, truth.intensity) << axis << sign;
    }
  }
}

/// Share of the visible vertices of the scene that agree with the depth image.
double share_on_surface(const Mesh& scene, const RgbdFrame& frame, const PinholeCamera& camera,
                        const SE3& T_camera_world) {
  std::size_t inside = 0;
  std::size_t on_surface = 0;
  for (const Eigen::Vector3f& vertex : scene.vertices) {
    const Vector3d point = T_camera_world * vertex.cast<double>();
    if (point.z() < 0.3) continue;
    const Vector2d pixel = camera.project(point);
    const int x = static_cast<int>(std::lround(pixel.x()));
    const int y = static_cast<int>(std::lround(pixel.y()));
    if (!frame.depth_m.contains(x, y) || frame.depth_m(x, y) <= 0) continue;
    ++inside;
    if (std::abs(point.z() - static_cast<double>(frame.depth_m(x, y))) < 0.03) ++on_surface;
  }
  EXPECT_GT(inside, 10U);
  return static_cast<double>(on_surface) / static_cast<double>(inside);
}

TEST_P(Layouts, SceneIsInTheWorldOfTheGroundTruth) {
  const Recording recording = make();
  const auto scene = read_ply(path() / "scene.ply");
  ASSERT_TRUE(scene) << scene.error().message;
  const auto frame = recording.load_frame(5);
  ASSERT_TRUE(frame);
  const SE3 T_camera_world = pose_of(recording, 5).inverse();
  const PinholeCamera& camera = recording.rig.camera;
  EXPECT_GT(share_on_surface(scene->cast<float>(), *frame, camera, T_camera_world), 0.95);
  const SE3 elsewhere{so3_exp({0.1, 0.1, 0.1}), {0.1, 0.1, 0.1}};
  EXPECT_LT(share_on_surface(scene->cast<float>(), *frame, camera, elsewhere * T_camera_world), 0.5);
}

/// Median of how far the measurements of two images of one view lie apart, metres.
double median_difference_m(const DepthImage& a, const DepthImage& b) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    if (a.data[i] > 0 && b.data[i] > 0)
      differences.push_back(std::abs(static_cast<double>(a.data[i]) - static_cast<double>(b.data[i])));
  }
  EXPECT_GT(differences.size(), 2000U);
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle;
}

TEST_P(Layouts, DepthReprojectsWithinItsNoise) {
  const Recording clean = make();
  const Recording noisy = make(true);
  const auto a = noisy.load_frame(2);
  const auto b = noisy.load_frame(7);
  const auto exact_a = clean.load_frame(2);
  const auto exact_b = clean.load_frame(7);
  ASSERT_TRUE(a && b && exact_a && exact_b);
  const double noise_a_m = median_difference_m(a->depth_m, exact_a->depth_m);
  const double noise_b_m = median_difference_m(b->depth_m, exact_b->depth_m);
  EXPECT_GT(noise_a_m, 0.001);
  const SE3 T_b_a = pose_of(noisy, 7).inverse() * pose_of(noisy, 2);
  const double floor_m = overlap(clean.rig.camera, *exact_a, *exact_b, T_b_a).depth_m;
  // Medians of independent errors of one kind add like their variances.
  const double predicted_m = std::sqrt(noise_a_m * noise_a_m + noise_b_m * noise_b_m + floor_m * floor_m);
  const double residual_m = overlap(noisy.rig.camera, *a, *b, T_b_a).depth_m;
  EXPECT_LT(residual_m, 1.4 * predicted_m);
  EXPECT_GT(residual_m, 0.6 * predicted_m);
}

TEST(Zr300Layout, ReadsBackAtItsLowestAndHighestRate) {
  const testing::TemporaryFolder folder;
  const Workers workers(1);
  for (const double rate_hz : {4.0, 200.0}) {
    SimulationOptions options =
        simulation_defaults(RecordingLayout::zr300, MotionPreset::slow, {64, 48}).value();
    options.motion.from_rest = false;
    options.scene_file = testing::write_box_scene(folder.path());
    options.rate_hz = rate_hz;
    options.duration_s = rate_hz < 100 ? 1 : 0.1;
    const fs::path path = folder.path() / std::to_string(std::lround(rate_hz));
    const auto made = simulate(options, path, workers, {});
    ASSERT_TRUE(made) << made.error().message;
    const auto recording = open_recording(path);
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_EQ(recording->frames.size(), made->frames);
  }
}

TEST(IclLayout, WritesPosesAsTheyArePublished) {
  const testing::TemporaryFolder folder;
  SimulationOptions options = simulation_defaults(RecordingLayout::icl, MotionPreset::slow, {64, 48}).value();
  options.motion.from_rest = false;
  options.duration_s = 3 / 30.0;
  const Workers workers(1);
  ASSERT_TRUE(simulate(options, folder.path() / "r", workers, {}));
  const std::string text = testing::read_bytes(folder.path() / "r" / "livingRoom0.gt.freiburg");
  std::istringstream rows(text);
  std::vector<double> numbers(std::istream_iterator<double>(rows), {});
  ASSERT_EQ(numbers.size(), 16U);  // frames 1 and 2
  const std::vector<double> first = {1, 0, 0, -2.25, 0, 0, 0, 1};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(numbers[i], first[i], 1e-9) << i;
  EXPECT_EQ(numbers[8], 2);
  const std::string pairs = testing::read_bytes(folder.path() / "r" / "associations.txt");
  EXPECT_EQ(pairs.substr(0, pairs.find('\n')), "0 depth/0.png 0 rgb/0.png");
  EXPECT_NE(testing::read_bytes(folder.path() / "r" / "simulation.toml").find("left-handed, y up"),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, Layouts,
                         ::testing::Values(RecordingLayout::tum, RecordingLayout::icl,
                                           RecordingLayout::zr300),
                         [](const auto& test) { return std::string(to_string(test.param)); });

// The preset of freiburg1, whose cameras the TUM layout has, gives the position of its motion capture.
TEST(LayoutRig, GroundTruthIsThatOfTheCamera) {
  for (const RecordingLayout layout : {RecordingLayout::zr300, RecordingLayout::tum, RecordingLayout::icl}) {
    const auto rig = layout_rig(layout, {640, 480});
    ASSERT_TRUE(rig);
    EXPECT_EQ(rig->color.ground_truth_offset_m, Vector3d::Zero());
  }
}

}  // namespace
}  // namespace fusebench
