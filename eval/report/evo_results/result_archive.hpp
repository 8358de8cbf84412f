// Results as the ZIP archives that --save_results writes and evo_res reads (evo v1.36.5: save_res_file() and
// load_res_file() of evo/tools/file_interface.py).
#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.hpp"
#include "eval/report/evo_results/evo_result.hpp"

namespace fusebench::evo_results {

/// The archive: info.json, stats.json, NAME.npy of the arrays, FILE.tum or FILE.kitti of the trajectories.
/// Error usage: more than an archive has room for.
[[nodiscard]] Result<std::string> archive_of(const EvoResult& result);

/// Reads an archive of evo's or ours; the trajectories are left out. Errors name the file: those of
/// read_zip() and parse_npy(), and data_corrupt where info.json, stats.json or the errors are missing or not
/// what they should be.
[[nodiscard]] Result<EvoResult> read_result(const std::filesystem::path& file);

}  // namespace fusebench::evo_results
