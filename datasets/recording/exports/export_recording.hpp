// Writes a recording in the format that another system's program reads.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/recording/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

/// Error configuration: an unknown name, with the nearest one.
[[nodiscard]] Result<ExportFormat> parse_export_format(std::string_view name);
[[nodiscard]] std::vector<std::string_view> export_format_names();

/// Writes all frames: undistorted colour and the depth of each of its pixels, in one camera. `out` is a
/// folder, or for klg and sens a file; it must not exist. All of it appears at once or, on an error, nothing
/// does; the same recording gives the same bytes. export_formats.hpp says what each format holds. Errors:
/// usage (no frames or more than the format takes, a size that it does not take, `out` exists), data_corrupt
/// (stamps that do not rise), io, and those of load_frame.
[[nodiscard]] Result<ExportSummary> export_recording(const recording::Recording& recording,
                                                     ExportFormat format, const std::filesystem::path& out);

}  // namespace fusebench::exports
