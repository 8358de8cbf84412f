#include "datasets/recording/formats/eth3d/eth3d_slam.hpp"

#include <gtest/gtest.h>

#include "tests/datasets/recording/formats/icl/icl_folder.hpp"

namespace fusebench {

using namespace images;
using namespace recording;
using namespace formats::eth3d;
using namespace datasets;

namespace {

using testing::expect_part;
using testing::refusal_message;

constexpr std::string_view kCalibrationToml =
    "[color]\nfx_px = 10\nfy_px = 11\ncx_px = 3.5\ncy_px = 2.5\n[imu]\n"
    "T_imu_color = [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0]\ngyroscope_noise_radps_sqrthz = 1e-3\n"
    "accelerometer_noise_mps2_sqrthz = 1e-2\ngyroscope_bias_walk_radps2_sqrthz = 1e-5\n"
    "accelerometer_bias_walk_mps3_sqrthz = 1e-4\n";

/// Three frames of 8x6 pixels from 61.045406 s with truth, in ETH3D's layout (which holds TUM's lists as
/// well).
class Eth3dFolder {
 public:
  Eth3dFolder() {
    for (const char* stamp : {"61.045406", "61.082306", "61.119206"}) {
      for (const char* kind : {"rgb", "depth"}) write(fmt::format("{}/{}.png", kind, stamp), "");
      EXPECT_TRUE(write_png(path() / "rgb" / fmt::format("{}.png", stamp), ColorImage(8, 6, Rgb{1, 2, 3})));
      EXPECT_TRUE(
          write_png(path() / "depth" / fmt::format("{}.png", stamp), Image<std::uint16_t>(8, 6, 10000)));
    }
    write("associated.txt", rows({"61.045406", "61.082306", "61.119206"}));
    write("rgb.txt", "61.045406 rgb/61.045406.png\n");
    write("depth.txt", "61.045406 depth/61.045406.png\n");
    write("calibration.txt", "10 11 3.5 2.5\n");
    write("groundtruth.txt", "# t\n61.04 1 2 3 0 0 0 1\n61.08 1 2 3 0 0 0 1\n61.12 1 2 3 0 0 0 1\n");
  }
  static std::string rows(const std::vector<std::string>& stamps) {
    std::string text;
    for (const std::string& t : stamps) text += fmt::format("{0} rgb/{0}.png {0} depth/{0}.png\n", t);
    return text;
  }
  void write(const std::string& name, std::string_view content) const { folder_.write(name, content); }
  void remove(const std::string& name) const { std::filesystem::remove(path() / name); }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  [[nodiscard]] Result<Recording> open() const { return open_recording(path()); }
  [[nodiscard]] std::string refusal(const std::string& name, std::string_view content) const {
    write(name, content);
    return refusal_message(open(), ErrorCode::data_corrupt);
  }

