// Patches before and after deformation, as pictures.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/image.hpp"
#include "eval/record/run_files/patch_table.hpp"

namespace fusebench::report {

/// The patches of one run.
struct LabelledPatches {
  std::string label;
  std::vector<run_files::PatchTableFrame> frames;
};

/// One patch as one run has it.
struct PatchPicture {
  std::string run;  ///< its label
  Eigen::Vector2i corner_px = Eigen::Vector2i::Zero();
  double difference_grey = 0;
  bool accepted = false;
  ColorImage strip;  ///< four squares side by side

  [[nodiscard]] std::string caption() const;
};

struct PatchPictures {
  std::string text;  ///< which frame, and the mean error of the patches that all runs track in it
  std::int64_t timestamp_ns = 0;       ///< of that frame
  std::vector<PatchPicture> pictures;  ///< by patch, then run
};

/// Of the frame that all runs kept and in which the patches moved most, a few patches that all of them track,
/// spread over the image. From left to right: the patch in the frame before; the same grey levels where they
/// are expected in this frame; what the image has there; the absolute difference. Nothing if they have no
/// frame or patch in common.
[[nodiscard]] PatchPictures patch_pictures(std::span<const LabelledPatches> runs);

}  // namespace fusebench::report
