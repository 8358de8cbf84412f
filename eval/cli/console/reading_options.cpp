#include "eval/cli/console/reading_options.hpp"

#include <CLI/CLI.hpp>

#include "datasets/calibration/camera_presets.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::cli::console {

void add_reading_options(CLI::App& verb, ReadingOptions& options, const std::string& format_flag) {
  verb.add_option("--calibration", options.calibration,
                  "Calibration of all sensors (docs/datasets.md), in place of the recording's own")
      ->type_name("FILE.toml");
  verb.add_option("--camera", options.camera,
                  "Calibration of the colour camera: a preset's name, or fx,fy,cx,cy[,k1,k2,p1,p2,k3]")
      ->type_name("CAMERA");
  verb.add_option(format_flag, options.format, "Format of the recording; recognised if not given")
      ->type_name("NAME");
  verb.add_option("--depth-units", options.depth_units_per_metre,
                  "Value of one metre in the depth images; default: the calibration's, or the format's")
      ->type_name("N");
  verb.add_option(
          "--max-difference", options.max_difference_s,
          "Largest difference between a colour image and its depth image, where they are paired by time")
      ->type_name("S")
      ->capture_default_str();
  verb.add_option("--frame-rate", options.frame_rate_hz,
                  "Images a second of recordings without stamps (icl, 7scenes, open3d, ...); default: the "
                  "recording's value, else 30")
      ->type_name("HZ");
  verb.add_flag("--published-stamps", options.published_stamps,
                "Images were taken at their stamps: no jitter is removed");
  verb.add_flag("--filtered-depth", options.filtered_depth,
                "Depth that the recording's authors have filtered (zr300: folder filtered/)");
}

Result<datasets::OpenOptions> open_options(const ReadingOptions& options) {
  datasets::OpenOptions open;
  open.format = options.format;
  if (!options.calibration.empty()) {
    auto calibration = calibration::read_calibration(options.calibration);
    if (!calibration) return tl::unexpected(calibration.error());
    open.read.calibration = std::move(*calibration);
  }
  if (!options.camera.empty()) {
    const auto camera = calibration::parse_camera(options.camera);
    if (!camera) return tl::unexpected(camera.error());
    open.read.camera = *camera;
  }
  open.read.depth_units_per_metre = options.depth_units_per_metre;
  open.read.max_difference_s = options.max_difference_s;
  open.read.frame_rate_hz = options.frame_rate_hz;
  open.read.regular_stamps = !options.published_stamps;
  open.read.filtered_depth = options.filtered_depth;
  return open;
}

}  // namespace fusebench::cli::console
