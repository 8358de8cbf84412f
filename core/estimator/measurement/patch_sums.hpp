// Sums over the residuals of a patch (Eqs. 3 and 4), eight pixels at a time.
#pragma once

#include <array>
#include <bit>

#include "core/base/image.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/patches/patch_lanes.hpp"
#include "core/estimator/preprocessing/depth_sigma.hpp"

namespace fusebench::measurement {

/// Derivative of a residual with respect to the tangent of T_world_imu: rotation (rad, IMU frame), position
/// (m, world).
using JacobianLanes = std::array<simd::Float8, filter::kPoseSize>;

/// Normal equations and cost of residuals of one kind. The lanes are added in a fixed order at the end.
class QuadraticSums {
 public:
  /// weight: of the squared residual in the normal equations. Weight and cost are 0 for lanes without a
  /// residual.
  void add(const JacobianLanes& jacobian, simd::Float8 residual, simd::Float8 weight, simd::Float8 cost);
  [[nodiscard]] filter::PoseQuadratic total() const;

 private:
  std::array<simd::Float8, filter::kPoseSize*(filter::kPoseSize + 1) / 2>
      information_{};  // upper triangle, row by row
  std::array<simd::Float8, filter::kPoseSize> gradient_{};
  simd::Float8 cost_{};
};

/// Sums for the fit of residuals to their noise model.
struct FitSums {
  void add(simd::Float8 whitened, simd::Float8 robust_weight, simd::Int8 counted);

  simd::Float8 chi2{};    ///< sum of squared whitened residuals
  simd::Float8 robust{};  ///< as chi2, times the robust weight
  int count = 0;
};

/// Huber's kernel on whitened residuals: quadratic up to k, linear beyond. weight: of the squared residual in
/// the normal equations.
struct RobustLanes {
  simd::Float8 cost{};
  simd::Float8 weight{};
};
[[nodiscard]] RobustLanes huber(simd::Float8 whitened, float k);

/// Sums for the brightness of a patch, gain * reference + offset, and its products with the pose.
struct BrightnessSums {
  void add(const JacobianLanes& jacobian, simd::Float8 residual, simd::Float8 weight, simd::Float8 intensity);
  [[nodiscard]] Eigen::Matrix2d information() const;
  [[nodiscard]] Vector2d gradient() const;
  [[nodiscard]] Eigen::Matrix<double, 2, filter::kPoseSize> by_pose() const;

  std::array<simd::Float8, 3> information_{};  // gain gain, gain offset, offset offset
  std::array<simd::Float8, 2> gradient_{};
  std::array<JacobianLanes, 2> by_pose_{};
};

/// Eq. 3: dI/dpose at the projection of a point in the camera frame, given the image gradient there.
[[nodiscard]] JacobianLanes photometric_jacobian(const patches::PosedLanes& camera,
                                                 const simd::Points& point_camera, simd::Float8 dx,
                                                 simd::Float8 dy);

/// Measured points and the associated model planes of eight pixels; the plane is that of the pixel.
struct PlanePairs {
  simd::Points point_imu;
  simd::Float8 sigma_m{};
  simd::Int8 valid{};
  simd::Int8 landed{};           ///< pixel of the depth image, from 1 on; 0 = outside
  simd::Float8 predicted_z_m{};  ///< predicted depth of the points
};

/// Eq. 4: n . (T_world_imu * point_imu - plane_point), metres.
[[nodiscard]] simd::Float8 plane_residual(const patches::PosedLanes& camera, const PlanePairs& pairs,
                                          const patches::PixelLanes& planes);
/// Derivative of plane_residual() with respect to the pose.
[[nodiscard]] JacobianLanes plane_jacobian(const patches::PosedLanes& camera, const PlanePairs& pairs,
                                           const patches::PixelLanes& planes);

/// Limits of the association between a measurement and a model point, and the depth noise.
struct AssociationGates {
  /// scale: factor on the standard deviation of the depth noise.
  AssociationGates(const config::GeometricConfig& geometric, const config::DepthConfig& depth, double scale);

