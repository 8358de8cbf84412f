// An inspection as a page with plots.
#pragma once

#include <string>

#include "datasets/inspection/inspection.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::inspection_report {

/// Findings, speeds as in the paper's figure of camera velocities, depth, exposure, IMU, stamps, residuals
/// and some frames (evenly spread ones and the worst), as one HTML file. Loads the frames that it shows; one
/// that cannot be loaded is left out.
[[nodiscard]] std::string to_page(const inspection::Inspection& inspection,
                                  const recording::Recording& recording);

}  // namespace fusebench::inspection_report
