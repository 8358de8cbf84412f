#include "core/base/trajectory/noisy_pose.hpp"

#include <random>

namespace fusebench::trajectory {

SE3 noisy_pose(std::uint64_t seed, double sigma) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Vector6d tangent;
  for (double& component : tangent) component = sigma * normal(random);
  return pose_plus(SE3{}, tangent);
}

}  // namespace fusebench::trajectory
