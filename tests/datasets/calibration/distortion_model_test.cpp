#include "datasets/calibration/distortion_model.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace calibration;

namespace {

using testing::expect_contains;

constexpr std::array<double, 4> kFour = {0.1, -0.2, 0.003, -0.004};

TEST(DistortionModel, EveryNameOfRadialTangentialDistortion) {
  for (const char* name :
       {"radial-tangential", "radial_tangential", "RadTan", "radtan", "plumb_bob", "Plumb Bob", "brown",
        "Brown Conrady", "brown_conrady", "OpenCV", "pinhole-radtan", ""}) {
    const auto distortion = distortion_of_model(name, kFour);
    ASSERT_TRUE(distortion) << name << ": " << distortion.error().message;
    EXPECT_EQ(distortion->k1, 0.1);
    EXPECT_EQ(distortion->k2, -0.2);
    EXPECT_EQ(distortion->p1, 0.003);
    EXPECT_EQ(distortion->p2, -0.004);
    EXPECT_EQ(distortion->k3, 0);
  }
}

TEST(DistortionModel, FifthCoefficientIsK3AndOthersMustBeZero) {
  const std::array<double, 8> eight = {0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0};
  EXPECT_EQ(distortion_of_model("plumb_bob", eight).value().k3, 0.5);
  const std::array<double, 8> rational = {0.1, 0.2, 0.3, 0.4, 0.5, 0, 0.1, 0};
  const auto refused = distortion_of_model("plumb_bob", rational);
  ASSERT_FALSE(refused);
  expect_contains(refused.error().message, "8 coefficients (supported are k1 k2 p1 p2 k3");
}

TEST(DistortionModel, OtherModelsAreRefusedWithTheSupportedNames) {
  for (const char* name : {"equidistant", "kannala_brandt", "fisheye", "fov", "rational_polynomial",
                           "inverse_brown_conrady", "modified_brown_conrady"}) {
    const auto refused = distortion_of_model(name, kFour);
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, ErrorCode::data_corrupt);
    expect_contains(refused.error().message, std::string(name) + " is not supported");
    expect_contains(refused.error().message, "radtan, plumb_bob, brown_conrady or opencv");
    expect_contains(refused.error().hint, "undistort the images");
  }
}

TEST(DistortionModel, CoefficientsOfZeroAreNoDistortionUnderAnyName) {
  const std::array<double, 4> none{};
  for (const char* name : {"equidistant", "inverse_brown_conrady", "of a maker"})
    EXPECT_TRUE(distortion_of_model(name, none).value().is_zero()) << name;
  EXPECT_TRUE(distortion_of_model("fisheye", {}).value().is_zero());
}

}  // namespace
}  // namespace fusebench
