// Opens a recording of any known format.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::datasets {

struct OpenOptions {
  std::string format;  ///< "tum", "icl", ...; empty: recognised by the files in the folder
  recording::ReadOptions read;
};

/// The format whose files the folder holds; nothing if there is none.
[[nodiscard]] std::optional<std::string_view> recognise_format(const std::filesystem::path& folder);

/// Errors: data_missing (no such folder, or no format fits its files), configuration (unknown format), and
/// those of the format's reader.
[[nodiscard]] Result<recording::Recording> open_recording(const std::filesystem::path& folder,
                                                          const OpenOptions& options = {});

}  // namespace fusebench::datasets
