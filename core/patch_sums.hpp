// The sums over the residuals of a patch (Eqs. 3 and 4), eight pixels at a time.
#pragma once

#include <array>
#include <bit>

#include "core/config.hpp"
#include "core/iekf.hpp"
#include "core/image.hpp"
#include "core/patch_lanes.hpp"

namespace fusebench {

/// A residual's derivative by the tangent of T_world_imu: rotation (rad, IMU frame), position (m, world).
using JacobianLanes = std::array<Float8, kPoseSize>;

/// What residuals of one kind add up to. Lanes are added in their order at the end.
class QuadraticSums {
 public:
  /// weight: of the squared residual in the normal equations; it and the cost are 0 where there is no
  /// residual.
  void add(const JacobianLanes& jacobian, Float8 residual, Float8 weight, Float8 cost);
  [[nodiscard]] PoseQuadratic total() const;

 private:
  std::array<Float8, kPoseSize*(kPoseSize + 1) / 2> information_{};  // upper triangle by rows
  std::array<Float8, kPoseSize> gradient_{};
  Float8 cost_{};
};

/// How well residuals fit their noise.
struct FitSums {
  void add(Float8 whitened, Float8 robust_weight, Int8 counted);

  Float8 chi2{};    ///< of squared whitened residuals
  Float8 robust{};  ///< the same, times the kernel's weight
  int count = 0;
};

/// Huber's kernel on whitened residuals: quadratic up to k, linear beyond. The weight is that of the squared
/// residual in the normal equations.
struct RobustLanes {
  Float8 cost{};
  Float8 weight{};
};
[[nodiscard]] RobustLanes huber(Float8 whitened, float k);

/// Derivatives of gain * reference + offset, the brightness of a patch, and how they go with the pose.
struct BrightnessSums {
  void add(const JacobianLanes& jacobian, Float8 residual, Float8 weight, Float8 intensity);
  [[nodiscard]] Eigen::Matrix2d information() const;
  [[nodiscard]] Vector2d gradient() const;
  [[nodiscard]] Eigen::Matrix<double, 2, kPoseSize> by_pose() const;

  std::array<Float8, 3> information_{};  // gain gain, gain offset, offset offset
  std::array<Float8, 2> gradient_{};
  std::array<JacobianLanes, 2> by_pose_{};
};

/// Eq. 3: dI/dpose where a point of the camera landed in its image, with the image's slope there.
[[nodiscard]] JacobianLanes photometric_jacobian(const PosedLanes& camera, const Points& point_camera,
                                                 Float8 dx, Float8 dy);

/// A measured point and the model plane it was associated with, for eight pixels; the plane is the pixels'
/// own.
struct PlanePairs {
  Points point_imu;
  Float8 sigma_m{};
  Int8 valid{};
  Int8 landed{};           ///< on which pixel of the depth image, counted from 1; 0 = outside
  Float8 predicted_z_m{};  ///< depth of the points there
};

/// Eq. 4: n . (T_world_imu * point_imu - plane_point), metres.
[[nodiscard]] Float8 plane_residual(const PosedLanes& camera, const PlanePairs& pairs,
                                    const PixelLanes& planes);
/// Its derivative by the pose.
[[nodiscard]] JacobianLanes plane_jacobian(const PosedLanes& camera, const PlanePairs& pairs,
                                           const PixelLanes& planes);

/// When a measurement belongs to a model point, and how noisy it is.
struct AssociationGates {
  /// `scale` is that of the noise's standard deviation.
  AssociationGates(const GeometricConfig& geometric, const DepthConfig& depth, double scale);

