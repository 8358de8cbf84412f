#include "datasets/simulator/layouts/write_lists.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace fusebench::simulator::layouts {

Result<void> write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) return fail(ErrorCode::io, fmt::format("{}: cannot be written", file.string()));
  return {};
}

Result<void> write_imu_csv(const std::filesystem::path& file, const std::vector<ImuSample>& samples) {
  std::string text =
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
      "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
  for (const ImuSample& sample : samples) {
    const Vector3d& w = sample.angular_velocity_radps;
    const Vector3d& a = sample.specific_force_mps2;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{}\n", sample.timestamp_ns, w.x(), w.y(),
                   w.z(), a.x(), a.y(), a.z());
  }
  return write_text(file, text);
}

Result<void> write_states(const std::filesystem::path& file, const std::vector<sensors::ImuState>& states,
                          const SE3& T_file_scene) {
  std::string text =
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],"
      "v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],"
      "b_w_RS_S_z [rad s^-1],b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n";
  for (const sensors::ImuState& state : states) {
    const SE3 T = T_file_scene * state.motion.T_world_body;
    const Vector3d& p = T.translation;
    const Quaterniond& q = T.rotation;
    const Vector3d v = T_file_scene.rotation * state.motion.velocity_world_mps;
    const Vector3d& w = state.bias.gyroscope_radps;
    const Vector3d& a = state.bias.accelerometer_mps2;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                   state.timestamp_ns, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(),
                   w.x(), w.y(), w.z(), a.x(), a.y(), a.z());
  }
  return write_text(file, text);
}

}  // namespace fusebench::simulator::layouts
