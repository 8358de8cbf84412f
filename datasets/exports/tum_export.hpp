// TUM RGB-D's layout (Sturm et al., IROS 2012), which ORB-SLAM2 and 3, supereight2 and this program read.
#pragma once

#include "core/base/error.hpp"
#include "datasets/exports/export_place.hpp"
#include "datasets/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

inline constexpr DepthStorage kTumDepth{5000, 65535};  ///< up to 13.1 m

/// rgb/ and depth/ (PNG: 8-bit RGB; 16-bit, 5000 = 1 m) named by their stamps in seconds with nine decimals;
/// rgb.txt, depth.txt; associations.txt ("t rgb t depth"); groundtruth.txt (T_groundtruth_camera) if the
/// recording has a truth; imu.csv, accelerometer.txt, state_groundtruth.csv (where there is such data) and
/// calibration.toml, with which this program reads all of it back but the scene's mesh;
/// orbslam3.yaml. Errors: those of the recording, io, and data_corrupt (two images of one stamp).
[[nodiscard]] Result<WrittenExport> write_tum(const recording::Recording& recording,
                                              const ExportPlace& place);

}  // namespace fusebench::exports
