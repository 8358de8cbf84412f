// Outcome of tracking a patch in a frame: visibility and consistency.
#pragma once

#include <span>

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/patches/patch_lanes.hpp"

namespace fusebench::measurement {

/// Outcome of one patch at the last linearisation.
struct PatchOutcome {
  bool in_view = false;            ///< at least one pixel inside the image
  bool tracked = false;            ///< enough usable pixels at level 0
  bool accepted = false;           ///< tracked, and consistent (chi-square gate)
  bool contradicts_color = false;  ///< tracked, and its intensities do not fit
  bool shrunk = false;             ///< lost pixels to occlusion
  bool extended = false;
  int usable_pixels = 0;   ///< visible, level 0
  int covered_pixels = 0;  ///< in the image, behind something that was measured before them
  int photometric_residuals = 0;
  int geometric_residuals = 0;
  double chi2_photometric = 0;  ///< sum of squared whitened residuals
  double chi2_geometric = 0;
  double robust_photometric = 0;  ///< sum of min(r^2, k |r|) of the same, with Huber's k
  double robust_geometric = 0;
  double gain = 1;  ///< brightness against the patch's reference, divided by that which all have in common
  /// Correlation of intensities with those of the reference at level 0 (ZNCC, -1 to 1): unlike the
  /// chi-squares it depends neither on the noise that is assumed or learnt nor on brightness.
  double correlation = 0;
  /// Standard deviation of the intensities there, of the frame's or the reference's, whichever is larger: the
  /// correlation of patches of little more contrast than noise says nothing.
  double contrast_grey = 0;
  double mean_error_grey = 0;             ///< mean absolute difference at level 0, after the gain in common
  Vector2d centre_px = Vector2d::Zero();  ///< where a square around the visible pixels has its centre
};

/// Grey levels of a level-0 image at the warped pixels; unspecified where they are not visible.
[[nodiscard]] simd::Float8 grey_at(const GreyImage& image, const patches::WarpedLanes& warped);

/// How much of a patch is seen: counts, centre, mean error, and whether that is enough to call it tracked.
/// Pixels, warped positions and image are those of level 0.
void judge_visibility(std::span<const patches::PixelLanes> pixels,
                      std::span<const patches::WarpedLanes> warped, const GreyImage& image,
                      double common_gain, const config::PatchConfig& config, PatchOutcome& outcome);

/// Factors on the information of the two kinds of residuals in a frame; 0 switches a kind off.
struct TermWeights {
  double photometric = 1;
  double geometric = 1;
};

/// The chi-square gate, and a plausible gain. Needs the sums of the residuals and the gain.
[[nodiscard]] bool is_consistent(const PatchOutcome& outcome, const config::IekfConfig& config,
                                 const TermWeights& weights);
/// The part of it that is of colour.
[[nodiscard]] bool fits_color(const PatchOutcome& outcome, const config::IekfConfig& config,
                              const TermWeights& weights);

}  // namespace fusebench::measurement
