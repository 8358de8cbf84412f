// EuRoC MAV's layout (Burri et al., IJRR 2016), which visual-inertial systems read.
#pragma once

#include "core/base/error.hpp"
#include "datasets/exports/export_place.hpp"
#include "datasets/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

inline constexpr DepthStorage kEurocDepth{1000, 65535};

/// mav0/cam0/data/STAMP.png (8-bit grey, STAMP in nanoseconds) and data.csv ("timestamp [ns],filename");
/// mav0/depth0 of the same names (16-bit mm; no part of EuRoC); mav0/imu0/data.csv (rad/s, m/s^2);
/// mav0/state_groundtruth_estimate0/data.csv of the IMU (without one: of the camera), all 17 columns where
/// the recording has true states and the first eight where it has poses; sensor.yaml of each sensor (T_BS:
/// sensor to body, and the IMU is the body); times.txt (a stamp a line) and orbslam3.yaml. Errors: those of
/// the recording, io.
[[nodiscard]] Result<WrittenExport> write_euroc(const recording::Recording& recording,
                                                const ExportPlace& place);

}  // namespace fusebench::exports
