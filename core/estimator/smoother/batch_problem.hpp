// Unknowns and least-squares problem of the batch estimator, for Ceres.
#pragma once

#include <ceres/problem.h>

#include <array>
#include <vector>

#include "core/estimator/prediction/imu_preintegration.hpp"
#include "core/estimator/smoother/batch_estimate.hpp"
#include "core/estimator/smoother/selected_inverse.hpp"

namespace fusebench::smoother {

struct BatchUnknowns {
  std::vector<Quaterniond> rotation_world_imu;
  std::vector<Vector3d> position_world_m;
  std::vector<Vector3d> velocity_world_mps;
  std::vector<Vector6d> bias;  ///< gyroscope, accelerometer
  Vector3d gravity_direction_world = Vector3d::UnitY();
  SE3 T_imu_camera;
  double time_offset_s = 0;
  SensorScales scales;
  Vector3d timing_s = Vector3d::Zero();
};

/// First columns of the unknowns in the Jacobian; -1 for fixed unknowns.
struct BatchColumns {
  std::vector<int> rotation;
  std::vector<int> position;
  std::vector<int> velocity;
  std::vector<int> bias;
  int gravity = -1;
  int imu_camera_rotation = -1;
  int imu_camera_translation = -1;
  int time_offset = -1;
  int gyroscope_scale = -1;
  int accelerometer_scale = -1;
  std::array<int, 3> timing = {-1, -1, -1};
  int count = 0;
};

/// Residuals and Jacobian at the end of the search, with robust weights. Rows: six for each visual motion in
/// the order of the input, nine for each IMU interval, three for each timing of the input, then the priors.
struct BatchLinearisation {
  std::vector<double> residuals;
  SparseRowsd jacobian;
  BatchColumns columns;
};

/// Weighting of image measurements: divisor of their information, and the scale of the Huber loss in these
/// units.
struct Weighting {
  double scale = 1;
  double outlier_sigmas = 5;
};

class BatchProblem {
 public:
  /// All arguments must outlive the problem, which modifies the unknowns. increments: one for each interval.
  BatchProblem(const BatchInput& input, const BatchOptions& options,
               const std::vector<prediction::PreintegratedImu>& increments, const Weighting& visual,
               const Weighting& timing, BatchUnknowns& unknowns);

  /// False if Ceres failed.
  [[nodiscard]] bool solve();
  [[nodiscard]] BatchLinearisation linearise();
  /// Residuals of a visual motion without robust weights.
  [[nodiscard]] Vector6d visual_residual(std::size_t motion) const;

  /// IMU errors of the unknowns, at which the increments are integrated.
  [[nodiscard]] static prediction::InertialErrors errors_at(const BatchUnknowns& unknowns, std::size_t frame);

 private:
  void add_unknowns();
  void add_inertial();
  void add_visual(const Weighting& weighting);
  void add_timing(const Weighting& weighting);
  void add_priors();
  void add_sensor_priors();

  const BatchInput& input_;
  const BatchOptions& options_;
  const std::vector<prediction::PreintegratedImu>& increments_;
  BatchUnknowns& unknowns_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> visual_;
  std::vector<ceres::ResidualBlockId> inertial_;
  std::vector<ceres::ResidualBlockId> timing_;
  std::vector<ceres::ResidualBlockId> rest_;
};

}  // namespace fusebench::smoother
