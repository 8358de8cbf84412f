// Scatter of the common unknowns between parts of a recording.
//
// Errors that last for seconds (a local error of the model, motion during read-out beyond first order) are
// shared by many frames. Neither the size of the residuals nor their autocorrelation gives the effect on an
// unknown, since it depends on the correlation with the motion. The scores of the unknown, summed over blocks
// of time, show it (cluster-robust estimate of Liang & Zeger 1986). Errors that are equal in all blocks are
// not visible.
#pragma once

#include <cstddef>
#include <vector>

#include "core/estimator/smoother/batch_problem.hpp"

namespace fusebench::smoother {

/// The block of each row of a linearisation; -1 for rows without a measurement.
struct RowBlocks {
  std::vector<int> of_row;
  int count = 0;
};

/// Blocks with equal numbers of frames, of about a second each and at most 8; none (count 0) for short
/// recordings.
[[nodiscard]] RowBlocks blocks_in_time(const BatchInput& input);

/// The covariance, with larger standard deviations of the unknowns that scatter more between the blocks.
/// to_common: columns of the inverse information for the common unknowns.
[[nodiscard]] BatchCommonMatrix enlarged_by_scatter(const BatchCommonMatrix& covariance,
                                                    const BatchLinearisation& at,
                                                    const Eigen::MatrixXd& to_common,
                                                    const RowBlocks& blocks);

}  // namespace fusebench::smoother
