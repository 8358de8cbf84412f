#include "datasets/calibration/rig_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "datasets/calibration/recording_catalogue.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace config;
using namespace calibration;

namespace {

RigCalibration whole_calibration() {
  RigCalibration c;
  c.source = "measured \"by hand\", 2019";
  c.color.pinhole = {640, 480, 608.446, 607.847, 331.332, 245.549};
  c.color.distortion = {0.0644, -0.114, 0.00127, 0.00203, 1.0 / 3.0};
  c.color.ground_truth_offset_m = {0.034, -1.0 / 3.0, 0.014};
  c.color.timing = {0.0261, 0.0305, -0.018};
  c.depth_units_per_metre = 1000.5;
  c.depth = DepthCamera{{628, 468, 583.98, 583.98, 325.103, 240.718},
                        {so3_exp({0.01, -0.2, 0.3}), {-0.057460, -0.001073, -0.002205}}};
  c.imu = ImuCalibration{{so3_exp({2.0, -1.0, 0.5}), {0.1, 0.2, 1.0 / 7.0}},
                         {1e-3, 2e-2, 5e-5, 6e-4},
                         -0.0125,
                         {1.02, 0.985, 1.0},
                         {1.0, 1.0 / 1.01, 0.99}};
  return c;
}

Result<RigCalibration> read(std::string_view text) {
  const auto document = parse_toml(text, "c.toml");
  if (!document) return tl::unexpected(document.error());
  return rig_calibration(*document, "c.toml");
}

/// The message of the expected error.
std::string refusal(std::string_view text) {
  const auto calibration = read(text);
  if (calibration) return "was not refused";
  EXPECT_EQ(calibration.error().code, ErrorCode::configuration);
  return calibration.error().message;
}

void expect_equal(const PinholeCamera& a, const PinholeCamera& b) {
  EXPECT_EQ(a.width_px, b.width_px);
  EXPECT_EQ(a.height_px, b.height_px);
  EXPECT_EQ(a.fx_px, b.fx_px);
  EXPECT_EQ(a.fy_px, b.fy_px);
  EXPECT_EQ(a.cx_px, b.cx_px);
  EXPECT_EQ(a.cy_px, b.cy_px);
}

void expect_equal(const SE3& a, const SE3& b) {
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_LT((a.rotation_matrix() - b.rotation_matrix()).cwiseAbs().maxCoeff(), 1e-15);
}

constexpr std::string_view kColor = "[color]\nfx_px = 500\nfy_px = 501.5\ncx_px = 320\ncy_px = 240\n";
constexpr std::string_view kNoise =
    "gyroscope_noise_radps_sqrthz = 1e-3\naccelerometer_noise_mps2_sqrthz = 2e-2\n"
    "gyroscope_bias_walk_radps2_sqrthz = 5e-5\naccelerometer_bias_walk_mps3_sqrthz = 6e-4\n";
constexpr std::string_view kIdentity = "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n";

std::string with_color(std::string_view rest) { return std::string(kColor) + std::string(rest); }
std::string with_imu(std::string_view rest) {
  return with_color("[imu]\n" + std::string(kNoise) + std::string(rest));
}

TEST(RigCalibration, ReadsBackWhatItWrites) {
  const RigCalibration before = whole_calibration();
  const auto after = read(to_toml(before));
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(after->source, before.source);
  EXPECT_EQ(after->color.ground_truth_offset_m, before.color.ground_truth_offset_m);
  expect_equal(after->color.pinhole, before.color.pinhole);
  const BrownConrady& d = after->color.distortion;
  EXPECT_EQ(d.k1, 0.0644);
  EXPECT_EQ(d.k2, -0.114);
  EXPECT_EQ(d.p1, 0.00127);
  EXPECT_EQ(d.p2, 0.00203);
  EXPECT_EQ(d.k3, 1.0 / 3.0);
  EXPECT_EQ(after->color.timing.color_readout_s, 0.0261);
  EXPECT_EQ(after->color.timing.depth_readout_s, 0.0305);
  EXPECT_EQ(after->color.timing.depth_delay_s, -0.018);
  EXPECT_EQ(after->depth_units_per_metre, 1000.5);
  ASSERT_TRUE(after->depth && after->imu);
  expect_equal(after->depth->pinhole, before.depth->pinhole);
  expect_equal(after->depth->T_color_depth, before.depth->T_color_depth);
  expect_equal(after->imu->T_imu_camera, before.imu->T_imu_camera);
  EXPECT_EQ(after->imu->noise.gyroscope_radps_sqrthz, 1e-3);
  EXPECT_EQ(after->imu->noise.accelerometer_mps2_sqrthz, 2e-2);
  EXPECT_EQ(after->imu->noise.gyroscope_bias_radps2_sqrthz, 5e-5);
  EXPECT_EQ(after->imu->noise.accelerometer_bias_mps3_sqrthz, 6e-4);
  EXPECT_EQ(after->imu->time_offset_s, -0.0125);
  EXPECT_EQ(after->imu->gyroscope_scale, before.imu->gyroscope_scale);
  EXPECT_EQ(after->imu->accelerometer_scale, before.imu->accelerometer_scale);
}

/// A calibration whose numbers are drawn between the bounds of their keys; at a bound in two of three cases.
class AnyCalibration {
 public:
  explicit AnyCalibration(unsigned seed) : random_(seed) {}