 private:
  testing::TemporaryFolder folder_;
};

TEST(Eth3dSlam, Opens) {
  const Eth3dFolder folder;
  EXPECT_EQ(recognise_format(folder.path()), "eth3d");
  const auto recording = folder.open();
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "eth3d");
  ASSERT_EQ(recording->frames.size(), 3U);
  EXPECT_EQ(recording->frames[1].timestamp_ns, 61'082'306'000);
  EXPECT_EQ(recording->frames[1].depth_capture_ns, 61'082'306'000);
  EXPECT_EQ(recording->rig.camera.fy_px, 11);
  EXPECT_EQ(recording->rig.camera.width_px, 8);
  EXPECT_EQ(recording->ground_truth.size(), 3U);
  EXPECT_EQ(recording->ground_truth[0].T_world_camera.translation, Vector3d(1, 2, 3))
      << "nothing is reflected here";
  EXPECT_TRUE(recording->warnings.empty());
  EXPECT_EQ(recording->load_frame(0).value().depth_m(0, 0), 2.0F);
}

TEST(Eth3dSlam, TestRecordingsHaveNoTruth) {
  const Eth3dFolder folder;
  folder.remove("groundtruth.txt");
  const auto recording = folder.open();
  ASSERT_TRUE(recording);
  EXPECT_TRUE(recording->ground_truth.empty());
}

TEST(Eth3dSlam, ImuIsOnlyUsedWhereItsPlaceIsKnown) {
  const Eth3dFolder folder;
  folder.write("imu.txt", "# t w a\n61.04 0.1 0.2 0.3 0 9.8 0\n61.05 0.1 0.2 0.3 0 9.8 0\n");
  const auto without = folder.open();
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_EQ(without->imu_source, ImuSource::none);
  EXPECT_TRUE(without->imu.empty());
  ASSERT_EQ(without->warnings.size(), 1U);
  for (const char* part :
       {"imu.txt: not used", "calibration.toml", "T_cam_imu", "camera_imu_calib_radtan.zip"})
    expect_part(without->warnings[0], part);
  folder.write("calibration.toml", kCalibrationToml);
  const auto with = folder.open();
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_EQ(with->imu_source, ImuSource::recorded);
  ASSERT_EQ(with->imu.size(), 2U);
  EXPECT_EQ(with->imu[0].angular_velocity_radps, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(with->imu[0].specific_force_mps2, Vector3d(0, 9.8, 0));
  EXPECT_EQ(with->rig.T_imu_camera.translation, Vector3d(0.1, 0, 0));
  ASSERT_EQ(with->warnings.size(), 1U);  // two samples do not surround the images
  expect_part(with->warnings[0], "frames are before the first or after the last inertial sample");
}

TEST(Eth3dSlam, RefusesAnImuOfAnotherClock) {
  const Eth3dFolder folder;
  folder.write("calibration.toml", kCalibrationToml);
  expect_part(folder.refusal("imu.txt", "1.0 0 0 0 0 9.8 0\n2.0 0 0 0 0 9.8 0\n"),
              "do not overlap the images");
  expect_part(folder.refusal("imu.txt", "61.1 0 0 0 0 9.8 0\n61.0 0 0 0 0 9.8 0\n"),
              "imu.txt:2: time runs backwards");
  expect_part(folder.refusal("imu.txt", "61.1 0 0 0 0 9.8\n"), "imu.txt:1: expected 7 columns");
}

TEST(Eth3dSlam, RefusesBadFiles) {
  const auto after_writing = [](const std::string& name, std::string_view content) {
    return Eth3dFolder().refusal(name, content);
  };
  expect_part(after_writing("calibration.txt", "10 11 3.5\n"), "calibration.txt:1: expected 4 columns");
  expect_part(after_writing("calibration.txt", "10 -11 3.5 2.5\n"), "must be above 0");
  expect_part(after_writing("calibration.txt", "10 11 1e300 2.5\n"), "at most 1e+06 pixels");
  expect_part(after_writing("calibration.txt", "1 1 1 1\n1 1 1 1\n"), "calibration.txt:2: a second row");
  expect_part(after_writing("calibration.txt", "# none\n"), "has no row");
  expect_part(after_writing("associated.txt", Eth3dFolder::rows({"61.082306", "61.045406"})),
              "associated.txt:2: time 61.045406 does not come after 61.082306");
  expect_part(after_writing("associated.txt", Eth3dFolder::rows({"61.045406", "61.045406"})),
              "does not come after");
  expect_part(after_writing("associated.txt", "x rgb/61.045406.png 61 depth/61.045406.png\n"),
              "associated.txt:1: expected a time in decimal seconds");
  expect_part(after_writing("associated.txt", "\n"), "has no rows");
  const Eth3dFolder folder;
  folder.remove("depth/61.082306.png");
  expect_part(refusal_message(folder.open(), ErrorCode::data_missing), "associated.txt:2: image ");
}

TEST(Eth3dSlam, WindowsLineEndsAndOrderOfColumns) {
  const Eth3dFolder folder;
  const std::string fingerprint = folder.open().value().fingerprint;
  folder.write("associated.txt",
               "61.045406 depth/61.045406.png 61.045406 rgb/61.045406.png\r\n"
               "61.082306 rgb/61.082306.png 61.082306 depth/61.082306.png\r\n"
               "61.119206 rgb/61.119206.png 61.119206 depth/61.119206.png\r\n");
  EXPECT_EQ(folder.open().value().fingerprint, fingerprint);
}

}  // namespace
}  // namespace fusebench
