#include "eval/metrics/trajectory_files/pose_matrices.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/base/io/row_text.hpp"
#include "core/base/io/text_table.hpp"
#include "eval/metrics/trajectory_files/nearest_rotation.hpp"

namespace fusebench::trajectory_files {

namespace {

constexpr double kNoRotation = 1e-2;
constexpr double kRounding = 1e-5;  // KITTI's files have six digits

}  // namespace

Result<std::int64_t> frame_number(const io::TextTable& table, std::size_t column, const Trajectory& before) {
  const auto number = table.number(column);
  if (!number) return tl::unexpected(number.error());
  constexpr double kMostFrames = 1e9;
  if (!(*number >= 0 && *number <= kMostFrames) || std::floor(*number) != *number)
    return table.fail_here("the number of a frame is an integer from 0 on");
  const auto frame = static_cast<std::int64_t>(*number);
  if (!before.empty() && frame <= before.back().timestamp_ns)
    return table.fail_here(
        fmt::format("frame {} after frame {}: numbers must rise", frame, before.back().timestamp_ns));
  return frame;
}

Result<bool> present_numbers(const io::TextTable& table, std::size_t first, std::span<double> values) {
  bool all = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (io::is_missing(table.text(first + i))) {
      all = false;
      continue;
    }
    const auto number = table.number(first + i);
    if (!number) return tl::unexpected(number.error());
    values[i] = *number;
  }
  return all;
}

Result<void> check_last_row(const io::TextTable& table, const Eigen::Matrix4d& pose) {
  const auto is_last = [](const Eigen::RowVector4d& last) {
    constexpr double kTolerance = 1e-6;
    return (last - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kTolerance;
  };
  const Eigen::RowVector4d last = pose.row(3);
  if (is_last(last)) return {};
  return table.fail_here(
      fmt::format("the last row of the pose is {:g} {:g} {:g} {:g} (expected 0 0 0 1)", last[0], last[1],
                  last[2], last[3]),
      is_last(pose.col(3).transpose())
          ? "the matrix is transposed: write poses row by row, translations in the last column"
          : "a pose is 3x4 or 4x4 numbers, row by row");
}

Result<void> PoseMatrices::take(const io::TextTable& table, std::int64_t key_ns,
                                const Eigen::Matrix<double, 3, 4>& pose) {
  const NearestRotation rotation = nearest_rotation(pose.leftCols<3>());
  if (!(rotation.deviation < kNoRotation)) {
    return table.fail_here(
        fmt::format("the 3x3 part is no rotation (determinant {:g}, R^T R off identity by {:.2g})",
                    pose.leftCols<3>().determinant(), rotation.deviation),
        "a pose is 3x4 or 4x4 numbers, row by row");
  }
  if (auto within = trajectory::check_position(table, pose.col(3)); !within) return within;
  if (rotation.deviation > largest_) {
    largest_ = rotation.deviation;
    largest_line_ = table.line();
  }
  rows_.poses.push_back({key_ns, {Quaterniond(rotation.R), pose.col(3)}});
  rows_.lines.push_back(table.line());
  return {};
}

void PoseMatrices::leave_out(const io::TextTable& table) {
  if (lost_++ == 0) lost_line_ = table.line();
}

Result<trajectory::TrajectoryRows> PoseMatrices::finish(const std::filesystem::path& file,
                                                        std::vector<std::string>& warnings) {
  if (rows_.poses.empty())
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: has no rows (expected poses, of which numbers are not missing)", file.string()));
  if (largest_ > kRounding)
    warnings.push_back(
        fmt::format("{}:{}: rotations are off orthonormal by up to {:.2g} (replaced by the nearest rotation)",
                    file.string(), largest_line_, largest_));
  if (lost_ > 0)
    warnings.push_back(
        fmt::format("{}:{}: {} of {} poses are of lost frames (a number is missing or nan) and are left out",
                    file.string(), lost_line_, lost_, lost_ + rows_.poses.size()));
  return std::move(rows_);
}

}  // namespace fusebench::trajectory_files
