// Small pictures of frames, colour and depth side by side.
#pragma once

#include <vector>

#include "datasets/inspection/inspection.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/page/page.hpp"

namespace fusebench::inspection_report {

/// Four frames spread evenly, then those that are worst in sharpness, depth, brightness and predicted blur.
[[nodiscard]] std::vector<page::PageImage> inspection_thumbnails(const inspection::Inspection& inspection,
                                                                 const recording::Recording& recording);

/// Grey images of four frames with the borders of what is nearer in depth: white as read, and red where the
/// depth camera that fits best would have them. None where the registration was not measured.
[[nodiscard]] std::vector<page::PageImage> registration_pictures(const inspection::Inspection& inspection,
                                                                 const recording::Recording& recording);

}  // namespace fusebench::inspection_report
