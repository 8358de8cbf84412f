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
  std::string
      format;  ///< "tum", "icl", ...; empty: recognised by the files in the folder, or the file's name
  recording::ReadOptions read;
};

/// The format whose files the folder holds, or that the file is of; nothing if there is none.
[[nodiscard]] std::optional<std::string_view> recognise_format(const std::filesystem::path& place);

/// place: a folder, or a file of a format whose recordings are one (.sens, .bag). Errors: data_missing (no
/// such place, or no format fits its files: the message lists those that are known), configuration (unknown
/// format, one that has to be converted), and those of the format's reader.
[[nodiscard]] Result<recording::Recording> open_recording(const std::filesystem::path& place,
                                                          const OpenOptions& options = {});

}  // namespace fusebench::datasets
