// A pose near the identity, by seeded noise: where replicates of a run begin.
#pragma once

#include <cstdint>

#include "core/base/geometry.hpp"

namespace fusebench::trajectory {

/// Exp of a tangent whose six components (rotation vector in rad, then position in m) are normal with
/// standard deviation `sigma`; the same for the same seed.
[[nodiscard]] SE3 noisy_pose(std::uint64_t seed, double sigma);

}  // namespace fusebench::trajectory
