// Patches before and after deformation, as pictures.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/run_files/patch_table.hpp"

namespace fusebench::report {

/// The patches of one run.
struct LabelledPatches {
  std::string label;
  std::vector<run_files::PatchTableFrame> frames;
};

struct PatchPictures {
  std::string text;  ///< which frame, and the mean error of the patches that all runs track in it
  std::vector<page::PageImage> images;
};

/// Of the frame that all runs kept and in which the patches moved most, a few patches that all of them track,
/// spread over the image. From left to right: the patch in the frame before; the same grey levels where they
/// are expected in this frame; what the image has there; the absolute difference. Nothing if they have no
/// frame or patch in common.
[[nodiscard]] PatchPictures patch_pictures(std::span<const LabelledPatches> runs);

}  // namespace fusebench::report
