#include "eval/suites/simulation_request.hpp"

#include <fmt/format.h>

#include <charconv>

namespace fusebench::suites {

Result<simulator::SimulationOptions> simulation_options(const SimulationRequest& request) {
  auto options = simulator::simulation_defaults(request.layout, request.preset, request.size);
  if (!options) return options;
  options->seed = request.seed;
  options->duration_s = request.duration_s;
  options->rate_hz = request.rate_hz;
  options->scene_file = request.scene;
  options->scene = request.scene_options;
  options->motion.from_rest = request.from_rest.value_or(true);
  options->trajectory_file = request.trajectory;
  options->file_motion.speed = request.speed;
  options->file_motion.from_rest = request.from_rest.value_or(false);
  // In a scene of the user's own, the poses say where the camera is; in the furnished room they cannot.
  options->file_motion.in_place = !request.scene.empty();
  options->exposure_s = request.exposure_s;
  options->blur_samples = request.blur_samples;
  options->rig.color.timing.color_readout_s = request.rolling_shutter_s;
  options->imu.time_offset_s = request.time_offset_s;
  if (request.no_noise) simulator::remove_noise(*options);
  for (const std::string& text : request.faults) {
    const auto fault = simulator::faults::parse_fault(text);
    if (!fault) return tl::unexpected(fault.error());
    options->faults.push_back(*fault);
  }
  if (!request.calibration_error.empty()) {
    const auto error = simulator::faults::parse_calibration_error(request.calibration_error);
    if (!error) return tl::unexpected(error.error());
    options->calibration_error = *error;
  }
  options->untold_time_offset_s = request.untold_time_offset_s;
  return options;
}

Result<simulator::motion::MotionPreset> parse_motion_preset(std::string_view text) {
  for (const simulator::motion::MotionPreset preset :
       {simulator::motion::MotionPreset::slow, simulator::motion::MotionPreset::fast,
        simulator::motion::MotionPreset::shake, simulator::motion::MotionPreset::sweep}) {
    if (text == simulator::motion::to_string(preset)) return preset;
  }
  return fail(ErrorCode::configuration,
              fmt::format("preset = {} (allowed: slow | fast | shake | sweep)", text));
}

Result<simulator::layouts::RecordingLayout> parse_recording_layout(std::string_view text) {
  for (const simulator::layouts::RecordingLayout layout :
       {simulator::layouts::RecordingLayout::zr300, simulator::layouts::RecordingLayout::tum,
        simulator::layouts::RecordingLayout::icl}) {
    if (text == simulator::layouts::to_string(layout)) return layout;
  }
  return fail(ErrorCode::configuration, fmt::format("format = {} (allowed: zr300 | tum | icl)", text));
}

Result<images::ImageSize> parse_image_size(std::string_view text) {
  images::ImageSize size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width_px);
  const bool cross = width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x';
  const auto height = cross ? std::from_chars(width.ptr + 1, end, size.height_px) : width;
  if (!cross || height.ec != std::errc{} || height.ptr != end) {
    return fail(ErrorCode::usage, fmt::format("size {} (allowed: WIDTHxHEIGHT)", text), "e.g. 640x480");
  }
  return size;
}

}  // namespace fusebench::suites
