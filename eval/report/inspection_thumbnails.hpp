// Small pictures of frames, colour and depth side by side.
#pragma once

#include <vector>

#include "datasets/inspection/inspection.hpp"
#include "datasets/recording.hpp"
#include "eval/report/page.hpp"

namespace fusebench {

/// Four frames spread evenly, then those that are worst in sharpness, depth, brightness and predicted blur.
[[nodiscard]] std::vector<PageImage> inspection_thumbnails(const Inspection& inspection,
                                                           const Recording& recording);

}  // namespace fusebench
