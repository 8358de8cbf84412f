// ATE with a fitted offset of the body: the reference may be of another point than the camera's optical
// centre (markers of a motion capture), which no rigid alignment of the worlds absorbs.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/trajectory_error/ate_rpe.hpp"

namespace fusebench::trajectory_error {

struct FittedOffset {
  Vector3d offset_m = Vector3d::Zero();  ///< of the estimate's origin in the frame of the reference's body
  Matrix3d covariance_m2 = Matrix3d::Zero();  ///< with errors that are alike for a second
  SE3 T_reference_estimate;                   ///< the alignment that belongs to it
  std::size_t pairs = 0;
  std::vector<double> errors_m;  ///< in order of time
  metrics::Statistics stats;
};

/// Least squares over the alignment (R, t) and the offset o of |g_i + R_gi o - (R p_i + t)| for positions g,
/// p and orientations R_g of the reference, associated as absolute_trajectory_error() does (hand-eye
/// calibration, of the translation alone). The covariance is that of the residuals' scatter, with as many
/// independent poses as the trajectory has seconds. Errors: those of absolute_trajectory_error();
/// data_corrupt if the motion does not tell the offset: a standard deviation above `max_sigma_m` in some
/// direction.
[[nodiscard]] Result<FittedOffset> fitted_offset(const Trajectory& ground_truth, const Trajectory& estimate,
                                                 const AteOptions& options = {}, double max_sigma_m = 0.01);

}  // namespace fusebench::trajectory_error
