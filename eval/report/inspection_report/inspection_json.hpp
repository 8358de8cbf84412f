// An inspection as one JSON document.
#pragma once

#include <string>

#include "datasets/inspection/inspection.hpp"

namespace fusebench::inspection_report {

/// {"recording", "format", "fingerprint", "frames", "imu", "findings": [{"code", "severity", "message",
/// "hint"}], and the measurements: "stamps", "association", "exposure", "depth", "motion", "truth",
/// "imu_values", "imu_alignment", "reprojection"}. SI units; what was not measured is null. Ends with a
/// newline.
[[nodiscard]] std::string to_json(const inspection::Inspection& inspection);

}  // namespace fusebench::inspection_report
