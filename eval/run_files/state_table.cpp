#include "eval/run_files/state_table.hpp"

#include <fmt/format.h>

#include <iterator>

#include "core/filter/sensor_constants.hpp"
#include "core/trajectory/trajectory_file.hpp"

namespace fusebench::run_files {

namespace {

constexpr int kWritten = filter::kGravity;  ///< rotation to accelerometer bias lead the error state

}  // namespace

std::string state_table_header() {
  std::string header =
      "capture_timestamp,status,px_m,py_m,pz_m,qw,qx,qy,qz,vx_mps,vy_mps,vz_mps,bgx_radps,bgy_radps,"
      "bgz_radps,bax_mps2,bay_mps2,baz_mps2,gx,gy,gz";
  for (int i = 0; i < kWritten; ++i) {
    for (int j = i; j < kWritten; ++j) header += fmt::format(",P_{}_{}", i, j);
  }
  for (const filter::SensorConstant& constant : filter::sensor_constants({}, {}))
    header += fmt::format(",{0},sigma_{0}", constant.name);
  return header + "\n";
}

std::string state_table_row(const health::FrameReport& report, const SensorTiming& timing) {
  const filter::FilterState& mean = report.estimate.mean;
  const Quaterniond& q = mean.T_world_imu.rotation;
  std::string row =
      fmt::format("{},{}", trajectory::stamp_text(report.capture_ns), health::to_string(report.status));
  const auto add = [&](const Vector3d& v) {
    fmt::format_to(std::back_inserter(row), ",{},{},{}", v.x(), v.y(), v.z());
  };
  add(mean.T_world_imu.translation);
  fmt::format_to(std::back_inserter(row), ",{},{},{},{}", q.w(), q.x(), q.y(), q.z());
  add(mean.velocity_world_mps);
  add(mean.gyroscope_bias_radps);
  add(mean.accelerometer_bias_mps2);
  add(mean.gravity_direction_world);
  for (int i = 0; i < kWritten; ++i) {
    for (int j = i; j < kWritten; ++j) {
      // Nine digits: enough for any use of a covariance, and half the file.
      fmt::format_to(std::back_inserter(row), ",{:.9g}", report.estimate.covariance(i, j));
    }
  }
  for (const filter::SensorConstant& constant : filter::sensor_constants(report.estimate, timing))
    fmt::format_to(std::back_inserter(row), ",{:.9g},{:.9g}", constant.value, constant.sigma);
  return row + "\n";
}

}  // namespace fusebench::run_files
