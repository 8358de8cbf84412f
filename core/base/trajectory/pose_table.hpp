// The rows of tables of poses, by their columns.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "core/base/trajectory/pose_columns.hpp"
#include "core/base/trajectory/pose_head.hpp"
#include "core/base/trajectory/trajectory_rows.hpp"

namespace fusebench::trajectory {

/// How rows are read.
struct PoseLayout {
  PoseColumns columns = kTumColumns;
  io::TimeUnit unit = io::TimeUnit::seconds;
  std::string names = "timestamp tx ty tz qx qy qz qw ...";  ///< as for io::TextTable, for messages
  std::size_t explained = 8;  ///< columns that the format or names say the meaning of
  int names_line = 0;         ///< left out, a line of names without '#'; 0: there is none
};

/// The named columns, if there are any; else `layout`, but that TUM's may have stamps in two columns.
/// Warnings say so, and name another column that counts time.
[[nodiscard]] PoseLayout layout_of(const PoseHead& head, PoseLayout layout, const std::filesystem::path& file,
                                   std::vector<std::string>& warnings);

/// What is done with a row before its pose is taken; not called for lost frames.
using PoseRow = std::function<Result<void>(const io::TextTable& table)>;

/// Reads the poses of a file. Rows of lost frames (one of the seven numbers is missing, io::is_missing(), or
/// the quaternion is 0 0 0 0) are left out. Warnings count these rows, and columns without a meaning.
///
/// Errors name file:line: data_missing; data_corrupt for a row that is no pose, the order in time, a
/// file without rows or with rows of lost frames only; those of `row`.
[[nodiscard]] Result<TrajectoryRows> read_pose_rows(const std::filesystem::path& file,
                                                    const PoseLayout& layout, io::TimeOrder order,
                                                    std::vector<std::string>& warnings,
                                                    const PoseRow& row = {});

}  // namespace fusebench::trajectory
