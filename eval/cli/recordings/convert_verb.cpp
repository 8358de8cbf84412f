#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/recordings/export_request.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::cli::recordings {

namespace {

struct ConvertVerbOptions {
  ExportRequest request;
  bool json = false;
};

std::string truth_of(const recording::Recording& recording) {
  if (recording.ground_truth.empty()) return "none";
  return recording.truth_label.empty() ? "given" : recording.truth_label;
}

std::string conversion_json(const DoneExport& done) {
  const recording::Recording& recording = done.recording;
  const nlohmann::ordered_json document{{"recording", recording.name},
                                        {"recording_fingerprint", recording.fingerprint},
                                        {"from", recording.format},
                                        {"out", done.summary.out.string()},
                                        {"frames", done.summary.frames},
                                        {"width_px", recording.rig.camera.width_px},
                                        {"height_px", recording.rig.camera.height_px},
                                        {"imu_samples", recording.imu.size()},
                                        {"ground_truth", truth_of(recording)},
                                        {"poses", recording.ground_truth.size()},
                                        {"depth_pixels", done.summary.depth.measured},
                                        {"depth_pixels_lost", done.summary.depth.beyond_range},
                                        {"notes", recording.notes},
                                        {"warnings", recording.warnings}};
  return text::json_text(document) + "\n";
}

std::string conversion_text(const DoneExport& done) {
  const recording::Recording& recording = done.recording;
  const PinholeCamera& camera = recording.rig.camera;
  std::string text = fmt::format("{}\n", done.summary.out.string());
  auto out = std::back_inserter(text);
  fmt::format_to(out, "  {} frames of {}x{} pixels from '{}' ({})\n", done.summary.frames, camera.width_px,
                 camera.height_px, recording.name, recording.format);
  fmt::format_to(out, "  imu.csv: {}\n",
                 recording.imu.empty() ? "not written, there are no inertial samples that can be used"
                                       : fmt::format("{} samples", recording.imu.size()));
  fmt::format_to(out, "  groundtruth.txt: {}\n",
                 recording.ground_truth.empty()
                     ? "not written, the recording has none"
                     : fmt::format("{} poses ({})", recording.ground_truth.size(), truth_of(recording)));
  if (done.summary.depth.beyond_range > 0)
    fmt::format_to(out, "  depth: {} of {} measurements beyond {:.1f} m are left out\n",
                   done.summary.depth.beyond_range, done.summary.depth.measured,
                   done.summary.depth_storage.farthest_m());
  for (const std::string& note : recording.notes) {
    if (!note.starts_with("ground truth: pseudo")) fmt::format_to(out, "  {}\n", note);  // printed above
  }
  fmt::format_to(out, "  next: fusebench inspect {}\n", done.summary.out.string());
  return text;
}

Result<int> convert(const ConvertVerbOptions& options) {
  const auto done = export_as_requested(options.request);
  if (!done) return tl::unexpected(done.error());
  console::print_output(options.json ? conversion_json(*done) : conversion_text(*done));
  return 0;
}

}  // namespace

console::Verb add_convert_verb(CLI::App& app) {
  auto options = std::make_shared<ConvertVerbOptions>();
  CLI::App* verb = app.add_subcommand("convert",
                                      "Writes a recording of any format as a TUM folder with "
                                      "calibration.toml and imu.csv (docs/datasets.md)");
  add_export_request(*verb, options->request, "Folder to write; must not exist");
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "Reads what `run` reads: TUM, Bonn, OpenLORIS, ICL-NUIM, ETH3D, ZR300, 7-Scenes, EuRoC with depth, "
      ".sens (ScanNet,\nBundleFusion), Stray Scanner, Record3D, Azure Kinect and RealSense by Open3D's "
      "recorders, ROS 1 bags.\nColour is undistorted and depth registered to it; fusebench reads the folder "
      "back as the same recording.\n`export --format tum` writes the same folder, and prints how to run "
      "ORB-SLAM3 on it.");
  return {verb, [options] { return convert(*options); }};
}

}  // namespace fusebench::cli::recordings
