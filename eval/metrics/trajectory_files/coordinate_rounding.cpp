#include "eval/metrics/trajectory_files/coordinate_rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fusebench::trajectory_files {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// A whole number but for the rounding of value = coordinate * 10^d.
bool is_whole(double value) {
  return std::abs(value - std::nearbyint(value)) <= 2 * kEpsilon * std::abs(value);
}

/// 10^d of the fewest decimals d with which all coordinates can be written.
double last_decimal(std::span<const Vector3d> positions) {
  double power = 1e3;
  constexpr double kMostPower = 1e17;
  for (const Vector3d& position : positions) {
    for (const double coordinate : position) {
      while (power < kMostPower && !is_whole(coordinate * power)) power *= 10;
    }
  }
  return power;
}

}  // namespace

double coordinate_rounding(std::span<const Vector3d> positions) {
  constexpr double kOperations = 16;
  double largest = 0;
  for (const Vector3d& position : positions) largest = std::max(largest, position.cwiseAbs().maxCoeff());
  return std::max(0.5 / last_decimal(positions), kOperations * kEpsilon * largest);
}

}  // namespace fusebench::trajectory_files
