#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "datasets/calibration/infinitam_calibration.hpp"
#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/recording/formats/zr300/zr300.hpp"
#include "tests/datasets/recording/formats/zr300/zr300_folder.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace images;
using namespace calibration;
using namespace recording;
using namespace formats::zr300;

namespace {

using testing::any_contains;
using testing::expect_contains;
using testing::kFmDatasetCalibTxt;
using testing::Zr300Folder;

/// A scene's folder with one sequence in it, whose images have the ZR300's size.
class Scene {
 public:
  Scene() {
    for (const char* folder : {"color", "depth"}) scene_.write(fmt::format("slow/{}/x", folder), "");
    EXPECT_TRUE(write_png(sequence() / "color" / "a.png", ColorImage(640, 480, Rgb{10, 20, 30})));
    EXPECT_TRUE(write_png(sequence() / "depth" / "a.png", Image<std::uint16_t>(640, 480, 2000)));
    write("slow/TIMESTAMP.txt", "755517,a.png,a.png\n788792,a.png,a.png\n");
    write("slow/IMU.txt", Zr300Folder::imu_rows(1, 750'000, 20));
  }
  void write(const std::string& name, std::string_view content) const { scene_.write(name, content); }
  [[nodiscard]] std::filesystem::path sequence() const { return scene_.path() / "slow"; }

 private:
  testing::TemporaryFolder scene_;
};

TEST(Zr300Calibration, WithoutAnyThePublishedOneIsUsed) {
  const Scene scene;
  const auto recording = open_zr300(scene.sequence() / "", {});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(any_contains(recording->notes, "calibration: published for FMDataset's ZR300 ("));
  EXPECT_EQ(recording->rig.camera.fx_px, 608.446);
  EXPECT_LT((recording->rig.T_imu_camera.translation - Vector3d(0.093775, 0.003211, 0.001930)).norm(), 1e-5);
  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame) << frame.error().message;
  // A wall at 2 m before the depth camera; the colour camera is 2 mm nearer, and turned by 0.4 degrees.
  EXPECT_NEAR(frame->depth_m(331, 245), 2.0 - 0.002205, 1e-3);
}

TEST(Zr300Calibration, CalibTxtOfTheSceneGoesBeforeThePublishedOne) {
  const Scene scene;
  std::string calib(kFmDatasetCalibTxt);
  scene.write("calib.txt", calib.replace(calib.find("608.446"), 7, "608.000"));
  const auto of_scene = open_zr300(scene.sequence(), {});
  ASSERT_TRUE(of_scene) << of_scene.error().message;
  EXPECT_EQ(of_scene->rig.camera.fx_px, 608);
  EXPECT_TRUE(any_contains(of_scene->notes, "calib.txt, with the published distortion of FMDataset's ZR300"));
  scene.write("slow/calib.txt", calib.replace(calib.find("608.000"), 7, "630.000"));
  const auto of_sequence = open_zr300(scene.sequence(), {});
  ASSERT_TRUE(of_sequence) << of_sequence.error().message;
  EXPECT_EQ(of_sequence->rig.camera.fx_px, 630);
  EXPECT_TRUE(any_contains(of_sequence->notes, "calib.txt, without distortion"));
  RigCalibration own = Zr300Folder::calibration();
  own.color.pinhole = {640, 480, 601, 602, 320, 240};
  own.depth.reset();
  scene.write("slow/calibration.toml", to_toml(own));
  const auto with_own = open_zr300(scene.sequence(), {});
  ASSERT_TRUE(with_own) << with_own.error().message;
  EXPECT_EQ(with_own->rig.camera.fx_px, 601);
  ReadOptions options;
  options.camera = CalibratedCamera{{640, 480, 555, 556, 320, 240}, {}, {}};
  EXPECT_EQ(open_zr300(scene.sequence(), options)->rig.camera.fx_px, 555);
}

TEST(Zr300Calibration, ABrokenCalibTxtIsAnError) {
  const Scene scene;
  scene.write("calib.txt", "640 480\n608 607\n");
  const auto recording = open_zr300(scene.sequence(), {});
  ASSERT_FALSE(recording);
  expect_contains(recording.error().message, "calib.txt: ends before colour cx");
}

TEST(Zr300Calibration, InfiniTamsDirectionIsNoticed) {
  const Scene scene;
  std::string calib(kFmDatasetCalibTxt);
  scene.write("calib.txt", calib.replace(calib.find("-0.057460"), 9, "0.0574600"));
  const auto recording = open_zr300(scene.sequence(), {});
  ASSERT_FALSE(recording);
  expect_contains(recording.error().message, "puts the colour camera left of the depth camera");
}

class CalibTxt : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] Result<RigCalibration> with(std::string_view part, std::string_view instead) const {
    std::string text(kFmDatasetCalibTxt);
    if (!part.empty()) text.replace(text.find(part), part.size(), instead);
    return read_infinitam_calibration(write("calib.txt", text));
  }
  [[nodiscard]] std::string refusal(std::string_view part, std::string_view instead) const {
    const auto calibration = with(part, instead);
    if (calibration) return "was not refused";
    EXPECT_EQ(calibration.error().code, ErrorCode::data_corrupt);
    return calibration.error().message;
  }
};