  float max_distance_m;
  float min_normal_cosine;
  float min_incidence_cosine;
  float model_noise_m;
  float noise_scale;
  DepthConfig depth;
};

/// Projective association: the measurement at the pixel where each model point lands, if distance, normals
/// and incidence agree. `before`: the pairs of the same points and image at another pose, or none. They stay
/// while all eight points land on the pixels that they landed on, as deep as they were to a tenth of the
/// largest distance: what is measured there is the same, and what decides has hardly changed.
[[nodiscard]] PlanePairs associate(const PosedLanes& camera, const PixelLanes& pixels,
                                   const DepthImage& depth_m, const AssociationGates& gates,
                                   const PlanePairs& before = {});

// Inline: what all pixels of all patches go through.

inline void QuadraticSums::add(const JacobianLanes& jacobian, Float8 residual, Float8 weight, Float8 cost) {
  std::size_t entry = 0;
  for (std::size_t row = 0; row < jacobian.size(); ++row) {
    const Float8 weighted = weight * jacobian[row];
    for (std::size_t column = row; column < jacobian.size(); ++column, ++entry) {
      information_[entry] = multiply_add(weighted, jacobian[column], information_[entry]);
    }
    gradient_[row] = multiply_add(weighted, residual, gradient_[row]);
  }
  cost_ += cost;
}

inline void FitSums::add(Float8 whitened, Float8 robust_weight, Int8 counted) {
  const Float8 squared = counted ? whitened * whitened : Float8{};
  chi2 += squared;
  robust = multiply_add(robust_weight, squared, robust);
  count += std::popcount(lane_bits(counted));
}

inline RobustLanes huber(Float8 whitened, float k) {
  const Float8 magnitude = abs(whitened);
  const Int8 quadratic = magnitude <= k;
  return {quadratic ? 0.5F * whitened * whitened : k * (magnitude - 0.5F * k),
          quadratic ? all_lanes(1.0F) : k / (quadratic ? all_lanes(1.0F) : magnitude)};
}

inline void BrightnessSums::add(const JacobianLanes& jacobian, Float8 residual, Float8 weight,
                                Float8 intensity) {
  // By gain and offset: -intensity and -1.
  const Float8 by_gain = -weight * intensity;
  information_[0] = multiply_add(-by_gain, intensity, information_[0]);
  information_[1] -= by_gain;
  information_[2] += weight;
  gradient_[0] = multiply_add(by_gain, residual, gradient_[0]);
  gradient_[1] = multiply_add(-weight, residual, gradient_[1]);
  for (std::size_t i = 0; i < jacobian.size(); ++i) {
    by_pose_[0][i] = multiply_add(by_gain, jacobian[i], by_pose_[0][i]);
    by_pose_[1][i] = multiply_add(-weight, jacobian[i], by_pose_[1][i]);
  }
}

inline JacobianLanes photometric_jacobian(const PosedLanes& camera, const Points& point_camera, Float8 dx,
                                          Float8 dy) {
  // By the point in the camera: the image's slope times the projection's derivative. X_c = R_ci (R_wi^T (P -
  // p_wi) - p_ic): turning the IMU by phi moves X_c by R_ci [X_i]x phi.
  const Float8 inverse_z = 1.0F / point_camera.z;
  const Float8 by_x = dx * camera.fx_px * inverse_z;
  const Float8 by_y = dy * camera.fy_px * inverse_z;
  const Points by_camera = {by_x, by_y,
                            -multiply_add(by_x, point_camera.x, by_y * point_camera.y) * inverse_z};
  const Points by_imu = rotated(camera.R_imu_camera, by_camera);
  const Points turn = cross(by_imu, camera.to_imu(point_camera));
  const Points move = rotated(camera.R_world_imu, by_imu);
  return {turn.x, turn.y, turn.z, -move.x, -move.y, -move.z};
}

inline Float8 plane_residual(const PosedLanes& camera, const PlanePairs& pairs, const PixelLanes& planes) {
  const Points point = moved(camera.R_world_imu, camera.t_world_imu_m, pairs.point_imu);
  return dot(planes.normal, point - planes.point);
}

inline JacobianLanes plane_jacobian(const PosedLanes& camera, const PlanePairs& pairs,
                                    const PixelLanes& planes) {
  const Points normal_imu = rotated(camera.R_world_imu.transpose(), planes.normal);
  const Points turn = cross(pairs.point_imu, normal_imu);
  return {turn.x, turn.y, turn.z, planes.normal.x, planes.normal.y, planes.normal.z};
}

}  // namespace fusebench
