// Outcome of the tracking of a patch in a frame: visibility and consistency.
#pragma once

#include <span>

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/patches/patch_lanes.hpp"

namespace fusebench::measurement {

/// Outcome of one patch at the last linearisation.
struct PatchOutcome {
  bool in_view = false;            ///< at least one pixel inside the image
  bool tracked = false;            ///< enough usable pixels at level 0
  bool accepted = false;           ///< tracked, and passed the chi-square gate
  bool contradicts_color = false;  ///< tracked, but its intensities do not fit
  bool shrunk = false;             ///< lost pixels to occlusion
  bool extended = false;
  int usable_pixels = 0;   ///< visible, level 0
  int covered_pixels = 0;  ///< in the image, behind a nearer measured surface
  int photometric_residuals = 0;
  int geometric_residuals = 0;
  double chi2_photometric = 0;  ///< sum of squared whitened residuals
  double chi2_geometric = 0;
  double robust_photometric = 0;  ///< sum of min(r^2, k |r|) over the same residuals, with Huber's k
  double robust_geometric = 0;
  double gain = 1;  ///< brightness relative to the reference, divided by the common gain
  /// ZNCC (-1 to 1) of the intensities with the reference at level 0. Unlike the chi-squares, it depends
  /// neither on the assumed or estimated noise nor on brightness.
  double correlation = 0;
  /// Standard deviation of the intensities at level 0, the larger one of frame and reference. The correlation
  /// is not meaningful if the contrast is close to the noise.
  double contrast_grey = 0;
  double mean_error_grey = 0;             ///< mean absolute difference at level 0, after the common gain
  Vector2d centre_px = Vector2d::Zero();  ///< centre of a square around the visible pixels
};

/// Grey levels of a level-0 image at the warped pixels; unspecified for invisible ones.
[[nodiscard]] simd::Float8 grey_at(const GreyImage& image, const patches::WarpedLanes& warped);

/// Sets the visibility of a patch: counts, centre, mean error, and whether it is tracked. Pixels, warped
/// positions and image are of level 0.
void judge_visibility(std::span<const patches::PixelLanes> pixels,
                      std::span<const patches::WarpedLanes> warped, const GreyImage& image,
                      double common_gain, const config::PatchConfig& config, PatchOutcome& outcome);

/// Factors on the information of both kinds of residuals; 0 switches a kind off.
struct TermWeights {
  double photometric = 1;
  double geometric = 1;
};

/// Chi-square gate and limits of the gain. Requires the sums of the residuals and the gain.
[[nodiscard]] bool is_consistent(const PatchOutcome& outcome, const config::IekfConfig& config,
                                 const TermWeights& weights);
/// The photometric part of is_consistent().
[[nodiscard]] bool fits_color(const PatchOutcome& outcome, const config::IekfConfig& config,
                              const TermWeights& weights);

}  // namespace fusebench::measurement
