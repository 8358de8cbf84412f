// The unknowns of the batch estimator and the least-squares problem around them, for Ceres.
#pragma once

#include <ceres/problem.h>

#include <vector>

#include "core/prediction/imu_preintegration.hpp"
#include "core/smoother/batch_estimate.hpp"
#include "core/smoother/selected_inverse.hpp"

namespace fusebench::smoother {

struct BatchUnknowns {
  std::vector<Quaterniond> rotation_world_imu;
  std::vector<Vector3d> position_world_m;
  std::vector<Vector3d> velocity_world_mps;
  std::vector<Vector6d> bias;  ///< gyroscope, accelerometer
  Vector3d gravity_direction_world = Vector3d::UnitY();
  SE3 T_imu_camera;
  double time_offset_s = 0;
};

/// Where the parts of an unknown begin among the columns of the Jacobian; -1 for what is held fixed.
struct BatchColumns {
  std::vector<int> rotation;
  std::vector<int> position;
  std::vector<int> velocity;
  std::vector<int> bias;
  int gravity = -1;
  int imu_camera_rotation = -1;
  int imu_camera_translation = -1;
  int time_offset = -1;
  int count = 0;
};

/// Residuals and Jacobian where the search ended, robust weights applied. Rows: six for each visual motion in
/// the order of the input, nine for each interval of the IMU, then the rest.
struct BatchLinearisation {
  std::vector<double> residuals;
  SparseRowsd jacobian;
  BatchColumns columns;
};

class BatchProblem {
 public:
  /// All arguments must outlive the problem, which moves the unknowns. increments: one an interval.
  /// visual_scale: what the visual information is divided by; outlier_sigmas: in these units.
  BatchProblem(const BatchInput& input, const BatchOptions& options,
               const std::vector<prediction::PreintegratedImu>& increments, double visual_scale,
               double outlier_sigmas, BatchUnknowns& unknowns);

  /// False if Ceres gave up.
  [[nodiscard]] bool solve();
  [[nodiscard]] BatchLinearisation linearise();
  /// The residuals of a visual motion without robust weights.
  [[nodiscard]] Vector6d visual_residual(std::size_t motion) const;

 private:
  void add_unknowns();
  void add_inertial();
  void add_visual(double scale, double outlier_sigmas);
  void add_priors();

  const BatchInput& input_;
  const BatchOptions& options_;
  const std::vector<prediction::PreintegratedImu>& increments_;
  BatchUnknowns& unknowns_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> visual_;
  std::vector<ceres::ResidualBlockId> inertial_;
  std::vector<ceres::ResidualBlockId> rest_;
};

}  // namespace fusebench::smoother
