#include "eval/suites/simulation_request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include "datasets/simulator/realism.hpp"

namespace fusebench::suites {

Result<simulator::SimulationOptions> simulation_options(const SimulationRequest& request) {
  auto options = simulator::simulation_defaults(request.layout, request.preset, request.size);
  if (!options) return options;
  options->seed = request.seed;
  const bool realistic_motion = request.trajectory.empty() && simulator::is_realistic(request.preset);
  constexpr double kOfTrajectory_s = 10;
  options->duration_s = request.duration_s.value_or(
      request.trajectory.empty() ? simulator::motion::usual_duration_s(request.preset) : kOfTrajectory_s);
  options->rate_hz = request.rate_hz;
  options->scene_file = request.scene;
  options->scene = request.scene_options;
  options->motion.from_rest = request.from_rest.value_or(true);
  options->trajectory_file = request.trajectory;
  options->file_motion.speed = request.speed;
  options->file_motion.skip_s = request.skip_s;
  options->file_motion.from_rest = request.from_rest.value_or(false);
  // In a scene of the user's own, the poses say where the camera is; in the furnished room they cannot.
  options->file_motion.in_place = !request.scene.empty();
  if (request.realistic || realistic_motion) simulator::make_realistic(*options);
  // Given values replace those of --realistic.
  if (request.exposure_s) {
    options->auto_exposure.on = false;
    options->exposure_s = *request.exposure_s;
  }
  options->blur_samples = request.blur_samples;
  if (request.rolling_shutter_s > 0) options->rig.color.timing.color_readout_s = request.rolling_shutter_s;
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
  if (request.untold_time_offset_s != 0) options->untold_time_offset_s = request.untold_time_offset_s;
  return options;
}

Result<simulator::motion::MotionPreset> parse_motion_preset(std::string_view text) {
  using simulator::motion::MotionPreset;
  std::vector<std::string_view> names;
  for (const MotionPreset preset : simulator::motion::motion_presets()) {
    names.push_back(simulator::motion::to_string(preset));
    if (text == names.back()) return preset;
  }
  return fail(ErrorCode::configuration,
              fmt::format("preset = {} (allowed: {})", text, fmt::join(names, " | ")));
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
