// .sens files for BundleFusion and readers of ScanNet.
#pragma once

#include <cstddef>

#include "core/base/error.hpp"
#include "datasets/exports/export_place.hpp"
#include "datasets/exports/export_summary.hpp"
#include "datasets/image_logs/sens_log.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

inline constexpr DepthStorage kSensDepth{1000, 65535};
inline constexpr std::size_t kSensMostFrames = 12000;  ///< BundleFusion refuses more

/// NAME.sens: colour as JPEG of quality 95 (lossy: readers of ScanNet's files take no other), depth as zlib
/// streams of millimetres, stamps in microseconds, both cameras that of the recording, no poses, no IMU
/// frames. Errors: those of the recording, of images::encode_jpeg, io.
[[nodiscard]] Result<WrittenExport> write_sens(const recording::Recording& recording,
                                               const ExportPlace& place);

}  // namespace fusebench::exports
