// AIE, the average intensity error of tracked patches, in grey levels (0-255).
//
// Definition. In frame k every tracked patch has pixels p of frame a, from which it was cut, that are still
// visible in frame k. Each has the difference |I_k(warp(p)) - I_a(p)| at the final pose: bilinear, 8-bit
// grey, before robust weighting, without brightness correction, whether or not the patch passed the error
// gate. The AIE of a frame is the mean over all these pixels of all its tracked patches (each pixel counts
// once per patch); the AIE of a run is the mean over its frames. Frames without tracked pixels are left out
// and counted.
//
// A method can lower its AIE by dropping difficult pixels, so two more numbers are next to it: the same over
// the patches that passed the gate (`accepted`), and the AIE on the pixels that all compared runs have in
// common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/base/intensity_residual.hpp"
#include "eval/metrics/statistics.hpp"

namespace fusebench::metrics {

/// One mean over frames and what went into it.
struct IntensitySummary {
  double aie_grey =
      std::numeric_limits<double>::quiet_NaN();  ///< mean over frames of the frame's mean difference
  double rms_grey =
      std::numeric_limits<double>::quiet_NaN();  ///< sqrt of the mean over frames of the mean square
  std::size_t pixels = 0;
  std::size_t frames = 0;
  std::size_t frames_excluded = 0;  ///< without a pixel
  Statistics stats;                 ///< of the frames' means; stats.mean is aie_grey
};

struct IntensityResult {
  IntensitySummary all;       ///< every visible pixel of tracked patches
  IntensitySummary accepted;  ///< of the patches that passed the gate
};

/// Adds up frames one at a time; memory grows by a few numbers a frame, not with the pixels.
class IntensityAccumulator {
 public:
  void add_frame(std::span<const IntensityResidual> pixels);
  [[nodiscard]] IntensityResult result() const;

 private:
  struct Sums {
    std::vector<double> frame_mean;
    std::vector<double> frame_mean_square;
    std::size_t pixels = 0;
    std::size_t frames_excluded = 0;
  };
  static void add(Sums& sums, double sum, double squares, std::size_t count);
  static IntensitySummary summary(const Sums& sums);

  Sums all_;
  Sums accepted_;
};

/// AIE of one frame (all visible pixels of tracked patches); NaN if it has none.
[[nodiscard]] double frame_intensity_error(std::span<const IntensityResidual> pixels);

/// The AIE of several runs of one recording on the pixels that they share.
///
/// In each frame the runs' pixels are intersected by their pixel of the frame (the first occurrence in
/// a run counts, where its patches overlap). Frames in which nothing is shared are left out and counted.
class CommonIntensityAccumulator {
 public:
  explicit CommonIntensityAccumulator(std::size_t runs) : sums_(runs) {}

  /// One entry per run, of the same frame.
  void add_frame(std::span<const std::vector<IntensityResidual>> runs);
  /// One entry per run; pixels, frames and frames_excluded are the same for all.
  [[nodiscard]] std::vector<IntensitySummary> result() const;

 private:
  std::vector<IntensityAccumulator> sums_;
};

}  // namespace fusebench::metrics
