// Inertial samples that contradict their calibration or the images, before a run uses them.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/parallel.hpp"
#include "datasets/inspection/finding.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::preparation {

/// The errors and warnings of `fusebench inspect` about the IMU. They are kept among the results, as
/// <out>/prepared/<recording>-<16 digits>.imu.txt, and looked for once.
[[nodiscard]] std::vector<inspection::Finding> imu_findings(const recording::Recording& recording,
                                                            const std::filesystem::path& out,
                                                            const Workers& workers);

/// Whether no result of such samples means anything: another unit, gravity that is missing, axes that are
/// exchanged, or the IMU of another recording.
[[nodiscard]] bool makes_results_invalid(const inspection::Finding& finding);

}  // namespace fusebench::preparation
