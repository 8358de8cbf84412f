// Writes the images of a simulated recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "datasets/simulator/faults/scenery.hpp"
#include "datasets/simulator/layouts/layout.hpp"
#include "datasets/simulator/simulation.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator {

/// Motion and capture instants.
struct CaptureSetup {
  synthetic_imu::PoseSpline body;  ///< the IMU body in the scene's world
  SE3 T_body_color;
  std::vector<std::int64_t> frame_ns;  ///< middles of the exposures; depth is later by its delay
  sensors::ImageStamps color{};        ///< names of the images and dropped ones
  sensors::ImageStamps depth{};
};

/// Renders and writes all colour and depth images below the folder, frames in parallel, with the faults of
/// the options. Errors: io; run_failed (stopped). Returns the error of the first failing frame, for any
/// number of threads.
[[nodiscard]] Result<void> write_images(const SimulationOptions& options, const CaptureSetup& setup,
                                        const faults::Scenery& scenery, const std::filesystem::path& folder,
                                        const Workers& workers, const SimulationControl& control);

}  // namespace fusebench::simulator
