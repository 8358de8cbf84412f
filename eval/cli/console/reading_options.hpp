// Options of the verbs that open a recording.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "datasets/open_recording.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::console {

/// As typed; see ReadOptions.
struct ReadingOptions {
  std::filesystem::path calibration;
  std::string camera;
  std::string format;
  std::optional<double> depth_units_per_metre;
  double max_difference_s = recording::ReadOptions{}.max_difference_s;
  std::optional<double> frame_rate_hz;
  bool published_stamps = false;
  bool filtered_depth = false;
};

/// --calibration, --camera, --format, --depth-units, --max-difference, --frame-rate, --published-stamps,
/// --filtered-depth. format_flag: another name for --format in verbs whose --format is that of their output.
void add_reading_options(CLI::App& verb, ReadingOptions& options,
                         const std::string& format_flag = "--format");

/// Errors: configuration for an unsupported camera, and those of read_calibration. Ranges are checked by the
/// reader.
[[nodiscard]] Result<datasets::OpenOptions> open_options(const ReadingOptions& options);

}  // namespace fusebench::cli::console
