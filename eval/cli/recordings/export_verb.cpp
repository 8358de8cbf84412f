#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "datasets/exports/export_recording.hpp"
#include "datasets/open_recording.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/suites/suite_file.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::cli::recordings {

namespace {

struct ExportVerbOptions {
  std::string recording;
  std::string format;
  std::filesystem::path out;
  std::filesystem::path data;
  console::ReadingOptions reading;
  std::string frames;
  bool json = false;
};

Result<recording::Recording> open_for_export(const ExportVerbOptions& options) {
  const auto window = console::parse_frames(options.frames);
  if (!window) return tl::unexpected(window.error());
  const auto how = console::open_options(options.reading);
  if (!how) return tl::unexpected(how.error());
  const auto folder = suites::find_recording(options.recording, options.data);
  if (!folder) return tl::unexpected(folder.error());
  auto recording = datasets::open_recording(*folder, *how);
  if (!recording || !*window) return recording;
  const auto selected = run::select_window(*recording, **window);
  if (!selected) return tl::unexpected(selected.error());
  return recording;
}

double lost_share(const exports::DepthCounts& depth) {
  if (depth.measured == 0) return 0;
  return static_cast<double>(depth.beyond_range) / static_cast<double>(depth.measured);
}

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  return names;
}

std::string export_json(const exports::ExportSummary& summary, const recording::Recording& recording) {
  using Json = nlohmann::ordered_json;
  const Json document{{"recording", recording.name},
                      {"recording_fingerprint", recording.fingerprint},
                      {"format", exports::to_string(summary.format)},
                      {"out", summary.out.string()},
                      {"files", names_of(summary.files)},
                      {"frames", summary.frames},
                      {"width_px", recording.rig.camera.width_px},
                      {"height_px", recording.rig.camera.height_px},
                      {"imu_samples", recording.imu.size()},
                      {"depth_units_per_metre", summary.depth_storage.units_per_metre},
                      {"depth_farthest_m", summary.depth_storage.farthest_m()},
                      {"depth_pixels", summary.depth.measured},
                      {"depth_pixels_lost", summary.depth.beyond_range},
                      {"notes", summary.notes}};
  return text::json_text(document) + "\n";
}

std::string export_text(const exports::ExportSummary& summary, const recording::Recording& recording) {
  const PinholeCamera& camera = recording.rig.camera;
  std::string text = fmt::format("{}\n", summary.out.string());
  fmt::format_to(std::back_inserter(text), "  {}: {} frames of {}x{} pixels from '{}'\n",
                 exports::to_string(summary.format), summary.frames, camera.width_px, camera.height_px,
                 recording.name);
  fmt::format_to(std::back_inserter(text), "  files: {}\n", fmt::join(names_of(summary.files), ", "));
  fmt::format_to(
      std::back_inserter(text),
      "  depth: {:g} = 1 m, up to {:.1f} m; lost beyond that range: {} of {} measurements ({:.2g} %)\n",
      summary.depth_storage.units_per_metre, summary.depth_storage.farthest_m(), summary.depth.beyond_range,
      summary.depth.measured, 100 * lost_share(summary.depth));
  for (const std::string& note : summary.notes) fmt::format_to(std::back_inserter(text), "  {}\n", note);
  return text;
}

Result<int> write_export(const ExportVerbOptions& options) {
  const auto format = exports::parse_export_format(options.format);
  if (!format) return tl::unexpected(format.error());
  auto recording = open_for_export(options);
  if (!recording) return tl::unexpected(recording.error());
  for (const std::string& warning : recording->warnings)
    console::print_progress(fmt::format("warning: {}", warning));
  console::ProgressBar bar("exporting");
  recording->load_frame = [&bar, count = recording->frames.size(),
                           load = std::move(recording->load_frame)](std::size_t frame) -> Result<RgbdFrame> {
    if (console::stop_requested())
      return fail(ErrorCode::run_failed, "the export was stopped; nothing was written");
    bar.show(frame, count);
    return load(frame);
  };
  const auto summary = exports::export_recording(*recording, *format, options.out);
  bar.clear();
  if (!summary) return tl::unexpected(summary.error());
  console::print_output(options.json ? export_json(*summary, *recording) : export_text(*summary, *recording));
  return 0;
}

}  // namespace

console::Verb add_export_verb(CLI::App& app) {
  auto options = std::make_shared<ExportVerbOptions>();
  CLI::App* verb = app.add_subcommand(
      "export", "Writes a recording in the format that another system's program reads (docs/exports.md)");
  verb->add_option("RECORDING", options->recording, "Folder of a recording, or the name of one under --data")
      ->required();
  verb->add_option("--format", options->format,
                   "tum (folder: ORB-SLAM3, fusebench), infinitam (folder), klg (file: "
                   "ElasticFusion; 640x480 only), sens (file: BundleFusion), open3d (folder: its "
                   "reconstruction system), euroc (folder: visual-inertial systems; grey)")
      ->type_name("NAME")
      ->required();
  verb->add_option("--out", options->out, "What to write: a folder, for klg and sens a file; must not exist")
      ->type_name("PATH")
      ->required();
  verb->add_option("--frames", options->frames, "Only frames A to B-1; A: takes all from A on")
      ->type_name("A:B");
  console::add_reading_options(*verb, options->reading, "--recording-format");
  console::add_data_option(*verb, options->data);
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "Colour is undistorted, and depth is that of colour's pixels: both are of one camera. Depth is rounded "
      "to what\nthe format stores (mm; tum: 0.2 mm); what is beyond its range becomes 0 and is counted. "
      "Nothing is written\nwhere there is an error. Prints what was written, what was lost, and how the "
      "other "
      "program is started.");
  return {verb, [options] { return write_export(*options); }};
}

}  // namespace fusebench::cli::recordings