  [[nodiscard]] RigCalibration next() {
    RigCalibration c;
    c.color.pinhole = pinhole(flip());
    c.color.distortion = {number(-10, 10), number(-10, 10), number(-1, 1), number(-1, 1), number(-10, 10)};
    c.color.ground_truth_offset_m = vector(-kMostLeverArm_m, kMostLeverArm_m);
    c.color.timing = {readout(), readout(), delay(), readout(), readout(), std::abs(delay())};
    if (flip()) c.depth_units_per_metre = number(0.1, 1e6);
    if (flip()) c.depth = DepthCamera{pinhole(true), transform()};
    if (flip())
      c.imu = ImuCalibration{transform(),
                             {number(1e-9, 100), number(1e-9, 100), number(0, 100), number(0, 100)},
                             delay(),
                             vector(0.5, 2),
                             vector(0.5, 2)};
    return c;
  }

 private:
  bool flip() { return random_() % 2 == 0; }
  double number(double least, double most) {
    const auto choice = random_() % 3;
    return choice == 0 ? least : choice == 1 ? most : std::uniform_real_distribution(least, most)(random_);
  }
  Vector3d vector(double least, double most) {
    return {number(least, most), number(least, most), number(least, most)};
  }
  double readout() { return number(0, kMostReadout_s); }
  double delay() { return number(-kMostDelay_s, kMostDelay_s); }
  SE3 transform() { return {so3_exp(vector(-3, 3)), vector(-kMostLeverArm_m, kMostLeverArm_m)}; }
  PinholeCamera pinhole(bool with_size) {
    PinholeCamera p{0, 0, number(1e-3, 1e6), number(1e-3, 1e6), number(-1e6, 1e6), number(-1e6, 1e6)};
    if (with_size) {
      p.width_px = static_cast<int>(number(1, kMostSize_px));
      p.height_px = static_cast<int>(number(1, kMostSize_px));
    }
    return p;
  }

