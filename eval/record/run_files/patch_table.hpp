// patches.csv and its images: the pixels of all tracked patches in the frames in which they moved most.
//
// Columns: frame, timestamp, motion_px (median of the frame's patches), patch (its number in the frame),
// accepted (by the gate), u and v (the pixel's place in the frame before), x and y (where it was found in
// this one, pixels), reference_grey and observed_grey (grey levels there and here). Beside it,
// patches_FRAME.png is the grey image of each of these frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/image.hpp"
#include "core/estimator/health/frame_report.hpp"

namespace fusebench::run_files {

struct PatchTablePixel {
  std::uint32_t patch = 0;
  bool accepted = false;
  Eigen::Vector2i reference_px = Eigen::Vector2i::Zero();
  Eigen::Vector2f warped_px = Eigen::Vector2f::Zero();
  float reference_grey = 0;
  float observed_grey = 0;
};

struct PatchTableFrame {
  std::size_t frame = 0;
  std::int64_t timestamp_ns = 0;
  double motion_px = 0;
  std::vector<PatchTablePixel> pixels;  ///< by patch
  GreyImage grey;
};

/// Keeps the frames in which the patches moved most while a run goes on.
class FastestFrames {
 public:
  void offer(std::size_t frame, const health::FrameReport& report, const GreyImage& grey);

  /// By frame.
  [[nodiscard]] const std::vector<PatchTableFrame>& frames() const { return frames_; }

 private:
  std::vector<PatchTableFrame> frames_;
};

/// Writes patches.csv and the images into a folder; nothing of no frames. Error io.
[[nodiscard]] Result<void> write_patch_table(const std::filesystem::path& folder,
                                             const std::vector<PatchTableFrame>& frames);

/// Nothing if the folder has no patches.csv. Errors: data_missing (an image), data_corrupt (with the line).
[[nodiscard]] Result<std::vector<PatchTableFrame>> read_patch_table(const std::filesystem::path& folder);

}  // namespace fusebench::run_files
