#include "eval/metrics/trajectory_files/matrix_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/io/row_text.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "eval/metrics/trajectory_files/pose_matrices.hpp"

namespace fusebench::trajectory_files {

namespace {

using trajectory::HeadRow;
using trajectory::PoseHead;

constexpr std::size_t kUpperPart = 12;  // numbers of the upper 3x4 of a pose
constexpr std::size_t kWhole = 16;

/// Four numbers of every row, each `step` columns after the one before, are 0 0 0 1.
bool is_last_row(std::span<const HeadRow> rows, std::size_t first, std::size_t step) {
  return std::ranges::all_of(rows, [&](const HeadRow& row) {
    return row.number(first) == 0 && row.number(first + step) == 0 && row.number(first + 2 * step) == 0 &&
           row.number(first + 3 * step) == 1;
  });
}

bool are_frame_numbers(std::span<const HeadRow> rows) {
  constexpr double kMostFrames = 1e7;  // at 1000 Hz three hours
  double before = -1;
  return std::ranges::all_of(rows, [&](const HeadRow& row) {
    const double number = row.number(0);
    const bool rises = number > before && number < kMostFrames && std::floor(number) == number;
    before = number;
    return rises;
  });
}

bool is_lost(const HeadRow& row) {
  return std::any_of(row.fields.begin() + 1, row.fields.end(), io::is_missing);
}

}  // namespace

bool has_rotations(std::span<const HeadRow> rows, std::size_t first) {
  return std::ranges::all_of(rows, [&](const HeadRow& row) {
    return row.fields.size() >= first + kUpperPart && trajectory::is_unit(row.norm(first, 3)) &&
           trajectory::is_unit(row.norm(first + 4, 3)) && trajectory::is_unit(row.norm(first + 8, 3));
  });
}

std::string MatrixLayout::described() const {
  if (key == PoseKey::order) return {};
  return key == PoseKey::stamp ? ", matrices after a stamp" : ", matrices after the number of the frame";
}

std::optional<MatrixLayout> matrix_layout(const PoseHead& head, bool unit_is_given) {
  const std::size_t columns = head.columns();
  const std::size_t first = columns == kUpperPart + 1 || columns == kWhole + 1 ? 1 : 0;
  if (columns != first + kUpperPart && columns != first + kWhole) return std::nullopt;
  std::vector<HeadRow> rows;
  for (const HeadRow& row : head.rows) {
    if (row.fields.size() != columns) return std::nullopt;
    if (!is_lost(row)) rows.push_back(row);
  }
  if (rows.empty()) return std::nullopt;
  MatrixLayout layout;
  layout.is_surely_one = has_rotations(rows, first);
  if (columns == first + kWhole && !is_last_row(rows, first + kUpperPart, 1)) {
    if (!is_last_row(rows, first + 3, 4)) return std::nullopt;
    layout.is_transposed = true;
  }
  if (first == 1) layout.key = !unit_is_given && are_frame_numbers(rows) ? PoseKey::number : PoseKey::stamp;
  return layout;
}

Result<LoadedTrajectory> read_matrix_rows(const std::filesystem::path& file, const MatrixLayout& layout,
                                          io::TimeUnit unit, trajectory::Duplicates duplicates,
                                          std::vector<std::string>& warnings) {
  const std::size_t first = layout.key == PoseKey::order ? 0 : 1;
  PoseMatrices poses;
  const auto row = [&](const io::TextTable& table) -> Result<void> {
    const auto key_ns =
        layout.key == PoseKey::stamp ? table.time_ns(0, unit)
        : layout.key == PoseKey::number
            ? frame_number(table, 0, poses.rows().poses)
            : Result<std::int64_t>(static_cast<std::int64_t>(poses.rows().poses.size() + poses.lost()));
    if (!key_ns) return tl::unexpected(key_ns.error());
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = Eigen::Matrix4d::Identity();
    const auto whole = present_numbers(table, first, {matrix.data(), table.size() - first});
    if (!whole) return tl::unexpected(whole.error());
    if (!*whole) {
      poses.leave_out(table);
      return {};
    }
    const Eigen::Matrix4d T =
        layout.is_transposed ? Eigen::Matrix4d(matrix.transpose()) : Eigen::Matrix4d(matrix);
    if (auto last = check_last_row(table, T); !last) return last;
    return poses.take(table, *key_ns, T.topRows<3>());
  };
  const std::string columns = fmt::format("{}r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz [m41 m42 m43 m44]",
                                          first == 1 ? "key " : "");
  if (auto read = io::for_each_row(file, columns, row); !read) return tl::unexpected(read.error());
  if (layout.is_transposed)
    warnings.push_back(fmt::format("{}: matrices are transposed (translations in the last row), and read so",
                                   file.string()));
  const bool has_gaps = poses.lost() > 0;
  auto rows = poses.finish(file, warnings);
  if (!rows) return tl::unexpected(rows.error());
  LoadedTrajectory loaded;
  loaded.format = TrajectoryFormat::kitti;
  loaded.key = layout.key == PoseKey::order && has_gaps ? PoseKey::number : layout.key;
  if (layout.key != PoseKey::stamp) {
    loaded.poses = std::move(rows->poses);
    return loaded;
  }
  auto ordered = trajectory::ordered(std::move(*rows), duplicates, file, warnings);
  if (!ordered) return tl::unexpected(ordered.error());
  loaded.poses = std::move(*ordered);
  return loaded;
}

}  // namespace fusebench::trajectory_files
