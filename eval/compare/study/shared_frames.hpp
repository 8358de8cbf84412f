// Two finished runs of one recording, frame by frame on the pixels that they share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::study {

/// A frame in which both runs have a pixel in common.
struct SharedFrame {
  std::int64_t timestamp_ns = 0;
  std::size_t pixels = 0;     ///< that are shared
  double reference_grey = 0;  ///< these two: mean difference over them
  double variant_grey = 0;
  std::optional<double> motion_px =
      {};  ///< how far patches moved since the frame before, as the reference saw it
};

/// From two files of intensity differences (eval/metrics/intensity_file.hpp), with the definition of common
/// pixels of CommonIntensityAccumulator. Frames in which nothing is shared are left out. Errors: those of
/// IntensityReader; data_corrupt if the files are not of the same frames.
[[nodiscard]] Result<std::vector<SharedFrame>> shared_frames(const std::filesystem::path& reference,
                                                             const std::filesystem::path& variant);

/// The column patch_motion_px of a run's frames.csv by stamp; frames without a number are left out. Errors:
/// data_missing; data_corrupt with file:line (no such column, a number that is none).
[[nodiscard]] Result<std::map<std::int64_t, double>> read_patch_motion(
    const std::filesystem::path& frames_csv);

/// One number over frames, each frame counting the same, as the AIE of a run does.
struct SharedMeans {
  std::size_t frames = 0;
  std::size_t pixels = 0;
  double reference_grey = 0;  ///< these two: 0 if there is no frame
  double variant_grey = 0;
};
[[nodiscard]] SharedMeans shared_means(std::span<const SharedFrame> frames);

}  // namespace fusebench::study
