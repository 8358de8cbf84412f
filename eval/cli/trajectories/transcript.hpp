// The output of a verb with evo's --silent and --logfile.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::trajectories {

struct TranscriptOptions {
  bool silent = false;
  bool verbose = false;
  bool no_warnings = false;  ///< accepted, and of no effect
  std::filesystem::path logfile;
};
/// --silent, --logfile, -v (--verbose, --debug), and --no_warnings, which has no effect here.
void add_transcript_options(CLI::App& verb, TranscriptOptions& options, const char* what_verbose_does);
inline constexpr const char* kAlwaysComplete =
    "Accepted for compatibility with evo: the output is always complete";

/// Prints lines and stores them for the log file.
class Transcript {
 public:
  explicit Transcript(const TranscriptOptions& options);  ///< --silent hides progress from here on
  void note(std::string_view line);                       ///< on standard error
  void warn(const std::vector<std::string>& warnings);    ///< each as "warning: ..."
  void result(std::string_view text);                     ///< on standard output
  [[nodiscard]] Result<void> finish() const;              ///< appends to the log file. Error io

 private:
  TranscriptOptions options_;
  std::string said_;
};

}  // namespace fusebench::cli::trajectories
