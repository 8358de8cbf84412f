// An inspection as a page with plots.
#pragma once

#include <string>

#include "datasets/inspection/inspection.hpp"
#include "datasets/recording.hpp"

namespace fusebench {

/// Findings, speeds as in the paper's figure of camera velocities, depth, exposure, IMU, stamps, residuals
/// and some frames (evenly spread ones and the worst), as one HTML file. Loads the frames that it shows; one
/// that cannot be loaded is left out.
[[nodiscard]] std::string to_page(const Inspection& inspection, const Recording& recording);

}  // namespace fusebench
