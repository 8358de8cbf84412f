// Recordings with realistic sensors: what they hold, what they hide, and that they are reproducible.
#include "datasets/simulator/realism.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/simulator/scene/office.hpp"
#include "tests/datasets/simulator/box_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace simulator::motion;
using namespace simulator::layouts;
using namespace simulator;

namespace {

namespace fs = std::filesystem;

class Realism : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] SimulationOptions options(RecordingLayout layout = RecordingLayout::tum) const {
    SimulationOptions options = simulation_defaults(layout, MotionPreset::realistic_scan, {80, 60}).value();
    options.motion.from_rest = false;
    options.duration_s = 8 / 30.0;
    options.scene_file = box_;
    options.seed = 3;
    make_realistic(options);
    return options;
  }

  fs::path simulated(const SimulationOptions& options, const std::string& name, int threads = 1) {
    const auto report = simulate(options, folder_ / name, Workers(threads));
    EXPECT_TRUE(report) << (report ? "" : report.error().message);
    return folder_ / name;
  }

  static std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file())
        files[fs::relative(entry.path(), folder).string()] = testing::read_bytes(entry.path());
    }
    return files;
  }

  const testing::TemporaryFolder scene_;
  const fs::path box_ = testing::write_box_scene(scene_.path());
};

TEST_F(Realism, TheSameBytesForOneAndFourThreads) {
  for (const RecordingLayout layout : {RecordingLayout::tum, RecordingLayout::icl, RecordingLayout::zr300}) {
    const std::string name(to_string(layout));
    SCOPED_TRACE(name);
    EXPECT_EQ(files_in(simulated(options(layout), name + "1", 1)),
              files_in(simulated(options(layout), name + "4", 4)));
    const auto recording = datasets::open_recording(folder_ / (name + "1"));
    EXPECT_TRUE(recording) << (recording ? "" : recording.error().message);
  }
}

TEST_F(Realism, GroundTruthIsThatOfTheCameraForAnyPreset) {
  const fs::path folder = simulated(options(), "twin");
  recording::ReadOptions with_offset;
  with_offset.camera = calibration::read_calibration(folder / "calibration.toml").value().color;
  with_offset.camera->ground_truth_offset_m = {-0.03, 0, 0};  // as of a real camera under motion capture
  const auto twin = datasets::open_recording(folder, {.format = "tum", .read = with_offset});
  ASSERT_TRUE(twin) << twin.error().message;
  EXPECT_EQ(recording::ground_truth_offset_m(*twin), Vector3d::Zero());
  for (const std::string& note : twin->notes) EXPECT_EQ(note.find("ground truth"), std::string::npos) << note;
}

TEST_F(Realism, TheCalibrationOmitsTheSimulatedErrors) {
  const fs::path folder = simulated(options(), "tum");
  const std::string calibration = testing::read_bytes(folder / "calibration.toml");
  EXPECT_EQ(calibration.find("readout_s"), std::string::npos);
  EXPECT_EQ(calibration.find("delay_s"), std::string::npos);
  EXPECT_EQ(calibration.find("ground_truth_offset_m"), std::string::npos);
  const auto rig = calibration::read_calibration(folder / "calibration.toml");
  ASSERT_TRUE(rig);
  EXPECT_EQ(rig->color.timing.color_readout_sigma_s, calibration::kUnknownReadoutSigma_s);
  EXPECT_EQ(rig->color.timing.depth_delay_sigma_s, calibration::kUnknownDelaySigma_s);
  EXPECT_EQ(calibration::to_toml(*rig).find("readout_s"), std::string::npos);  // nor does it when read back
  const std::string told = testing::read_bytes(folder / "simulation.toml");
  for (const std::string_view what :
       {"color_readout_s = 0.0261", "depth_delay_s = -0.018", "jitter_s = 0.001", "most_gain",
        "shot_noise = [", "lost_light = true", "time_offset_s = 0.005", "rotation_deg = 1"})
    EXPECT_NE(told.find(what), std::string::npos) << what;
}

TEST_F(Realism, EveryOptionIsPartOfTheIdentity) {
  const SimulationOptions usual = options();
  const std::string identity = simulation_identity(usual).value();
  const auto changed = [&](auto change) {
    SimulationOptions other = usual;
    change(other);
    return simulation_identity(other).value();
  };
  EXPECT_NE(identity, changed([](auto& o) { o.untold_shutters = false; }));
  EXPECT_NE(identity, changed([](auto& o) { o.stamps.jitter_s = 0.002; }));
  EXPECT_NE(identity, changed([](auto& o) { o.stamps.dropped_share = 0; }));
  EXPECT_NE(identity, changed([](auto& o) { o.auto_exposure.on = false; }));
  EXPECT_NE(identity, changed([](auto& o) { o.color_processing.contrast = 0.5; }));
  EXPECT_NE(identity, changed([](auto& o) { o.depth_errors.lost_light = false; }));
  EXPECT_NE(identity, changed([](auto& o) { o.motion.tremor_rad = 0.002; }));
}

