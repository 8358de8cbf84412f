// Pictures of what a recording shows: its first frame, the frames with the largest errors, and some in
// between.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/page/page.hpp"
#include "eval/report/patch_pictures.hpp"
#include "eval/report/run_charts/run_series.hpp"

namespace fusebench::report {

/// Colour images of frames of a recording as runs saw it, in the order asked for. Errors: those of opening
/// it; data_missing if it is not there, or has another content than when it was run.
using FrameReader = std::function<Result<std::vector<ColorImage>>(const record::RecordedRecording& recording,
                                                                  std::span<const std::size_t> frames)>;

/// in_between: how many frames for the time line. Where the recording cannot be read, the images that runs
/// kept with their patches, and a sentence that says why and what to do, also in `warnings`.
[[nodiscard]] std::vector<page::PageSection> frame_pictures(const record::RecordedRecording& recording,
                                                            std::span<const run_charts::RunSeries> runs,
                                                            std::span<const LabelledPatches> patches,
                                                            std::size_t in_between, const FrameReader& reader,
                                                            std::vector<std::string>& warnings);

}  // namespace fusebench::report
