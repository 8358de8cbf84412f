// What a user may say about a simulated recording, on the command line or in a suite, and the simulator's
// options that it means.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/simulator/simulation.hpp"

namespace fusebench::suites {

struct SimulationRequest {
  simulator::layouts::RecordingLayout layout = simulator::layouts::RecordingLayout::zr300;
  simulator::motion::MotionPreset preset = simulator::motion::MotionPreset::slow;
  std::uint64_t seed = 1;
  std::optional<double> duration_s;  ///< default: motion::usual_duration_s() of a preset, 10 of a trajectory
  double rate_hz = 30;
  images::ImageSize size{640, 480};
  std::optional<bool> from_rest;     ///< default: a preset starts from rest, a trajectory as it begins
  std::filesystem::path trajectory;  ///< instead of the preset; empty: none
  double speed = 1;                  ///< of the trajectory
  double skip_s = 0;                 ///< of the trajectory, at its beginning
  bool realistic = false;            ///< realistic sensors, whatever the motion
  std::filesystem::path scene;       ///< instead of the furnished room; empty: none
  simulator::scene::SceneFileOptions scene_options;
  std::optional<double> exposure_s;  ///< instead of automatic exposure, or of 8 ms
  int blur_samples = 0;              ///< 0: as many as the motion needs
  double rolling_shutter_s = 0;
  double time_offset_s = 0;
  bool no_noise = false;
  std::vector<std::string> faults;  ///< as parse_fault takes them
  std::string calibration_error;    ///< as parse_calibration_error takes it; empty: none
  double untold_time_offset_s = 0;
};

/// Errors: configuration (the image size), usage (the form of a fault); everything else is checked by
/// simulate().
[[nodiscard]] Result<simulator::SimulationOptions> simulation_options(const SimulationRequest& request);

/// The name of a preset: motion::motion_presets(). Error configuration.
[[nodiscard]] Result<simulator::motion::MotionPreset> parse_motion_preset(std::string_view text);
/// "zr300", "tum", "icl". Error configuration.
[[nodiscard]] Result<simulator::layouts::RecordingLayout> parse_recording_layout(std::string_view text);
/// "640x480". Error usage.
[[nodiscard]] Result<images::ImageSize> parse_image_size(std::string_view text);

}  // namespace fusebench::suites
