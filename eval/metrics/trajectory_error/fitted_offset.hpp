// ATE with a fitted offset of the body: the reference may be of another point than the camera's optical
// centre (markers of a motion capture), which no rigid alignment of the worlds absorbs.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/metrics/trajectory_files/trajectory_pair.hpp"

namespace fusebench::trajectory_error {

struct FittedOffset {
  Vector3d offset_m = Vector3d::Zero();  ///< of the estimate's origin in the frame of the reference's body
  Matrix3d covariance_m2 = Matrix3d::Zero();  ///< with errors that are alike for a second
  SE3 T_reference_estimate;                   ///< the alignment that belongs to it
  std::size_t pairs = 0;
  std::vector<double> errors_m;  ///< in order of time
  metrics::Statistics stats;
};

/// A larger standard deviation of the offset, in any direction, means that the motion does not tell it.
inline constexpr double kMaxOffsetSigma_m = 0.01;

/// Least squares over the alignment (R, t) and the offset o of |g_i + R_gi o - (R p_i + t)| for positions g,
/// p and orientations R_g of the reference (hand-eye calibration, of the translation alone). The covariance
/// is that of the residuals' scatter (at least 0.1 mm, the rounding of files), with as many independent poses
/// as the trajectory has seconds. Errors: data_corrupt for positions that cannot be aligned, and if the
/// motion does not tell the offset.
[[nodiscard]] Result<FittedOffset> fitted_offset(const trajectory_files::TrajectoryPair& pair);

/// The same of poses associated as absolute_trajectory_error() does. Errors: also those of it.
[[nodiscard]] Result<FittedOffset> fitted_offset(const Trajectory& ground_truth, const Trajectory& estimate,
                                                 const AteOptions& options = {});

}  // namespace fusebench::trajectory_error
