// Value types of all layers: aggregates with defaults, SI units, time in integer nanoseconds. Camera axes: x
// right, y down, z forward.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/image.hpp"

namespace fusebench {
inline namespace base {

inline constexpr double kGravity_mps2 = 9.81;  ///< magnitude; the direction is part of the filter state

[[nodiscard]] constexpr double seconds_between(std::int64_t begin_ns, std::int64_t end_ns) {
  return 1e-9 * static_cast<double>(end_ns - begin_ns);
}

/// Pinhole camera without distortion (readers undistort images). u = fx x/z + cx, v = fy y/z + cy.
struct PinholeCamera {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;

  [[nodiscard]] bool operator==(const PinholeCamera&) const = default;

  /// Pixel coordinates of a point in the camera frame (metres, z > 0).
  [[nodiscard]] Vector2d project(const Vector3d& point_camera) const {
    return {fx_px * point_camera.x() / point_camera.z() + cx_px,
            fy_px * point_camera.y() / point_camera.z() + cy_px};
  }
  /// The point in the camera frame at pixel (u, v) and z-depth depth_m.
  [[nodiscard]] Vector3d back_project(double u_px, double v_px, double depth_m) const {
    return {(u_px - cx_px) / fx_px * depth_m, (v_px - cy_px) / fy_px * depth_m, depth_m};
  }
  /// Derivative of project() with respect to the point (pixels per metre).
  [[nodiscard]] Matrix2x3d projection_jacobian(const Vector3d& point_camera) const {
    const double inverse_z = 1.0 / point_camera.z();
    Matrix2x3d j;
    j << fx_px * inverse_z, 0, -fx_px * point_camera.x() * inverse_z * inverse_z,  //
        0, fy_px * inverse_z, -fy_px * point_camera.y() * inverse_z * inverse_z;
    return j;
  }
};

/// One colour-depth pair; depth is registered to the colour camera.
struct RgbdFrame {
  std::int64_t timestamp_ns = 0;       ///< stamp of the colour image; identifies the frame in outputs
  std::int64_t capture_offset_ns = 0;  ///< instant of the colour image (its middle row) minus its stamp
  std::int64_t depth_offset_ns = 0;    ///< instant of the depth image minus that of the colour image
  ColorImage color;
  GreyImage grey;
  DepthImage depth_m;

  [[nodiscard]] std::int64_t capture_ns() const { return timestamp_ns + capture_offset_ns; }
};

/// One inertial sample in the IMU frame.
struct ImuSample {
  std::int64_t timestamp_ns = 0;
  Vector3d angular_velocity_radps = Vector3d::Zero();
  Vector3d specific_force_mps2 = Vector3d::Zero();  ///< specific force a - g: +9.81 upwards at rest
};

/// Continuous-time noise densities of an IMU (Kalibr's convention).
struct ImuNoise {
  double gyroscope_radps_sqrthz = 0;          ///< white noise, rad/s/sqrt(Hz)
  double accelerometer_mps2_sqrthz = 0;       ///< white noise, m/s^2/sqrt(Hz)
  double gyroscope_bias_radps2_sqrthz = 0;    ///< bias random walk, rad/s^2/sqrt(Hz)
  double accelerometer_bias_mps3_sqrthz = 0;  ///< bias random walk, m/s^3/sqrt(Hz)
};

/// Exposure times of the image rows. A read-out time of zero means a global shutter.
struct SensorTiming {
  double color_readout_s = 0;  ///< between the first and the last row
  double depth_readout_s = 0;  ///< between the first and the last row of depth
  double depth_delay_s =
      0;  ///< delay of the depth image behind its stamp, relative to colour (readers apply it)
  // Standard deviations of the values above; zero means exact.
  double color_readout_sigma_s = 0;
  double depth_readout_sigma_s = 0;
  double depth_delay_sigma_s = 0;
};

/// Calibration of the sensors of a recording, as the estimator requires it.
struct SensorRig {
  PinholeCamera camera;
  SensorTiming timing;
  SE3 T_imu_camera;
  ImuNoise imu_noise;
  bool imu_axes_are_exact = false;  ///< scale and rotation are exact: a synthetic IMU
  /// Pose of the camera of the first frame in the world frame of a run. Absent: the identity, exactly.
  std::optional<SE3> T_world_first_camera = {};

  [[nodiscard]] SE3 first_camera() const { return T_world_first_camera.value_or(SE3{}); }
};

struct StampedPose {
  std::int64_t timestamp_ns = 0;
  SE3 T_world_camera;
};
using Trajectory = std::vector<StampedPose>;  ///< sorted by time, stamps unique

/// Indexed triangle mesh or surfels in the world frame (metres). normals, colors, quality and radii_m are
/// empty or have one entry for each vertex.
template <class Scalar>
struct BasicMesh {
  std::vector<Eigen::Matrix<Scalar, 3, 1>> vertices;
  std::vector<Eigen::Vector3f> normals;  ///< unit, outwards
  std::vector<Rgb> colors;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside
  std::vector<float> quality = {};                      ///< any scalar, for example the error of the vertex
  std::vector<float> radii_m = {};  ///< of surfels: discs at the vertices, orthogonal to the normals

  template <class Other>
  [[nodiscard]] BasicMesh<Other> cast() const {
    return {cast_vertices<Other>(), normals, colors, triangles, quality, radii_m};
  }
  template <class Other>
  [[nodiscard]] std::vector<Eigen::Matrix<Other, 3, 1>> cast_vertices() const {
    std::vector<Eigen::Matrix<Other, 3, 1>> result;
    result.reserve(vertices.size());
    for (const auto& vertex : vertices) result.push_back(vertex.template cast<Other>());
    return result;
  }
};
using Mesh = BasicMesh<float>;          ///< reconstructed and drawn meshes
using PreciseMesh = BasicMesh<double>;  ///< meshes of files and of measurements

}  // namespace base
}  // namespace fusebench
