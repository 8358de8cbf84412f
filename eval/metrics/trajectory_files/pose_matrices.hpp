// Poses that a file holds as matrices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/trajectory/trajectory_rows.hpp"
#include "core/base/types.hpp"

namespace fusebench::trajectory_files {

/// The whole number of a frame in a column, larger than that of the pose before. Error data_corrupt.
[[nodiscard]] Result<std::int64_t> frame_number(const io::TextTable& table, std::size_t column,
                                                const Trajectory& before);

/// Fills values from neighbouring columns; false if one is missing (io::is_missing()). Error data_corrupt.
[[nodiscard]] Result<bool> present_numbers(const io::TextTable& table, std::size_t first,
                                           std::span<double> values);

/// The last row of a pose is 0 0 0 1. Error data_corrupt; its hint names a transposed pose.
[[nodiscard]] Result<void> check_last_row(const io::TextTable& table, const Eigen::Matrix4d& pose);

/// Collects the poses of a file.
class PoseMatrices {
 public:
  /// Adds [R t] in metres with the nearest rotation. Error data_corrupt: R is no rotation to a hundredth, or
  /// t is beyond trajectory::kMostPosition.
  [[nodiscard]] Result<void> take(const io::TextTable& table, std::int64_t key_ns,
                                  const Eigen::Matrix<double, 3, 4>& pose);
  /// A row or pose of a lost frame, which is left out.
  void leave_out(const io::TextTable& table);

  [[nodiscard]] const trajectory::TrajectoryRows& rows() const { return rows_; }
  [[nodiscard]] std::size_t lost() const { return lost_; }
  /// Warnings say how far off rotations were, and count lost frames. Error data_corrupt: no pose.
  [[nodiscard]] Result<trajectory::TrajectoryRows> finish(const std::filesystem::path& file,
                                                          std::vector<std::string>& warnings);

 private:
  trajectory::TrajectoryRows rows_;
  double largest_ = 0;  ///< deviation of a rotation
  int largest_line_ = 0;
  std::size_t lost_ = 0;
  int lost_line_ = 0;
};

}  // namespace fusebench::trajectory_files