TEST_F(CalibTxt, IsTheShippedCalibration) {
  const auto calibration = with("", "");
  ASSERT_TRUE(calibration) << calibration.error().message;
  const auto shipped = catalogue_calibration("zr300_fmdataset");
  ASSERT_TRUE(shipped) << shipped.error().message;
  EXPECT_EQ(calibration->color.pinhole.cx_px, shipped->color.pinhole.cx_px);
  EXPECT_EQ(calibration->depth->pinhole.cy_px, shipped->depth->pinhole.cy_px);
  EXPECT_EQ(calibration->depth_units_per_metre, 1000.0);
  EXPECT_LT(
      (calibration->depth->T_color_depth.rotation_matrix() - shipped->depth->T_color_depth.rotation_matrix())
          .norm(),
      1e-12);
  EXPECT_EQ(calibration->depth->T_color_depth.translation, shipped->depth->T_color_depth.translation);
  EXPECT_LT((calibration->imu->T_imu_camera.rotation_matrix() - shipped->imu->T_imu_camera.rotation_matrix())
                .norm(),
            1e-12);
  const ImuNoise& noise = calibration->imu->noise;
  const ImuNoise& shipped_noise = shipped->imu->noise;
  EXPECT_NEAR(noise.gyroscope_radps_sqrthz / shipped_noise.gyroscope_radps_sqrthz, 1, 1e-4);
  EXPECT_NEAR(noise.accelerometer_mps2_sqrthz / shipped_noise.accelerometer_mps2_sqrthz, 1, 1e-4);
  EXPECT_NEAR(noise.gyroscope_bias_radps2_sqrthz / shipped_noise.gyroscope_bias_radps2_sqrthz, 1, 1e-4);
  EXPECT_NEAR(noise.accelerometer_bias_mps3_sqrthz / shipped_noise.accelerometer_bias_mps3_sqrthz, 1, 1e-4);
}

TEST_F(CalibTxt, ImuAndColourAreChainedThroughDepth) {
  const auto calibration = with("", "");
  ASSERT_TRUE(calibration);
  const SE3& T_imu_color = calibration->imu->T_imu_camera;
  Matrix3d expected;
  expected << 0.999835, 0.014512, -0.010932, -0.014281, 0.999679, 0.020920, 0.011232, -0.020761, 0.999721;
  EXPECT_LT((T_imu_color.rotation_matrix() - expected).cwiseAbs().maxCoeff(), 1e-5);
  // The translation that the authors give elsewhere (rovio.info), which confirms both directions.
  EXPECT_LT((T_imu_color.translation - Vector3d(0.093775, 0.003211, 0.001930)).cwiseAbs().maxCoeff(), 2e-6);
}

TEST_F(CalibTxt, InfiniTamsOwnLayoutHasNoImu) {
  std::string text(kFmDatasetCalibTxt);
  const std::size_t imu = text.find("    0.999758");
  text.erase(imu, text.find("affine") - imu);
  text.erase(text.find("4e-7"));
  const auto calibration = read_infinitam_calibration(write("calib.txt", text));
  ASSERT_TRUE(calibration) << calibration.error().message;
  EXPECT_FALSE(calibration->imu);
  EXPECT_EQ(calibration->depth_units_per_metre, 1000.0);
}

TEST_F(CalibTxt, RefusesWhatItCannotTrust) {
  expect_contains(refusal("-0.00069964811 -0.0062491186", "0.5 -0.0062491186"),
                  "calib.txt:12: T_color_depth is no rigid transform");
  expect_contains(refusal("0.999964058", "-0.999964058"),
                  "calib.txt:12: T_color_depth is no rigid transform");
  expect_contains(refusal("0.0174598", "x"), "calib.txt:16: T_imu_depth: expected a finite number, got 'x'");
  expect_contains(refusal("608.446", "-608"), "calib.txt:3: colour fx = -608 (allowed: above 0");
  expect_contains(refusal("affine", "kinect"), "calib.txt:18: ");
  expect_contains(refusal("0.001 0.0\n", "0.001 0.5\n"), "calib.txt:18: the offset of depth must be 0");
  expect_contains(refusal("1.22e-6", ""), "calib.txt: ends before variance of the gyroscope");
  expect_contains(refusal("1.22e-6", "0"), "calib.txt:20: variance of the gyroscope = 0");
  expect_contains(refusal("1.22e-6", "1.22e-6 7"),
                  "calib.txt:20: there are more numbers after the last block");
  EXPECT_EQ(read_infinitam_calibration("/nonexistent/calib.txt").error().code, ErrorCode::data_missing);
}

}  // namespace
}  // namespace fusebench
