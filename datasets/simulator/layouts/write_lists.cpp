#include "datasets/simulator/layouts/write_lists.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/base/io/whole_file.hpp"
#include "core/estimator/filter/stamped_state.hpp"
#include "datasets/recording/exports/sensor_tables.hpp"

namespace fusebench::simulator::layouts {

Result<void> write_text(const std::filesystem::path& file, std::string_view text) {
  const std::error_code error = io::write_whole_file(file, text);
  if (!error) return {};
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", file.string(), error.message()));
}

Result<void> write_imu_csv(const std::filesystem::path& file, const std::vector<ImuSample>& samples) {
  return write_text(file, exports::imu_table(samples));
}

Result<void> write_states(const std::filesystem::path& file, const std::vector<sensors::ImuState>& states,
                          const SE3& T_file_scene) {
  std::vector<filter::StampedState> in_file;
  in_file.reserve(states.size());
  for (const sensors::ImuState& state : states) {
    filter::StampedState& stamped = in_file.emplace_back();
    stamped.timestamp_ns = state.timestamp_ns;
    stamped.state.T_world_imu = T_file_scene * state.motion.T_world_body;
    stamped.state.velocity_world_mps = T_file_scene.rotation * state.motion.velocity_world_mps;
    stamped.state.gyroscope_bias_radps = state.bias.gyroscope_radps;
    stamped.state.accelerometer_bias_mps2 = state.bias.accelerometer_mps2;
  }
  return write_text(file, exports::state_table(in_file));
}

}  // namespace fusebench::simulator::layouts
