#include "datasets/calibration/camera_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/calibration/camera_presets.hpp"

namespace fusebench {

using namespace calibration;

namespace {

CalibratedCamera freiburg1() { return parse_camera("freiburg1").value(); }

TEST(BrownConrady, DistortInvertsUndistortOverTheWholeImage) {
  for (const char* name : {"freiburg1", "freiburg2"}) {
    const CalibratedCamera camera = parse_camera(name).value();
    for (int y = 0; y < 480; y += 7) {
      for (int x = 0; x < 640; x += 7) {
        const Vector2d point = camera.pinhole.back_project(x, y, 1.0).head<2>();
        EXPECT_LT((camera.distortion.distort(camera.distortion.undistort(point)) - point).norm(), 1e-12)
            << name << " " << x << " " << y;
      }
    }
  }
}

TEST(BrownConrady, EachCoefficientActsAsItsFormulaSays) {
  const Vector2d p(0.3, -0.2);
  const double r2 = 0.13;
  const auto moved = [&](const BrownConrady& d) { return Vector2d(d.distort(p) - p); };
  EXPECT_TRUE(moved({0.1, 0, 0, 0, 0}).isApprox(0.1 * r2 * p, 1e-12));
  EXPECT_TRUE(moved({0, 0.1, 0, 0, 0}).isApprox(0.1 * r2 * r2 * p, 1e-12));
  EXPECT_TRUE(moved({0, 0, 0, 0, 0.1}).isApprox(0.1 * r2 * r2 * r2 * p, 1e-12));
  EXPECT_TRUE(moved({0, 0, 0.1, 0, 0}).isApprox(0.1 * Vector2d(2 * 0.3 * -0.2, r2 + 2 * 0.04), 1e-12));
  EXPECT_TRUE(moved({0, 0, 0, 0.1, 0}).isApprox(0.1 * Vector2d(r2 + 2 * 0.09, 2 * 0.3 * -0.2), 1e-12));
}

Rgb pattern(double u, double v) {
  const auto level = [](double s) { return static_cast<std::uint8_t>(std::lround(128 + 100 * s)); };
  return {level(std::sin(0.05 * u)), level(std::cos(0.04 * v)), level(std::sin(0.03 * (u + v)))};
}

TEST(Undistortion, RestoresAPatternSeenThroughTheLens) {
  const CalibratedCamera camera = freiburg1();
  const PinholeCamera& pinhole = camera.pinhole;
  ColorImage seen(640, 480);
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      const Vector2d ideal = camera.distortion.undistort(pinhole.back_project(x, y, 1.0).head<2>());
      const Vector2d pixel = pinhole.project(ideal.homogeneous());
      seen(x, y) = pattern(pixel.x(), pixel.y());
    }
  }
  const Undistortion undistortion(camera);
  const ColorImage restored = undistortion.undistort_color(seen);
  const DepthImage inside = undistortion.undistort_depth(DepthImage(640, 480, 1.0F));
  int compared = 0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      if (inside(x, y) == 0) continue;
      const Vector2d source =
          pinhole.project(camera.distortion.distort(pinhole.back_project(x, y, 1.0).head<2>()).homogeneous());
      if (source.x() < 0 || source.y() < 0 || source.x() > 639 || source.y() > 479) continue;
      ++compared;
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(restored(x, y)[c], pattern(x, y)[c], 2) << x << " " << y;
      }
    }
  }
  EXPECT_GT(compared, 280'000);  // 17 318 pixels of freiburg1 have no source (counted with OpenCV's own map)
}

TEST(Undistortion, PixelsWithoutSourceHaveNoDepthAndTheBordersColour) {
  const Undistortion undistortion(freiburg1());
  const auto depth = undistortion.undistort_depth(DepthImage(640, 480, 5.0F));
  const ColorImage color = undistortion.undistort_color(ColorImage(640, 480, Rgb{200, 150, 100}));
  EXPECT_EQ(depth(0, 0), 0);  // its source is (-23.8, -21.4)
  EXPECT_EQ(depth(320, 240), 5.0F);
  EXPECT_NEAR(static_cast<double>(std::count(depth.data.begin(), depth.data.end(), 0.0F)), 17318, 20);
  for (const Rgb& c : color.data) ASSERT_EQ(c, (Rgb{200, 150, 100}));
}

TEST(Undistortion, DepthKeepsMeasuredValues) {
  DepthImage depth(640, 480, 1.0F);
  for (int y = 0; y < 480; ++y) {
    for (int x = 320; x < 640; ++x) depth(x, y) = 3.0F;
  }
  for (const float value : Undistortion(freiburg1()).undistort_depth(depth).data) {
    ASSERT_TRUE(value == 0.0F || value == 1.0F || value == 3.0F) << value;
  }
}

TEST(Undistortion, WithoutDistortionNothingChanges) {
  ColorImage color(640, 480);
  DepthImage depth(640, 480);
  for (std::size_t i = 0; i < depth.data.size(); ++i) {
    depth.data[i] = static_cast<float>(i % 1000);
    color.data[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 7};
  }
  const Undistortion none(parse_camera("freiburg3").value());
  EXPECT_EQ(none.undistort_color(color).data, color.data);
  EXPECT_EQ(none.undistort_depth(depth).data, depth.data);
}

TEST(Undistortion, RefusesImagesOfAnotherSize) {
  EXPECT_THROW(static_cast<void>(Undistortion(freiburg1()).undistort_color(ColorImage(320, 240))),
               InternalError);
  EXPECT_THROW(Undistortion(CalibratedCamera{}), InternalError);
}

TEST(CameraPresets, NamesAndNumbers) {
  EXPECT_EQ(parse_camera("freiburg2")->pinhole.fx_px, 520.908620);
  EXPECT_EQ(parse_camera("default")->pinhole.cx_px, 319.5);
  const auto numbers = parse_camera("500,501,320,240,0.1,0.2,0.3,0.4,0.5");
  ASSERT_TRUE(numbers);
  EXPECT_EQ(numbers->pinhole.fy_px, 501);
  EXPECT_EQ(numbers->pinhole.width_px, 0);
  EXPECT_EQ(numbers->distortion.p1, 0.3);
  EXPECT_EQ(numbers->distortion.k3, 0.5);
  EXPECT_TRUE(parse_camera("500 501 320 240")->distortion.is_zero());
}

TEST(CameraPresets, RefusesWhatIsNoCamera) {
  for (const char* text : {"freiburg4", "", "1,2,3", "500,501,320,x", "481.2,-480,319.5,239.5", "500,nan,1,1",
                           "500,501,1e300,240", "500,501,320,240,0,0,-1e200,0,0"}) {
    const auto camera = parse_camera(text);
    ASSERT_FALSE(camera) << text;
    EXPECT_EQ(camera.error().code, ErrorCode::configuration) << text;
    EXPECT_NE(camera.error().message.find("camera = "), std::string::npos) << text;
  }
  EXPECT_EQ(parse_camera("freiburg4").error().hint, "did you mean freiburg1?");
}

TEST(CameraPresets, FolderNameTells) {
  EXPECT_EQ(camera_by_folder_name("rgbd_dataset_freiburg2_desk")->pinhole.fx_px, 520.908620);
  EXPECT_EQ(camera_by_folder_name("freiburg3")->pinhole.fx_px, 535.4);
  EXPECT_FALSE(camera_by_folder_name("living_room_traj2_frei_png"));
  EXPECT_FALSE(camera_by_folder_name("my_default_recording"));
}

}  // namespace
}  // namespace fusebench
