// The calibration of a recording's sensors as a TOML file: "calibration.toml" beside the images of any
// format, and the same tables in configs/recordings/.
//
//     calibration_source = "who measured it, and where it is published"
//     [color]
//     width_px = 640            # both or none; without them the size is that of the images
//     height_px = 480
//     fx_px = 608.446           # also fy_px, cx_px, cy_px
//     distortion = [0.0644, -0.114, 0.00127, 0.00203, 0]  # k1 k2 p1 p2 k3 (Brown-Conrady); none: 0
//     readout_s = 0.0           # rolling shutter, first to last row; without the key it is not known
//     readout_sigma_s = 0.0     # its uncertainty; none: 0, or 0.01 where readout_s is not known
//     ground_truth_offset_m = [0, 0, 0]  # of the camera in the body of the ground truth's poses; none: 0
//     [depth]
//     units_per_metre = 1000
//     width_px = 640            # intrinsics (the keys of [color], no distortion): depth is in a camera of
//     fx_px = 583.98            # its own, and T_color_depth is needed; without, it is registered to colour
//     T_color_depth = [r11, r12, r13, tx, r21, ...]       # row-major 3x4, metres
//     readout_s = 0.0           # and readout_sigma_s, as above
//     delay_s = 0.0             # see SensorTiming; without the key it is not known
//     delay_sigma_s = 0.0       # its uncertainty; none: 0, or 0.01 where delay_s is not known
//     [imu]
//     T_imu_color = [...]       # or T_imu_depth; row-major 3x4, metres
//     gyroscope_noise_radps_sqrthz = 1.1e-3
//     accelerometer_noise_mps2_sqrthz = 2.4e-2
//     gyroscope_bias_walk_radps2_sqrthz = 5e-5
//     accelerometer_bias_walk_mps3_sqrthz = 6.3e-4
//     time_offset_s = 0.0       # the IMU's stamp minus the images' stamp of the same instant
//     gyroscope_scale = [1, 1, 1]      # what is measured is so many times the ground truth, by axis; none: 1
//     accelerometer_scale = [1, 1, 1]  # the same
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/toml_document.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::calibration {

/// Depth that is taken by a camera of its own, without distortion.
struct DepthCamera {
  PinholeCamera pinhole;
  SE3 T_color_depth;
};

struct ImuCalibration {
  SE3 T_imu_camera;  ///< camera: the colour camera
  ImuNoise noise;
  double time_offset_s = 0;  ///< the IMU's stamp minus the images' stamp of the same instant
  Vector3d gyroscope_scale =
      Vector3d::Ones();  ///< what is measured is so many times the ground truth, by axis
  Vector3d accelerometer_scale = Vector3d::Ones();  ///< the same
};

struct RigCalibration {
  CalibratedCamera color;                       ///< with the timing of both image sensors
  std::optional<double> depth_units_per_metre;  ///< value of one metre in the depth images
  std::optional<DepthCamera> depth;             ///< absent: depth is registered to the colour camera
  std::optional<ImuCalibration> imu;
  std::string source;  ///< who measured it
};

inline constexpr std::string_view kRigidTransformRule =
    "[R | t] row by row, R orthonormal within 1e-3 with determinant +1, t up to 1e8 m; the last row of 4x4 "
    "is "
    "0 0 0 1, so transpose a matrix with its translation there";

/// Between sensors of one rig: more is another unit, or damaged.
inline constexpr double kMostLeverArm_m = 1000;

/// Of a side of an image, in calibrations and records: no sensor has more.
inline constexpr int kMostSize_px = 100'000;

/// A frame is not read out for longer, and its depth not later or earlier than its colour by more.
inline constexpr double kMostReadout_s = 1;
inline constexpr double kMostDelay_s = 10;

/// Of depth in whole numbers: they are of 10 m or less. 0.001 is a unit in metres, not a number of units.
inline constexpr double kLeastUnits_per_m = 0.1;
inline constexpr double kMostUnits_per_m = 1e6;
[[nodiscard]] inline bool is_units_per_metre(double units) {
  return units >= kLeastUnits_per_m && units <= kMostUnits_per_m;
}
/// An error about a value out of this range: `name` with its place. The hint names the units per metre that
/// the value is as metres per unit.
[[nodiscard]] tl::unexpected<Error> no_units_per_metre(ErrorCode code, std::string_view name, double value);

/// Of any pose in metres, also in the coordinates of a map: beyond, doubles no longer tell micrometres apart.
inline constexpr double kMostTranslation_m = 1e8;

/// A row-major 3x4 matrix as a rigid transform. Published matrices are rounded, so the nearest rotation is
/// taken. Nothing if the matrix breaks kRigidTransformRule.
[[nodiscard]] std::optional<SE3> rigid_transform(std::span<const double, 12> rows);

/// The same of a 4x4 matrix, whose last row is 0 0 0 1: of a transposed one the upper part would be a
/// rotation without its translation.
[[nodiscard]] std::optional<SE3> rigid_transform(std::span<const double, 16> rows);

/// The calibration among the entries of a TOML file; keys of other tables are left alone, unknown keys within
/// the three tables are errors. Errors (configuration, with file:line): unknown or missing key, wrong type, a
/// value out of range, a matrix that is no rigid transform (orthonormal within 1e-3, determinant +1; it is
/// orthonormalised).
[[nodiscard]] Result<RigCalibration> rig_calibration(const config::TomlDocument& document,
                                                     const std::string& file);

/// A file of such a calibration and nothing else. Errors: data_missing, and configuration as above and for
/// unknown top-level keys.
[[nodiscard]] Result<RigCalibration> read_calibration(const std::filesystem::path& file);

/// calibration.toml in the folder; nothing if there is none. Errors: data_corrupt, with the message of the
/// above, and for unknown top-level keys.
[[nodiscard]] Result<std::optional<RigCalibration>> read_calibration_beside(
    const std::filesystem::path& folder);

/// The text of such a file, which reads back as the same values (rotations up to rounding) if all of them are
/// within the bounds of read_calibration().
[[nodiscard]] std::string to_toml(const RigCalibration& calibration);

/// Before such a text is written to a file: that it reads back. Error configuration: a value out of bounds.
[[nodiscard]] Result<void> check_readable(const std::string& toml, const std::string& file);

}  // namespace fusebench::calibration
