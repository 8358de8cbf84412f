// Do the covariances that come with a trajectory tell the ground truth about its errors? NEES and 3 sigma of
// poses from anywhere (Bar-Shalom, Li and Kirubarajan 2001, 5.4.2; Zhang and Scaramuzza 2018).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/alignment.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/metrics/trajectory_files/trajectory_pair.hpp"

namespace fusebench::trajectory_error {

struct PoseConsistencyRow {
  std::int64_t timestamp_ns = 0;  ///< of the estimate
  Vector3d orientation_error_rad = Vector3d::Zero();
  Vector3d orientation_sigma_rad = Vector3d::Zero();
  Vector3d position_error_m = Vector3d::Zero();
  Vector3d position_sigma_m = Vector3d::Zero();
  double orientation_nees = 0;  ///< per degree of freedom: 1 on average if the covariance is consistent
  double position_nees = 0;
};

/// One of the two parts of a pose over all rows.
struct PartConsistency {
  metrics::Statistics nees;            ///< per degree of freedom
  double error_rmse = 0;               ///< rad or m
  double sigma_rms = 0;                ///< of the axes' sum, as error_rmse: rad or m
  Vector3d share_within_3_sigma = {};  ///< of the rows, by axis; 0.9973 is expected
};

struct PoseConsistency {
  std::size_t pairs = 0;
  std::size_t possible = 0;
  std::size_t singular = 0;  ///< pairs that do not count, for a covariance that is singular
  Similarity T_reference_estimate;
  std::vector<PoseConsistencyRow> rows;
  PartConsistency orientation;
  PartConsistency position;
};

/// The ground truth is moved into the world of the estimate, whose covariances are of that world, by the
/// inverse of what aligns the estimate. Errors are truth (-) estimate: of the orientation on the right, in
/// the body's frame; of the position in the estimate's world.
///
/// Errors: usage for an estimate without covariances, or an alignment with scale; those of pair_up() and
/// align(); data_corrupt where every covariance is singular.
[[nodiscard]] Result<PoseConsistency> pose_consistency(
    const Trajectory& reference, const trajectory_files::LoadedTrajectory& estimate,
    const trajectory_files::AssociationOptions& association, const AlignmentRequest& alignment);

}  // namespace fusebench::trajectory_error