  std::mt19937 random_;
};

TEST(RigCalibration, EveryCalibrationWithinTheBoundsReadsBack) {
  AnyCalibration any(1);
  for (int i = 0; i < 300; ++i) {
    const RigCalibration before = any.next();
    const std::string text = to_toml(before);
    const auto after = read(text);
    ASSERT_TRUE(after) << after.error().message << "\n" << text;
    EXPECT_TRUE(check_readable(text, "c.toml"));
    expect_equal(after->color.pinhole, before.color.pinhole);
    EXPECT_EQ(after->color.timing.color_readout_s, before.color.timing.color_readout_s);
    EXPECT_EQ(after->color.timing.depth_delay_sigma_s, before.color.timing.depth_delay_sigma_s);
    EXPECT_EQ(after->depth.has_value(), before.depth.has_value());
    EXPECT_EQ(after->depth_units_per_metre, before.depth_units_per_metre);
    ASSERT_EQ(after->imu.has_value(), before.imu.has_value());
    if (after->imu) {
      EXPECT_EQ(after->imu->gyroscope_scale, before.imu->gyroscope_scale);
    }
  }
}

TEST(RigCalibration, WhatCouldNotBeReadIsNotWritten) {
  RigCalibration c = whole_calibration();
  c.color.timing.color_readout_s = -9.3e-5;
  const auto refused = check_readable(to_toml(c), "c.toml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.find("not written, since it could not be read: c.toml:"), 0U)
      << refused.error().message;
  EXPECT_NE(refused.error().message.find("color.readout_s must be a number from 0 to 1"), std::string::npos);
}

TEST(RigCalibration, ScalesOfTheImuAreNearOneAndOtherwiseOne) {
  const std::string imu = "T_imu_color = " + std::string(kIdentity);
  const auto without = read(with_imu(imu));
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_EQ(without->imu->gyroscope_scale, Vector3d::Ones());
  EXPECT_EQ(to_toml(*without).find("_scale"), std::string::npos);
  EXPECT_NE(refusal(with_imu(imu + "gyroscope_scale = [1, 1, 2.5]\n")).find("from 0.5 to 2"),
            std::string::npos);
  EXPECT_NE(refusal(with_imu(imu + "accelerometer_scale = [1, 1]\n")).find("3 finite numbers"),
            std::string::npos);
}

TEST(RigCalibration, ColourAloneIsEnough) {
  RigCalibration before;
  before.color.pinhole = {0, 0, 500, 501, 320, 240};
  const auto after = read(to_toml(before));
  ASSERT_TRUE(after) << after.error().message;
  expect_equal(after->color.pinhole, before.color.pinhole);
  EXPECT_TRUE(after->color.distortion.is_zero() && !after->depth && !after->imu &&
              !after->depth_units_per_metre);
  EXPECT_TRUE(after->source.empty());
}

TEST(RigCalibration, ImuBesideTheDepthCamera) {
  const auto calibration =
      read(with_color("[depth]\nwidth_px = 640\nheight_px = 480\nfx_px = 1\nfy_px = 1\ncx_px = 0\ncy_px = 0\n"
                      "T_color_depth = [0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 1, 0.3]\n"
                      "[imu]\nT_imu_depth = [1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3]\n" +
                      std::string(kNoise)));
  ASSERT_TRUE(calibration) << calibration.error().message;
  // The point that both transforms map to: depth's origin.
  const Vector3d in_color = calibration->depth->T_color_depth * Vector3d::Zero();
  EXPECT_EQ(in_color, Vector3d(0.1, 0.2, 0.3));
  EXPECT_LT((calibration->imu->T_imu_camera * in_color - Vector3d(1, 2, 3)).norm(), 1e-14);
  EXPECT_LT((calibration->imu->T_imu_camera * (calibration->depth->T_color_depth * Vector3d(1, 0, 0)) -
             Vector3d(2, 2, 3))
                .norm(),
            1e-14);
}

TEST(RigCalibration, RoundedMatricesAreMadeOrthonormal) {
  const auto calibration =
      read(with_imu("T_imu_color = [0.9998, 0.0139, -0.0171, 0, -0.0134, 0.9996, 0.0267, 0, 0.0175, -0.0265, "
                    "0.9995, 0]\n"));
  ASSERT_TRUE(calibration) << calibration.error().message;
  EXPECT_NEAR(calibration->imu->T_imu_camera.rotation.norm(), 1, 1e-15);
  EXPECT_NEAR(calibration->imu->T_imu_camera.rotation_matrix()(0, 1), 0.0139, 3e-4);
}

TEST(RigCalibration, RefusesWhatIsNoRigidTransform) {
  const std::string rule = "c.toml:11: imu.T_imu_color is no rigid transform";
  const auto with_matrix = [](std::string_view m) {
    return refusal(with_imu("T_imu_color = " + std::string(m) + "\n"));
  };
  EXPECT_EQ(with_matrix("[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0]"), rule) << "a reflection";
  EXPECT_EQ(with_matrix("[1000, 0, 0, 0, 0, 1000, 0, 0, 0, 0, 1000, 0]"), rule) << "a scale";
  EXPECT_EQ(with_matrix("[1, 0, 0, 0, 1, 0, 0, 0, 1, 0.1, 0.2, 0.3]"), rule) << "column by column";
  EXPECT_EQ(with_matrix("[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]"), rule);
  EXPECT_EQ(with_matrix("[1, 0, 0, 0, 0, 1, 0, -1e300, 0, 0, 1, 0]"),
            "c.toml:11: imu.T_imu_color has a translation of 1e+300 m (allowed up to 1000 m)");
  const std::string count = "c.toml:11: imu.T_imu_color must be a list of 12 finite numbers";
  EXPECT_EQ(with_matrix("[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"), count);
  EXPECT_EQ(with_matrix("[1, 0, 0, nan, 0, 1, 0, 0, 0, 0, 1, 0]"), count);
  EXPECT_EQ(with_matrix("[1, 0, 0, \"0\", 0, 1, 0, 0, 0, 0, 1, 0]"), count);
  EXPECT_EQ(with_matrix("1"), count);
}

TEST(RigCalibration, ErrorsNameThePlace) {
  EXPECT_EQ(refusal(""), "c.toml: [color] needs the key fx_px");
  EXPECT_EQ(refusal("\n[color]\nfx_px = 500\nfy_px = 500\ncx_px = 320\n"),
            "c.toml:2: [color] needs the key cy_px");
  EXPECT_EQ(refusal(with_color("focal = 1\n")), "c.toml:6: unknown key 'color.focal'");
  EXPECT_EQ(refusal(with_color("width_px = 640\n")), "c.toml:1: [color] needs the key height_px");
  EXPECT_EQ(refusal(with_color("width_px = 640.5\nheight_px = 480\n")),
            "c.toml:6: color.width_px must be a whole number");
  EXPECT_EQ(refusal(with_color("width_px = 100001\nheight_px = 480\n")),
            "c.toml:6: color.width_px must be a number from 1 to 100000");
  EXPECT_EQ(refusal(with_color("distortion = [1, 2, 3, 4]\n")),
            "c.toml:6: color.distortion must be a list of 5 finite numbers");
  EXPECT_EQ(refusal("[color]\nfx_px = -500\n"),
            "c.toml:2: color.fx_px must be a number from 0.001 to 1000000");
  EXPECT_EQ(refusal("[color]\nfx_px = \"500\"\n"),
            "c.toml:2: color.fx_px must be a number from 0.001 to 1000000");
  EXPECT_EQ(refusal(with_color("readout_s = 33\n")),
            "c.toml:6: color.readout_s must be a number from 0 to 1");
  EXPECT_EQ(refusal(with_color("[depth]\nunits_per_metre = 0\n")),
            "c.toml:7: depth.units_per_metre = 0 (allowed: 0.1 to 1000000 units per metre)");
  EXPECT_EQ(refusal(with_color("[depth]\nunits_per_metre = 0.001\n")),
            "c.toml:7: depth.units_per_metre = 0.001 (allowed: 0.1 to 1000000 units per metre)");
  EXPECT_EQ(refusal("calibration_source = 3\n" + std::string(kColor)),
            "c.toml:1: calibration_source must be a text");
  EXPECT_EQ(refusal(with_color("[imu]\nT_imu_color = " + std::string(kIdentity))),
            "c.toml:6: [imu] needs the key gyroscope_noise_radps_sqrthz");
}

TEST(RigCalibration, ATimingThatIsNotSaidIsUncertain) {
  const auto timing = [](const std::string& keys) {
    const auto calibration = read(with_color(keys));
    EXPECT_TRUE(calibration.has_value());
    return calibration->color.timing;
  };
  EXPECT_EQ(timing("").color_readout_sigma_s, kUnknownReadoutSigma_s);
  EXPECT_EQ(timing("readout_s = 0.02\n").color_readout_sigma_s, 0);
  EXPECT_EQ(timing("readout_s = 0.02\nreadout_sigma_s = 0.003\n").color_readout_sigma_s, 0.003);
}

TEST(RigCalibration, TheCameraMayBeBesideThePointThatTheTruthIsOf) {
  EXPECT_EQ(refusal(with_color("ground_truth_offset_m = [0.03, 0]\n")),
            "c.toml:6: color.ground_truth_offset_m must be a list of 3 finite numbers");
  EXPECT_EQ(refusal(with_color("ground_truth_offset_m = [30, 2000, 10]\n")),
            "c.toml:6: color.ground_truth_offset_m has a component of 2000 m (allowed up to 1000 m)");
}

TEST(RigCalibration, RefusesAnImuWithoutNoise) {
  EXPECT_EQ(refusal(with_color("[imu]\nT_imu_color = " + std::string(kIdentity) +
                               "gyroscope_noise_radps_sqrthz = 0\n")),
            "c.toml:8: imu.gyroscope_noise_radps_sqrthz must be a number from 1e-09 to 100");
}

TEST(RigCalibration, PartsThatNeedEachOther) {
  const std::string camera = "width_px = 8\nheight_px = 6\nfx_px = 1\nfy_px = 1\ncx_px = 0\ncy_px = 0\n";
  EXPECT_NE(
      refusal(with_color("[depth]\n" + camera)).find("c.toml:6: [depth] with intrinsics needs T_color_depth"),
      std::string::npos);
  EXPECT_EQ(refusal(with_color("[depth]\nT_color_depth = " + std::string(kIdentity))),
            "c.toml:6: [depth] needs the key width_px");
  EXPECT_EQ(refusal(with_color("[depth]\nwidth_px = 640\n")), "c.toml:6: [depth] needs the key height_px");
  EXPECT_EQ(refusal(with_imu("")), "c.toml:6: [imu] needs either T_imu_color or T_imu_depth");
  EXPECT_EQ(refusal(with_imu("T_imu_depth = " + std::string(kIdentity) +
                             "T_imu_color = " + std::string(kIdentity))),
            "c.toml:6: [imu] needs either T_imu_color or T_imu_depth");
  EXPECT_EQ(refusal(with_imu("T_imu_depth = " + std::string(kIdentity))),
            "c.toml:6: [imu] T_imu_depth needs a depth camera of its own ([depth] with T_color_depth)");
}

using CalibrationBeside = testing::InTemporaryFolder;

TEST_F(CalibrationBeside, IsReadIfItIsThere) {
  const auto none = read_calibration_beside(folder_);
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->has_value());
  write("calibration.toml", kColor);
  const auto some = read_calibration_beside(folder_);
  ASSERT_TRUE(some && *some);
  EXPECT_EQ((*some)->color.pinhole.fy_px, 501.5);
  write("calibration.toml", with_color("[camera]\nfx_px = 3\n"));
  const auto unknown = read_calibration_beside(folder_);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("calibration.toml:7: unknown key 'camera.fx_px'"),
            std::string::npos);
}

}  // namespace
}  // namespace fusebench
