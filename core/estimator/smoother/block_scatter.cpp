#include "core/estimator/smoother/block_scatter.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::smoother {

namespace {
constexpr std::size_t kMostBlocks = 8;
constexpr std::size_t kFewestBlocks = 4;
constexpr std::size_t kFewestFrames = 15;  // least number of frames in a block
}  // namespace

RowBlocks blocks_in_time(const BatchInput& input) {
  RowBlocks blocks;
  const std::size_t frames = input.instants_ns.size();
  const std::size_t count = std::min(kMostBlocks, frames / kFewestFrames);
  if (count < kFewestBlocks) return blocks;
  blocks.count = static_cast<int>(count);
  const auto add = [&](std::size_t frame, std::size_t rows) {
    blocks.of_row.insert(blocks.of_row.end(), rows, static_cast<int>(frame * count / frames));
  };
  for (const RelativeCameraMotion& motion : input.visual) add(motion.frame, 6);
  for (std::size_t k = 0; k + 1 < frames; ++k) add(k, 9);
  for (const VisualTiming& timing : input.timing) add(timing.frame, 3);
  return blocks;
}

BatchCommonMatrix enlarged_by_scatter(const BatchCommonMatrix& covariance, const BatchLinearisation& at,
                                      const Eigen::MatrixXd& to_common, const RowBlocks& blocks) {
  if (blocks.count == 0) return covariance;
  // Scores: change of the unknowns by each block.
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(at.columns.count, blocks.count);
  for (std::size_t row = 0; row < blocks.of_row.size(); ++row) {
    for (SparseRowsd::InnerIterator entry(at.jacobian, static_cast<Eigen::Index>(row)); entry; ++entry)
      scores(entry.col(), blocks.of_row[row]) += entry.value() * at.residuals[row];
  }
  const Eigen::MatrixXd moved = to_common.transpose() * scores;
  const double freedom = blocks.count - 1;
  Eigen::Matrix<double, kBatchCommonSize, 1> factor = Eigen::Matrix<double, kBatchCommonSize, 1>::Ones();
  for (Eigen::Index i = 0; i < kBatchCommonSize; ++i) {
    const double scatter = moved.row(i).squaredNorm() * blocks.count / freedom;
    if (covariance(i, i) > 0) factor[i] = std::sqrt(std::max(1.0, scatter / covariance(i, i)));
  }
  return factor.asDiagonal() * covariance * factor.asDiagonal();
}

}  // namespace fusebench::smoother
