// Options of the verbs that run the estimator over one recording.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/run/run.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::console {

/// As typed.
struct RunRequest {
  std::string recording;
  std::filesystem::path data;
  std::string variant = "full";
  std::string imu = "recorded";
  std::string prepare = "off";  ///< or "auto"
  ReadingOptions reading;
  std::filesystem::path config;
  std::vector<std::string> sets;
  std::string frames;
  int threads = 1;
};

/// RECORDING, --variant, --imu, --set, --config, --threads, --frames, the reading options and --data.
void add_run_request(CLI::App& verb, RunRequest& request);

/// The specification, without a place for results. Errors: configuration, usage, data_missing.
[[nodiscard]] Result<run::RunSpec> spec_of(const RunRequest& request);

}  // namespace fusebench::cli::console
