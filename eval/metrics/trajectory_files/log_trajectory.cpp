#include "eval/metrics/trajectory_files/log_trajectory.hpp"

#include <optional>
#include <utility>

#include "core/base/io/text_table.hpp"
#include "eval/metrics/trajectory_files/pose_matrices.hpp"

namespace fusebench::trajectory_files {

namespace {

constexpr int kRows = 4;

/// The four lines of a pose; nothing of a lost frame.
Result<std::optional<Eigen::Matrix4d>> read_matrix(io::TextTable& table) {
  Eigen::Matrix<double, kRows, kRows, Eigen::RowMajor> matrix;
  bool lost = false;
  for (int row = 0; row < kRows; ++row) {
    const auto more = table.next();
    if (!more) return tl::unexpected(more.error());
    if (!*more)
      return table.fail_here("the file ends within a pose",
                             "the program may have been stopped while it wrote");
    if (!table.has(3)) return table.fail_here("three numbers where a row of a 4x4 matrix is expected");
    const auto whole = present_numbers(table, 0, {matrix.row(row).data(), kRows});
    if (!whole) return tl::unexpected(whole.error());
    lost = lost || !*whole;
  }
  if (lost) return std::optional<Eigen::Matrix4d>();
  if (auto last = check_last_row(table, matrix); !last) return tl::unexpected(last.error());
  return std::optional<Eigen::Matrix4d>(matrix);
}

}  // namespace

Result<Trajectory> read_log_trajectory(const std::filesystem::path& file,
                                       std::vector<std::string>& warnings) {
  auto table = io::TextTable::open(file, "first second third [fourth]");
  if (!table) return tl::unexpected(table.error());
  PoseMatrices poses;
  while (true) {
    const auto more = table->next();
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    if (table->has(3))
      return table->fail_here("four numbers where a frame's line of three integers is expected");
    const auto number = frame_number(*table, 0, poses.rows().poses);
    if (!number) return tl::unexpected(number.error());
    const auto matrix = read_matrix(*table);
    if (!matrix) return tl::unexpected(matrix.error());
    if (!*matrix) {
      poses.leave_out(*table);
      continue;
    }
    if (auto taken = poses.take(*table, *number, (*matrix)->topRows<3>()); !taken)
      return tl::unexpected(taken.error());
  }
  auto rows = poses.finish(file, warnings);
  if (!rows) return tl::unexpected(rows.error());
  return std::move(rows->poses);
}

}  // namespace fusebench::trajectory_files
