#include "datasets/recording/exports/sensor_tables.hpp"

#include <fmt/format.h>

#include <iterator>

#include "core/base/trajectory/trajectory_file.hpp"

namespace fusebench::exports {

namespace {

void append_pose(std::string& text, std::int64_t timestamp_ns, const SE3& T_world_body) {
  const Vector3d& p = T_world_body.translation;
  const Quaterniond& q = T_world_body.rotation;
  fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}", timestamp_ns, p.x(), p.y(), p.z(),
                 q.w(), q.x(), q.y(), q.z());
}

void append_vector(std::string& text, const Vector3d& v) {
  fmt::format_to(std::back_inserter(text), ",{},{},{}", v.x(), v.y(), v.z());
}

}  // namespace

std::string imu_table(std::span<const ImuSample> samples) {
  std::string text =
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
      "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
  for (const ImuSample& sample : samples) {
    fmt::format_to(std::back_inserter(text), "{}", sample.timestamp_ns);
    append_vector(text, sample.angular_velocity_radps);
    append_vector(text, sample.specific_force_mps2);
    text += '\n';
  }
  return text;
}

std::string state_table(std::span<const filter::StampedState> states) {
  std::string text =
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],"
      "v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],"
      "b_w_RS_S_z [rad s^-1],b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n";
  for (const filter::StampedState& stamped : states) {
    append_pose(text, stamped.timestamp_ns, stamped.state.T_world_imu);
    append_vector(text, stamped.state.velocity_world_mps);
    append_vector(text, stamped.state.gyroscope_bias_radps);
    append_vector(text, stamped.state.accelerometer_bias_mps2);
    text += '\n';
  }
  return text;
}

std::string pose_table(std::span<const StampedPose> T_world_body) {
  std::string text =
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n";
  for (const StampedPose& pose : T_world_body) {
    SE3 T = pose.T_world_camera;
    if (T.rotation.w() < 0) T.rotation.coeffs() *= -1;  // the same rotation; one sign makes files comparable
    append_pose(text, pose.timestamp_ns, T);
    text += '\n';
  }
  return text;
}

std::string frame_time_table(std::span<const recording::FrameEntry> frames) {
  std::string text = "# frame timestamp [s]\n";
  for (std::size_t k = 0; k < frames.size(); ++k)
    fmt::format_to(std::back_inserter(text), "{} {}\n", k, trajectory::stamp_text(frames[k].timestamp_ns));
  return text;
}

double mean_rate_hz(std::int64_t first_ns, std::int64_t last_ns, std::size_t count) {
  constexpr double kUnknown_hz = 30;
  if (count < 2 || last_ns <= first_ns) return kUnknown_hz;
  return static_cast<double>(count - 1) / seconds_between(first_ns, last_ns);
}

double frame_rate_hz(const recording::Recording& recording) {
  const auto& frames = recording.frames;
  return frames.empty()
             ? mean_rate_hz(0, 0, 0)
             : mean_rate_hz(frames.front().timestamp_ns, frames.back().timestamp_ns, frames.size());
}

double imu_rate_hz(const recording::Recording& recording) {
  const auto& imu = recording.imu;
  return imu.empty() ? mean_rate_hz(0, 0, 0)
                     : mean_rate_hz(imu.front().timestamp_ns, imu.back().timestamp_ns, imu.size());
}

}  // namespace fusebench::exports
