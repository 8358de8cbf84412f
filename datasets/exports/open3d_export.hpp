// The input of Open3D's reconstruction system (Choi et al., CVPR 2015; run_system.py).
#pragma once

#include "core/base/error.hpp"
#include "datasets/exports/export_place.hpp"
#include "datasets/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

inline constexpr DepthStorage kOpen3dDepth{1000, 65535};

/// color/%06d.png (8-bit RGB) and depth/%06d.png (16-bit, mm) from 0: the program pairs them by the order of
/// their names. intrinsic.json (K column by column), config.json (depth_scale; paths relative to the folder,
/// in which the program is to be started), frame_times.txt. Errors: those of the recording, io.
[[nodiscard]] Result<WrittenExport> write_open3d(const recording::Recording& recording,
                                                 const ExportPlace& place);

}  // namespace fusebench::exports
