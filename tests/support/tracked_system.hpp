// A short recording run through any system, for the tests of systems.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/all_systems.hpp"
#include "core/config/config.hpp"
#include "core/config/variants.hpp"
#include "tests/support/simulated_frames.hpp"

namespace fusebench::testing {

struct TrackedSystem {
  std::vector<health::FrameOutcome> outcomes;
  system::Surface surface;
};

inline config::Config config_of_variant(std::string_view name) {
  const auto variant = config::find_variant(name);
  EXPECT_TRUE(variant.has_value()) << name;
  return config::variant_config(*variant).values();
}

/// Errors fail the test that calls.
inline TrackedSystem track_with(const config::Config& config, const SimulatedRun& run, int threads = 1) {
  const Workers workers(threads);
  const auto system = core::make_system(config, run.rig, run.imu, workers);
  TrackedSystem tracked;
  for (const RgbdFrame& frame : run.frames) {
    auto outcome = system->process(frame);
    EXPECT_TRUE(outcome.has_value()) << (outcome ? "" : outcome.error().message);
    if (!outcome) break;
    tracked.outcomes.push_back(std::move(*outcome));
  }
  tracked.surface = system->take_surface();
  return tracked;
}

/// Largest distance of a camera from the truth, metres.
inline double worst_position_error_m(const SimulatedRun& run,
                                     const std::vector<health::FrameOutcome>& outcomes) {
  double worst = 0;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    worst =
        std::max(worst, (outcomes[k].T_world_camera.translation - run.T_first_camera[k].translation).norm());
  }
  return worst;
}

}  // namespace fusebench::testing
