#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "datasets/recording/exports/export_recording.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/recordings/export_request.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::cli::recordings {

namespace {

struct ExportVerbOptions {
  ExportRequest request;
  std::string format;
  bool json = false;
};

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
  ExportRequest request = options.request;
  request.format = *format;
  const auto done = export_as_requested(request);
  if (!done) return tl::unexpected(done.error());
  console::print_output(options.json ? export_json(done->summary, done->recording)
                                     : export_text(done->summary, done->recording));
  return 0;
}

}  // namespace

console::Verb add_export_verb(CLI::App& app) {
  auto options = std::make_shared<ExportVerbOptions>();
  CLI::App* verb = app.add_subcommand(
      "export", "Writes a recording in the format that another system's program reads (docs/exports.md)");
  verb->add_option("--format", options->format,
                   "tum (folder: ORB-SLAM3, fusebench), infinitam (folder), klg (file: "
                   "ElasticFusion; 640x480 only), sens (file: BundleFusion), open3d (folder: its "
                   "reconstruction system), euroc (folder: visual-inertial systems; grey)")
      ->type_name("NAME")
      ->required();
  add_export_request(*verb, options->request,
                     "What to write: a folder, for klg and sens a file; must not exist");
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "Colour is undistorted, and depth is registered to it. Depth is rounded to the unit of the "
      "format\n(mm; tum: 0.2 mm); values beyond its range become 0 and are counted. After an error nothing "
      "is left.\nPrints files, lost depth, and how to start the other program.");
  return {verb, [options] { return write_export(*options); }};
}

}  // namespace fusebench::cli::recordings