TEST_F(Realism, DroppedImagesAreMissingFromListsAndFoldersOfTheirSensor) {
  SimulationOptions many = options();
  many.duration_s = 1;
  many.stamps.dropped_share = 0.3;
  const fs::path folder = simulated(many, "tum");
  const auto count = [&](const char* name) {
    return std::distance(fs::directory_iterator(folder / name), fs::directory_iterator());
  };
  EXPECT_LT(count("rgb"), 29);
  EXPECT_GT(count("rgb"), 12);
  EXPECT_LT(count("depth"), 29);
  const std::string list = testing::read_bytes(folder / "rgb.txt");
  EXPECT_EQ(std::ranges::count(list, '\n'), count("rgb") + 3);
  EXPECT_FALSE(fs::exists(folder / "associations.txt"));
}

TEST_F(Realism, TheImuIsOffByUpToTwoPercentFromTheSeed) {
  const SimulationOptions usual = options();
  const Matrix3d& gain = usual.imu.gyroscope_gain;
  EXPECT_LE((gain - Matrix3d::Identity()).diagonal().cwiseAbs().maxCoeff(), 0.02);
  EXPECT_GT((gain - Matrix3d::Identity()).norm(), 0.002);
  SimulationOptions other = usual;
  other.seed = 4;
  make_realistic(other);
  EXPECT_NE(other.imu.gyroscope_gain, gain);
}

TEST_F(Realism, StampsOutOfRangeAreRefused) {
  SimulationOptions wrong = options();
  wrong.stamps.jitter_s = 0.01;
  const auto report = simulate(wrong, folder_ / "wrong", Workers(1));
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("stamps.jitter_s"), std::string::npos);
}

TEST(RealisticMotion, MeetsItsPeaksAndComesBack) {
  const MotionSpan span{0, 250'000'000, 250'000'000 + 45'000'000'000};
  const Eigen::AlignedBox3d box(Vector3d(-0.6, -1.2, 1.1), Vector3d(0.6, 1.2, 1.65));
  for (const MotionPreset preset :
       {MotionPreset::realistic_scan, MotionPreset::realistic_turns, MotionPreset::realistic_revisit}) {
    SCOPED_TRACE(to_string(preset));
    EXPECT_TRUE(is_realistic(preset));
    const MotionOptions options = motion_preset(preset);
    const auto camera = hand_held_motion(options, span, box, 1);
    ASSERT_TRUE(camera) << camera.error().message;
    const PeakSpeeds peaks = peak_speeds(*camera, {}, span.first_frame_ns, span.last_frame_ns);
    EXPECT_NEAR(peaks.speed_mps, options.peak_speed_mps, 0.011 * options.peak_speed_mps);
    EXPECT_NEAR(peaks.rate_radps, options.peak_rate_radps, 0.011 * options.peak_rate_radps);
    if (options.revisit_s == 0) continue;
    const SE3 then = camera->evaluate(10'000'000'000).T_world_body;
    const SE3 later = camera->evaluate(30'000'000'000).T_world_body;
    const SE3 between = camera->evaluate(20'000'000'000).T_world_body;
    EXPECT_LT((then.translation - later.translation).norm(), 0.003);  // the tremor's
    EXPECT_LT(then.rotation.angularDistance(later.rotation), 0.01);
    EXPECT_GT(then.rotation.angularDistance(between.rotation), 1.0);  // half a turn in between
  }
  EXPECT_FALSE(is_realistic(MotionPreset::slow));
}

TEST(Office, HasDarkAndGlossyThingsAndFreeSpace) {
  const scene::SimulatedScene office = scene::make_office(1);
  EXPECT_EQ(office.gloss.size(), office.textures.size());
  EXPECT_GT(*std::ranges::max_element(office.gloss), 0.8F);
  EXPECT_GT(office.screens.pages, 1);
  for (const Eigen::Vector3f& vertex : office.mesh.vertices)
    ASSERT_FALSE(office.free_space.contains(vertex.cast<double>())) << vertex.transpose();
  EXPECT_EQ(office.mesh.vertices, scene::make_office(1).mesh.vertices);
  EXPECT_NE(office.mesh.vertices, scene::make_office(2).mesh.vertices);
}

}  // namespace
}  // namespace fusebench
