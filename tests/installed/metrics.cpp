// A program that uses the metrics alone: the ATE of a trajectory whose every other position is 2 cm off along
// z.
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "eval/metrics/trajectory_error/ate_rpe.hpp"

int main() {
  fusebench::Trajectory truth;
  fusebench::Trajectory estimate;
  const fusebench::SE3 T_estimate_truth{fusebench::so3_exp({0.3, -0.2, 0.1}), {1, 2, 3}};
  for (int i = 0; i < 400; ++i) {
    const std::int64_t stamp_ns = 1000000000 + i * INT64_C(33333333);
    fusebench::SE3 pose;
    pose.translation = {std::cos(0.02 * i), std::sin(0.02 * i), 0.0};
    truth.push_back({stamp_ns, pose});
    pose.translation.z() = i % 2 == 0 ? 0.01 : -0.01;
    estimate.push_back({stamp_ns, T_estimate_truth * pose});
  }
  const auto ate = fusebench::trajectory_error::absolute_trajectory_error(truth, estimate);
  if (!ate) {
    std::fprintf(stderr, "%s\n", ate.error().message.c_str());
    return 1;
  }
  std::printf("pairs %zu ate_mm %.1f\n", ate->pairs, 1e3 * ate->stats.rmse);
  return 0;
}
