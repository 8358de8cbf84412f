// A tiny recording in FMDataset's layout, or in that of its recorder, which a test may damage.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/images/image_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::testing {

inline constexpr int kZr300Frames = 4;

/// Stamp of a frame as FMDataset has it: microseconds from the start of the device.
constexpr std::int64_t zr300_frame_us(int frame) { return 755'517 + 33'275LL * frame; }

/// Four frames of 16x12 pixels, a depth camera of its own at the place of the colour camera (so registration
/// keeps the pixels), inertial samples at 200 Hz from 0.5 s before the first frame, and calibration.toml.
class Zr300Folder {
 public:
  Zr300Folder() {
    std::string rows = "#timestamp(us) colorname depthname\n";
    for (int i = 0; i < kZr300Frames; ++i) {
      const std::string name = fmt::format("{}.png", zr300_frame_us(i));
      write_images(name, i);
      rows += fmt::format("{},{},{}\n", zr300_frame_us(i), name, name);
    }
    write("TIMESTAMP.txt", rows);
    write("IMU.txt", imu_rows(1, 250'000, 140));
    write("calibration.toml", calibration::to_toml(calibration()));
  }

  static calibration::RigCalibration calibration() {
    calibration::RigCalibration calibration;
    calibration.color.pinhole = {16, 12, 20, 21, 7.5, 5.5};
    calibration.depth = calibration::DepthCamera{calibration.color.pinhole, {}};
    calibration.depth_units_per_metre = 1000;
    calibration.imu =
        calibration::ImuCalibration{{Quaterniond::Identity(), {0.1, 0, 0}}, {1e-3, 2e-2, 5e-5, 6e-4}, 0};
    calibration.source = "a test";
    return calibration;
  }

  /// Rows of IMU.txt: the gyroscope's x is the row's number, the accelerometer's x is its time in seconds.
  /// units_per_us: in which unit the stamps are (0.001: milliseconds).
  static std::string imu_rows(double units_per_us, std::int64_t first_us, int count) {
    std::string rows = "#timestamp(us) gx gy gz ax ay az\n";
    for (int i = 0; i < count; ++i) {
      const std::int64_t t_us = first_us + 5000LL * i;
      rows += fmt::format("{},{},0.25,-0.5,{},9.75,0\n", static_cast<double>(t_us) * units_per_us, i,
                          1e-6 * static_cast<double>(t_us));
    }
    return rows;
  }

  void write(const std::string& name, std::string_view content) const { folder_.write(name, content); }
  /// Colour, depth (1 m and the frame's number of millimetres) and filtered depth (1 m more).
  void write_images(const std::string& name, int frame) const {
    for (const char* folder : {"color", "depth", "filtered"}) write(fmt::format("{}/{}", folder, name), "");
    const auto depth = static_cast<std::uint16_t>(1000 + frame);
    EXPECT_TRUE(images::write_png(path() / "color" / name, ColorImage(16, 12, Rgb{10, 20, 30})));
    EXPECT_TRUE(images::write_png(path() / "depth" / name, Image<std::uint16_t>(16, 12, depth)));
    EXPECT_TRUE(images::write_png(path() / "filtered" / name,
                                  Image<std::uint16_t>(16, 12, static_cast<std::uint16_t>(depth + 1000))));
  }
  void remove(const std::string& name) const { EXPECT_TRUE(std::filesystem::remove(path() / name)); }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

/// FMDataset's calib.txt.
inline constexpr std::string_view kFmDatasetCalibTxt = R"(
640 480                 % color size
608.446 607.847
331.332 245.549

640 480
583.980 583.980
325.103 240.718

0.999980211 -0.00069964811 -0.0062491186 -0.057460     % from depth to color
0.000735448557 0.999983311 0.00572841847 -0.001073
0.00624500681 -0.00573290139 0.999964058 -0.002205

    0.999758    0.0138749   -0.0170966     0.036333
  -0.0134149     0.999552    0.0267351    0.0029128
   0.0174598   -0.0264998     0.999496 -0.000897499

affine 0.001 0.0

4e-7 5.88e-4 2.5e-09 1.22e-6
)";

}  // namespace fusebench::testing
