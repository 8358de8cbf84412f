#include "datasets/state_truth.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/stamped_rows.hpp"

namespace fusebench {

namespace {

constexpr double kMostOffUnit = 0.01;

}  // namespace

Result<std::vector<StampedState>> read_state_truth(const std::filesystem::path& file) {
  std::vector<StampedState> states;
  const auto row = [&](const TextTable& table, std::int64_t time_ns) -> Result<void> {
    std::array<double, 16> v{};
    if (auto read = table.numbers(1, v); !read) return read;
    const Quaterniond rotation(v[3], v[4], v[5], v[6]);
    if (!(std::abs(rotation.norm() - 1) <= kMostOffUnit)) {
      return table.fail_here(
          fmt::format("the quaternion has length {} (allowed 1 within {})", rotation.norm(), kMostOffUnit));
    }
    StampedState state;
    state.timestamp_ns = time_ns;
    state.state.T_world_imu = {rotation.normalized(), {v[0], v[1], v[2]}};
    state.state.velocity_world_mps = {v[7], v[8], v[9]};
    state.state.gyroscope_bias_radps = {v[10], v[11], v[12]};
    state.state.accelerometer_bias_mps2 = {v[13], v[14], v[15]};
    states.push_back(state);
    return {};
  };
  const Result<void> done =
      for_each_stamped_row(file, "timestamp px py pz qw qx qy qz vx vy vz bwx bwy bwz bax bay baz",
                           TimeOrder::increasing, row, TimeUnit::nanoseconds);
  if (!done) return tl::unexpected(done.error());
  return states;
}

}  // namespace fusebench
