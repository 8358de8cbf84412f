// Opens a recording of any known format.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "datasets/recording.hpp"
#include "datasets/tum_rgbd.hpp"

namespace fusebench {

struct OpenOptions {
  std::string format;  ///< "tum"; empty: recognised by the files in the folder
  TumOptions tum;
};

/// Errors: data_missing (no such folder, or no format fits its files), configuration (unknown format), and
/// those of the format's reader.
[[nodiscard]] Result<Recording> open_recording(const std::filesystem::path& folder,
                                               const OpenOptions& options = {});

}  // namespace fusebench
