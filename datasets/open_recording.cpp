#include "datasets/open_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/nearest_name.hpp"

namespace fusebench {

namespace {

/// A row per format; the first whose files are all there is taken.
struct RecordingFormat {
  std::string_view name;
  std::vector<std::string_view> files;  ///< that a folder of this format must hold
  Result<Recording> (*open)(const std::filesystem::path& folder, const OpenOptions& options);
};

const std::array<RecordingFormat, 1>& formats() {
  static const std::array<RecordingFormat, 1> kFormats = {{
      {"tum",
       {"rgb.txt", "depth.txt"},
       [](const std::filesystem::path& folder, const OpenOptions& options) {
         return open_tum_rgbd(folder, options.tum);
       }},
  }};
  return kFormats;
}

bool fits(const RecordingFormat& format, const std::filesystem::path& folder) {
  return std::ranges::all_of(format.files, [&](std::string_view file) {
    std::error_code ignored;
    return std::filesystem::exists(folder / file, ignored);
  });
}

tl::unexpected<Error> unknown_format(std::string_view name) {
  std::vector<std::string_view> names;
  for (const RecordingFormat& format : formats()) names.push_back(format.name);
  return fail(ErrorCode::configuration, fmt::format("format = {} (allowed {})", name, fmt::join(names, ", ")),
              fmt::format("did you mean {}?", nearest_name(name, names)));
}

tl::unexpected<Error> unrecognised(const std::filesystem::path& folder) {
  std::vector<std::string> wanted;
  for (const RecordingFormat& format : formats()) {
    wanted.push_back(fmt::format("{} (files {})", format.name, fmt::join(format.files, ", ")));
  }
  return fail(ErrorCode::data_missing,
              fmt::format("{}: not a recording of a known format; looked for {}", folder.string(),
                          fmt::join(wanted, "; ")),
              "name the folder that holds these files, or say --format");
}

}  // namespace

Result<Recording> open_recording(const std::filesystem::path& folder, const OpenOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such folder", folder.string()));
  }
  for (const RecordingFormat& format : formats()) {
    if (options.format.empty() ? fits(format, folder) : format.name == options.format) {
      return format.open(folder, options);
    }
  }
  return options.format.empty() ? unrecognised(folder) : unknown_format(options.format);
}

}  // namespace fusebench
