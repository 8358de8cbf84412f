// Gated depth as a value.
#pragma once

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::testing {

[[nodiscard]] inline DepthImage gated_depth(const DepthImage& depth_m, const config::DepthConfig& config) {
  DepthImage gated_m;
  preprocessing::gate_depth(depth_m, config, gated_m);
  return gated_m;
}

}  // namespace fusebench::testing
