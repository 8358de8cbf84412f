// The calibration.toml that a verb writes.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::cli::recordings {

/// Writes the file, unless its name is empty, and prints its name and the file that it replaces. Errors: io;
/// configuration (a value that read_calibration() would refuse).
[[nodiscard]] Result<void> write_calibration(const std::filesystem::path& out,
                                             const calibration::RigCalibration& rig);

}  // namespace fusebench::cli::recordings
