// Which format a file of poses has: by the names in it, by what was given, or by its columns.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/trajectory/pose_head.hpp"
#include "core/base/trajectory/pose_table.hpp"
#include "eval/metrics/trajectory_files/matrix_rows.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"

namespace fusebench::trajectory_files {

struct RecognisedFormat {
  TrajectoryFormat format = TrajectoryFormat::tum;
  std::string source;             ///< "names in line 1", "as given", "by its columns"
  trajectory::PoseLayout layout;  ///< of tum, euroc and openvins
  MatrixLayout matrices = {};     ///< of kitti
  bool needs_commas = false;      ///< euroc without names: between blanks, rows are taken for TUM text
};

/// Names in the file go before the format that is given, with a warning if they contradict it, and that
/// before the columns of the first rows. Error data_corrupt: columns that fit no format, matrices given as
/// another format, or (euroc) no commas.
[[nodiscard]] Result<RecognisedFormat> recognise_format(const trajectory::PoseHead& head,
                                                        const TrajectoryReading& reading,
                                                        const std::filesystem::path& file,
                                                        std::vector<std::string>& warnings);

}  // namespace fusebench::trajectory_files
