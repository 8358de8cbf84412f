#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/inspection/inspection.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/report/inspection_report/inspection_json.hpp"
#include "eval/report/inspection_report/inspection_page.hpp"
#include "eval/report/inspection_report/inspection_text.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/recording_names.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::recordings {

namespace {

struct InspectVerbOptions {
  std::string recording;
  std::filesystem::path data;
  console::ReadingOptions reading;
  std::string frames;
  std::filesystem::path page;
  int threads = 1;
  bool json = false;
};

/// Errors of the data become findings; errors of usage end the verb.
bool is_finding(const Error& error) {
  return error.code == ErrorCode::data_missing || error.code == ErrorCode::data_corrupt;
}

Result<recording::Recording> open(const InspectVerbOptions& options, const std::filesystem::path& folder) {
  const auto window = console::parse_frames(options.frames);
  if (!window) return tl::unexpected(window.error());
  const auto how = console::open_options(options.reading);
  if (!how) return tl::unexpected(how.error());
  return run::open_window(folder, *how, *window);
}

/// Number of frames in the catalogue.
std::optional<std::size_t> published_frames(const std::filesystem::path& folder) {
  const calibration::CatalogueEntry* entry = calibration::catalogue_entry_of_folder(folder);
  if (entry == nullptr || !entry->frames) return std::nullopt;
  return static_cast<std::size_t>(*entry->frames);
}

int print(const inspection::Inspection& inspection, const InspectVerbOptions& options) {
  console::print_output(options.json ? inspection_report::to_json(inspection)
                                     : inspection_report::to_text(inspection));
  return inspection.count(inspection::Severity::error) > 0 ? exit_code(ErrorCode::data_corrupt) : 0;
}

Result<int> run(const InspectVerbOptions& options) {
  console::Progress progress("opening " + options.recording);
  const auto folder = suites::find_recording(options.recording, options.data);
  auto recording = folder.and_then([&](const auto& found) { return open(options, found); });
  if (!recording && options.json && is_finding(recording.error())) {
    console::print_error(recording.error());
    return print(inspection::refused_inspection(options.recording, options.reading.format, recording.error()),
                 options);
  }
  if (!recording) return tl::unexpected(recording.error());
  progress.say(fmt::format("inspecting {} frames", recording->frames.size()));
  const Workers workers(options.threads);
  inspection::InspectOptions inspect_options;
  if (options.frames.empty()) inspect_options.expected_frames = published_frames(*folder);
  const inspection::Inspection inspection = inspection::inspect(*recording, workers, inspect_options);
  if (!options.page.empty()) {
    const auto written =
        text::write_text_file(options.page, inspection_report::to_page(inspection, *recording));
    if (!written) return tl::unexpected(written.error());
  }
  return print(inspection, options);
}

}  // namespace

console::Verb add_inspect_verb(CLI::App& app) {
  auto options = std::make_shared<InspectVerbOptions>();
  CLI::App* verb = app.add_subcommand(
      "inspect", "Checks a recording: stamps, images, depth, motion, IMU, calibration and ground truth");
  verb->add_option("RECORDING", options->recording, "Folder of a recording, or the name of one under --data")
      ->required();
  verb->add_option("--frames", options->frames, "Only frames A to B-1; A: takes all from A on")
      ->type_name("A:B");
  console::add_reading_options(*verb, options->reading);
  verb->add_option("--page", options->page, "Writes a page with plots, which needs no network, as well")
      ->type_name("FILE.html");
  console::add_threads_option(*verb, options->threads);
  console::add_data_option(*verb, options->data);
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "Findings are errors (results on this recording are not valid), warnings and notes; docs/inspect.md "
      "lists\ntheir codes. Exit code 3 if there is an error.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::recordings
