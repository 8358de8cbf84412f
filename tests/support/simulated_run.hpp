// A short recording tracked by the whole pipeline, for its tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/config/config.hpp"
#include "core/config/variants.hpp"
#include "core/recording_estimator.hpp"
#include "tests/support/simulated_frames.hpp"

namespace fusebench::testing {

inline config::Config config_of(std::string_view variant) {
  return config::variant_config(*config::find_variant(variant)).values();
}

/// Runs the pipeline over all frames; errors fail the test that calls.
inline std::vector<health::FrameReport> track(const SimulatedRun& run, const config::Config& config,
                                              int threads = 1) {
  const Workers workers(threads);
  core::RecordingEstimator pipeline(config, run.rig, run.imu, workers);
  std::vector<health::FrameReport> reports;
  for (const RgbdFrame& frame : run.frames) {
    auto report = pipeline.process(frame);
    EXPECT_TRUE(report.has_value()) << (report ? "" : report.error().message);
    if (!report) break;
    reports.push_back(std::move(*report));
  }
  return reports;
}

/// Largest distance of an estimated camera from the truth, metres.
inline double worst_error_m(const SimulatedRun& run, const std::vector<health::FrameReport>& reports) {
  double worst = 0;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    worst =
        std::max(worst, (reports[k].T_world_camera.translation - run.T_first_camera[k].translation).norm());
  }
  return worst;
}

}  // namespace fusebench::testing