  float max_distance_m;
  float min_normal_cosine;
  float min_incidence_cosine;
  float model_noise_m;
  float noise_scale;
  preprocessing::DepthSigma depth_sigma;
};

/// Projective association: pairs each model point with the measurement at its projected pixel, if distance,
/// normals and incidence are within the limits. `before`: pairs of the same points and image at another pose,
/// or null. They are reused if all eight points project to the same pixels and their depths differ by less
/// than a tenth of the largest distance.
[[nodiscard]] PlanePairs associate(const patches::PosedLanes& camera, const patches::PixelLanes& pixels,
                                   const DepthImage& depth_m, const AssociationGates& gates,
                                   const PlanePairs& before = {});

// Inline, since they run for all pixels of all patches.

inline void QuadraticSums::add(const JacobianLanes& jacobian, simd::Float8 residual, simd::Float8 weight,
                               simd::Float8 cost) {
  std::size_t entry = 0;
  for (std::size_t row = 0; row < jacobian.size(); ++row) {
    const simd::Float8 weighted = weight * jacobian[row];
    for (std::size_t column = row; column < jacobian.size(); ++column, ++entry) {
      information_[entry] = simd::multiply_add(weighted, jacobian[column], information_[entry]);
    }
    gradient_[row] = simd::multiply_add(weighted, residual, gradient_[row]);
  }
  cost_ += cost;
}

inline void FitSums::add(simd::Float8 whitened, simd::Float8 robust_weight, simd::Int8 counted) {
  const simd::Float8 squared = counted ? whitened * whitened : simd::Float8{};
  chi2 += squared;
  robust = simd::multiply_add(robust_weight, squared, robust);
  count += std::popcount(simd::lane_bits(counted));
}

inline RobustLanes huber(simd::Float8 whitened, float k) {
  const simd::Float8 magnitude = simd::abs(whitened);
  const simd::Int8 quadratic = magnitude <= k;
  return {quadratic ? 0.5F * whitened * whitened : k * (magnitude - 0.5F * k),
          quadratic ? simd::all_lanes(1.0F) : k / (quadratic ? simd::all_lanes(1.0F) : magnitude)};
}

inline void BrightnessSums::add(const JacobianLanes& jacobian, simd::Float8 residual, simd::Float8 weight,
                                simd::Float8 intensity) {
  // Derivatives with respect to gain and offset: -intensity and -1.
  const simd::Float8 by_gain = -weight * intensity;
  information_[0] = simd::multiply_add(-by_gain, intensity, information_[0]);
  information_[1] -= by_gain;
  information_[2] += weight;
  gradient_[0] = simd::multiply_add(by_gain, residual, gradient_[0]);
  gradient_[1] = simd::multiply_add(-weight, residual, gradient_[1]);
  for (std::size_t i = 0; i < jacobian.size(); ++i) {
    by_pose_[0][i] = simd::multiply_add(by_gain, jacobian[i], by_pose_[0][i]);
    by_pose_[1][i] = simd::multiply_add(-weight, jacobian[i], by_pose_[1][i]);
  }
}

inline JacobianLanes photometric_jacobian(const patches::PosedLanes& camera, const simd::Points& point_camera,
                                          simd::Float8 dx, simd::Float8 dy) {
  // Chain rule: image gradient times projection derivative times dX_c/dpose. X_c = R_ci (R_wi^T (P - p_wi) -
  // p_ic), and a rotation phi of the IMU moves X_c by R_ci [X_i]x phi.
  const simd::Float8 inverse_z = 1.0F / point_camera.z;
  const simd::Float8 by_x = dx * camera.fx_px * inverse_z;
  const simd::Float8 by_y = dy * camera.fy_px * inverse_z;
  const simd::Points by_camera = {
      by_x, by_y, -simd::multiply_add(by_x, point_camera.x, by_y * point_camera.y) * inverse_z};
  const simd::Points by_imu = simd::rotated(camera.R_imu_camera, by_camera);
  const simd::Points turn = simd::cross(by_imu, camera.to_imu(point_camera));
  const simd::Points move = simd::rotated(camera.R_world_imu, by_imu);
  return {turn.x, turn.y, turn.z, -move.x, -move.y, -move.z};
}

inline simd::Float8 plane_residual(const patches::PosedLanes& camera, const PlanePairs& pairs,
                                   const patches::PixelLanes& planes) {
  const simd::Points point = simd::moved(camera.R_world_imu, camera.t_world_imu_m, pairs.point_imu);
  return simd::dot(planes.normal, point - planes.point);
}

inline JacobianLanes plane_jacobian(const patches::PosedLanes& camera, const PlanePairs& pairs,
                                    const patches::PixelLanes& planes) {
  const simd::Points normal_imu = simd::rotated(camera.R_world_imu.transpose(), planes.normal);
  const simd::Points turn = simd::cross(pairs.point_imu, normal_imu);
  return {turn.x, turn.y, turn.z, planes.normal.x, planes.normal.y, planes.normal.z};
}

}  // namespace fusebench::measurement
