// Preparations among the results, so that a recording is prepared once.
#pragma once

#include <atomic>
#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::preparation {

/// Where the calibration of the prepared recording is kept: <out>/prepared/<recording>-<16 digits>.toml, of
/// the recording's content and the version of the estimator.
[[nodiscard]] std::filesystem::path preparation_file(const std::filesystem::path& out,
                                                     const recording::Recording& recording);

/// Whether that file is there.
[[nodiscard]] bool is_kept(const std::filesystem::path& out, const recording::Recording& recording);

/// The recording with the constants that it tells itself (preparation.hpp): as that file says, or as they are
/// measured now; the file is then written
/// if it can be. A recording whose calibration leaves nothing open stays as it is.
/// Errors: those of prepare() and read_calibration().
[[nodiscard]] Result<recording::Recording> prepared_recording(recording::Recording recording,
                                                              const std::filesystem::path& out,
                                                              const Workers& workers,
                                                              const std::atomic<bool>* stop);

}  // namespace fusebench::preparation
