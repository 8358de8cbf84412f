// How far a common unknown scatters between parts of a recording.
//
// Errors that last for seconds (a model that is off where the camera looks, a motion that read-out and
// velocity describe only to first order) are shared by many frames, and neither the residuals' size nor their
// autocorrelation says what they do to an unknown: that depends on how they go along with the motion. The
// scores of the unknown, summed over blocks of time, show it (the cluster-robust estimate of Liang & Zeger
// 1986). What is the same in all blocks stays hidden.
#pragma once

#include <cstddef>
#include <vector>

#include "core/smoother/batch_problem.hpp"

namespace fusebench::smoother {

/// The block of each row of a linearisation; -1 for rows that are no measurement.
struct RowBlocks {
  std::vector<int> of_row;
  int count = 0;
};

/// Blocks of the same number of frames: about a second each at most 8, none (count 0) for short recordings.
[[nodiscard]] RowBlocks blocks_in_time(const BatchInput& input);

/// The covariance with the standard deviations of those unknowns enlarged that scatter more over the blocks.
/// to_common: the columns of the inverse information that belong to the common unknowns.
[[nodiscard]] BatchCommonMatrix enlarged_by_scatter(const BatchCommonMatrix& covariance,
                                                    const BatchLinearisation& at,
                                                    const Eigen::MatrixXd& to_common,
                                                    const RowBlocks& blocks);

}  // namespace fusebench::smoother
