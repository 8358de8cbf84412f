#include "eval/cli/recordings/export_request.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "datasets/recording/exports/export_recording.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/recording_names.hpp"

namespace fusebench::cli::recordings {

namespace {

Result<recording::Recording> open_for_export(const ExportRequest& request) {
  const auto window = console::parse_frames(request.frames);
  if (!window) return tl::unexpected(window.error());
  const auto how = console::open_options(request.reading);
  if (!how) return tl::unexpected(how.error());
  const auto place = suites::find_recording(request.recording, request.data);
  if (!place) return tl::unexpected(place.error());
  return run::open_window(*place, *how, *window);
}

/// .sens files are recognised by their ending.
Result<void> check_ending(const ExportRequest& request) {
  if (request.format != exports::ExportFormat::sens || request.out.extension() == ".sens") return {};
  return fail(ErrorCode::usage,
              fmt::format("--out {}: files of this format must end with .sens", request.out.string()),
              fmt::format("--out {}.sens", request.out.string()));
}

}  // namespace

void add_export_request(CLI::App& verb, ExportRequest& request, const std::string& out_text) {
  verb.add_option("RECORDING", request.recording,
                  "Folder or file of a recording, or the name of one under --data")
      ->required();
  verb.add_option("--out", request.out, out_text)->type_name("PATH")->required();
  verb.add_option("--frames", request.frames, "Only frames A to B-1; A: takes all from A on")
      ->type_name("A:B");
  console::add_reading_options(verb, request.reading, "--recording-format");
  console::add_data_option(verb, request.data);
}

Result<DoneExport> export_as_requested(const ExportRequest& request) {
  if (auto ending = check_ending(request); !ending) return tl::unexpected(ending.error());
  auto recording = open_for_export(request);
  if (!recording) return tl::unexpected(recording.error());
  console::print_warnings(recording->warnings);
  console::Progress progress("writing " + request.out.string());
  recording->load_frame = [&progress, count = recording->frames.size(),
                           load = std::move(recording->load_frame)](std::size_t frame) -> Result<RgbdFrame> {
    progress.show(frame, count);
    return load(frame);
  };
  auto summary = exports::export_recording(*recording, request.format, request.out);
  recording->load_frame = nullptr;  // it refers to `progress`
  if (!summary) return tl::unexpected(summary.error());
  return DoneExport{std::move(*recording), std::move(*summary)};
}

}  // namespace fusebench::cli::recordings
