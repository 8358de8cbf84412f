// Opens a recording of any known format.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "datasets/read_options.hpp"
#include "datasets/recording.hpp"

namespace fusebench {

struct OpenOptions {
  std::string format;  ///< "tum", "icl", ...; empty: recognised by the files in the folder
  ReadOptions read;
};

/// The format whose files the folder holds; nothing if there is none.
[[nodiscard]] std::optional<std::string_view> recognise_format(const std::filesystem::path& folder);

/// Errors: data_missing (no such folder, or no format fits its files), configuration (unknown format), and
/// those of the format's reader.
[[nodiscard]] Result<Recording> open_recording(const std::filesystem::path& folder,
                                               const OpenOptions& options = {});

}  // namespace fusebench
