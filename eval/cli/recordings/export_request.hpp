// Opening a recording and exporting it, as the verbs export and convert do.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.hpp"
#include "datasets/recording/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/cli/console/reading_options.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::recordings {

struct ExportRequest {
  std::string recording;
  exports::ExportFormat format = exports::ExportFormat::tum;
  std::filesystem::path out;
  std::filesystem::path data;
  console::ReadingOptions reading;
  std::string frames;
};

/// Adds RECORDING, --out (out_text: what it is), --frames, the options of reading, and --data.
void add_export_request(CLI::App& verb, ExportRequest& request, const std::string& out_text);

struct DoneExport {
  recording::Recording recording;
  exports::ExportSummary summary;
};

/// Prints the warnings of reading and shows progress. Errors: those of opening, of export_recording, usage.
[[nodiscard]] Result<DoneExport> export_as_requested(const ExportRequest& request);

}  // namespace fusebench::cli::recordings
