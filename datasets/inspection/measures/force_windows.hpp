// Means of the accelerometer over short windows in axes that do not turn: whether its own axes are those that
// the turns are known in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "datasets/inspection/measures/signed_permutations.hpp"

namespace fusebench::inspection::measures {

/// A window of 0.4 s. R rotates from the IMU, as it is calibrated, into axes that are fixed within a block of
/// windows.
struct ForceWindow {
  std::size_t block = 0;
  Matrix3d rotation = Matrix3d::Zero();  ///< mean of R
  /// [j]: mean of f_j R.
  std::array<Matrix3d, 3> moments = {Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};
  Vector3d acceleration_mps2 = Vector3d::Zero();  ///< of the IMU in the fixed axes; 0 where it is not known

  /// Mean of R A f, of a sensor that measures A^-1 of the force.
  [[nodiscard]] Vector3d force(const Matrix3d& axes) const;
};

/// Poses of an IMU by ground truth.
struct TruePath {
  const Trajectory& ground_truth;  ///< of the camera
  std::int64_t gap_ns = 0;         ///< the longest that is interpolated
  double time_offset_s = 0;        ///< IMU's stamp minus camera's stamp of one instant
  Matrix3d rotation_camera_imu = Matrix3d::Identity();
  Vector3d imu_in_camera_m = Vector3d::Zero();
};

/// In the axes of the ground truth, one block, with the acceleration of the path. Forces are multiplied by
/// `unit`.
[[nodiscard]] std::vector<ForceWindow> windows_by_truth(std::span<const ImuSample> samples,
                                                        const TruePath& path, double unit);

/// In the axes that the IMU had at the beginning of each block of 3 s, by its gyroscope alone, whose axes are
/// `gyroscope_axes` of the calibrated ones. Accelerations are not known.
[[nodiscard]] std::vector<ForceWindow> windows_by_gyroscope(std::span<const ImuSample> samples,
                                                            const Vector3d& gyroscope_bias_radps,
                                                            const Matrix3d& gyroscope_axes, double unit);

/// How the forces fit with each signed permutation P of the accelerometer's axes (it measures P f):
///
///   mean(R P^T f) = a - g + mean(R) b,
///
/// with gravity g of each block and a bias b (0.5 m/s^2). Where accelerations are not known, P and -P fit
/// equally, and only the 24 rotations are compared. `given`: the axes as they are read, into
/// signed_permutations(). Nothing for fewer than 6 windows.
[[nodiscard]] std::optional<AxesChoice> choose_accelerometer_axes(std::span<const ForceWindow> windows,
                                                                  std::size_t given, bool by_truth);

}  // namespace fusebench::inspection::measures
