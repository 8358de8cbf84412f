// .klg logs for ElasticFusion and Kintinuous.
#pragma once

#include <cstddef>

#include "core/base/error.hpp"
#include "datasets/exports/export_place.hpp"
#include "datasets/exports/export_summary.hpp"
#include "datasets/image_logs/klg_log.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

inline constexpr DepthStorage kKlgDepth{1000, 65535};
/// ElasticFusion numbers frames with 16 bits.
inline constexpr std::size_t kKlgMostFrames = 65535;

/// NAME.klg and NAME.calibration.txt (one line, "fx fy cx cy" in pixels). Depth is packed, colour plain, so
/// that both come back as they are. The last frame is written twice: the reader stops one frame early.
/// Errors: those of the recording, io, usage (images of another size).
[[nodiscard]] Result<WrittenExport> write_klg(const recording::Recording& recording,
                                              const ExportPlace& place);

}  // namespace fusebench::exports
