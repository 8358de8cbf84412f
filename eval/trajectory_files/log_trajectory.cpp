#include "eval/trajectory_files/log_trajectory.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/io/text_table.hpp"
#include "core/trajectory/trajectory_rows.hpp"
#include "eval/trajectory_files/nearest_rotation.hpp"

namespace fusebench::trajectory_files {

namespace {

constexpr double kNoRotation = 1e-2;
constexpr double kRounding = 1e-5;
constexpr int kRows = 4;

Result<std::int64_t> frame_number(const io::TextTable& table, const Trajectory& before) {
  if (table.has(3)) return table.fail_here("four numbers where a frame's line of three integers is expected");
  const auto number = table.number(0);
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

/// The four lines of a pose.
Result<Eigen::Matrix4d> read_matrix(io::TextTable& table) {
  Eigen::Matrix<double, kRows, kRows, Eigen::RowMajor> matrix;
  for (int row = 0; row < kRows; ++row) {
    const auto more = table.next();
    if (!more) return tl::unexpected(more.error());
    if (!*more)
      return table.fail_here("the file ends within a pose",
                             "the program may have been stopped while it wrote");
    if (!table.has(3)) return table.fail_here("three numbers where a row of a 4x4 matrix is expected");
    if (auto read = table.numbers(0, {matrix.row(row).data(), kRows}); !read)
      return tl::unexpected(read.error());
  }
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > kNoRotation)
    return table.fail_here("the last row of a pose is not 0 0 0 1");
  return Eigen::Matrix4d(matrix);
}

}  // namespace

Result<Trajectory> read_log_trajectory(const std::filesystem::path& file,
                                       std::vector<std::string>& warnings) {
  auto table = io::TextTable::open(file, "first second third [fourth]");
  if (!table) return tl::unexpected(table.error());
  Trajectory poses;
  double largest = 0;
  while (true) {
    const auto more = table->next();
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    const auto number = frame_number(*table, poses);
    if (!number) return tl::unexpected(number.error());
    const auto matrix = read_matrix(*table);
    if (!matrix) return tl::unexpected(matrix.error());
    const NearestRotation rotation = nearest_rotation(matrix->topLeftCorner<3, 3>());
    if (!(rotation.deviation < kNoRotation)) {
      return table->fail_here(
          fmt::format("the 3x3 part is no rotation (determinant {:g}, R^T R off identity by {:.2g})",
                      matrix->topLeftCorner<3, 3>().determinant(), rotation.deviation));
    }
    if (auto within = trajectory::check_position(*table, matrix->topRightCorner<3, 1>()); !within)
      return tl::unexpected(within.error());
    largest = std::max(largest, rotation.deviation);
    poses.push_back({*number, {Quaterniond(rotation.R), matrix->topRightCorner<3, 1>()}});
  }
  if (poses.empty())
    return fail(ErrorCode::data_corrupt, fmt::format("{}: has no rows (expected poses)", file.string()));
  if (largest > kRounding)
    warnings.push_back(
        fmt::format("{}: rotations are off orthonormal by up to {:.2g} (replaced by the nearest "
                    "rotation)",
                    file.string(), largest));
  return poses;
}

}  // namespace fusebench::trajectory_files
