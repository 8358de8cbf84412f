#include "datasets/recording/state_truth.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/base/io/stamped_rows.hpp"
#include "datasets/recording/sensor_columns.hpp"

namespace fusebench::recording {

namespace {

constexpr double kMaxOffUnit = 0.01;

}  // namespace

Result<std::vector<filter::StampedState>> read_state_truth(const std::filesystem::path& file) {
  std::vector<filter::StampedState> states;
  const auto row = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto position_m = read_position(table, 1, "p");
    if (!position_m) return tl::unexpected(position_m.error());
    std::array<double, 4> q{};
    if (auto read = table.numbers(4, q); !read) return read;
    const auto velocity_mps = read_velocity(table, 8, "v");
    if (!velocity_mps) return tl::unexpected(velocity_mps.error());
    const auto gyroscope_bias_radps = read_angular_velocity(table, 11, "bw");
    if (!gyroscope_bias_radps) return tl::unexpected(gyroscope_bias_radps.error());
    const auto accelerometer_bias_mps2 = read_specific_force(table, 14, "ba");
    if (!accelerometer_bias_mps2) return tl::unexpected(accelerometer_bias_mps2.error());
    const Quaterniond rotation(q[0], q[1], q[2], q[3]);
    if (!(std::abs(rotation.norm() - 1) <= kMaxOffUnit)) {
      return table.fail_here(
          fmt::format("the quaternion has length {} (allowed 1 within {})", rotation.norm(), kMaxOffUnit));
    }
    filter::StampedState state;
    state.timestamp_ns = time_ns;
    state.state.T_world_imu = {rotation.normalized(), *position_m};
    state.state.velocity_world_mps = *velocity_mps;
    state.state.gyroscope_bias_radps = *gyroscope_bias_radps;
    state.state.accelerometer_bias_mps2 = *accelerometer_bias_mps2;
    states.push_back(state);
    return {};
  };
  const Result<void> done =
      io::for_each_stamped_row(file, "timestamp px py pz qw qx qy qz vx vy vz bwx bwy bwz bax bay baz",
                               io::TimeOrder::increasing, row, io::TimeUnit::nanoseconds);
  if (!done) return tl::unexpected(done.error());
  return states;
}

}  // namespace fusebench::recording
