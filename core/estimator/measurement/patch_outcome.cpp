#include "core/estimator/measurement/patch_outcome.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/simd/image_lanes.hpp"
#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/estimator/patches/patch_deformation.hpp"

namespace fusebench::measurement {

namespace {

/// Sums for the correlation of two intensities. A middle grey is subtracted to keep single precision
/// sufficient.
struct Correlation {
  void add(simd::Float8 observed, simd::Float8 reference, simd::Int8 used) {
    const simd::Float8 a = used ? observed - 128.0F : simd::Float8{};
    const simd::Float8 b = used ? reference - 128.0F : simd::Float8{};
    sum_a += a;
    sum_b += b;
    sum_aa += a * a;
    sum_bb += b * b;
    sum_ab += a * b;
  }
  void describe(PatchOutcome& outcome) const {
    const int count = outcome.usable_pixels;
    const double a = simd::sum_of_lanes(sum_a) / count;
    const double b = simd::sum_of_lanes(sum_b) / count;
    const double aa = simd::sum_of_lanes(sum_aa) / count - a * a;
    const double bb = simd::sum_of_lanes(sum_bb) / count - b * b;
    outcome.contrast_grey = std::sqrt(std::max({aa, bb, 0.0}));
    if (aa < 1e-3 || bb < 1e-3) return;  // constant grey
    outcome.correlation = (simd::sum_of_lanes(sum_ab) / count - a * b) / std::sqrt(aa * bb);
  }
  simd::Float8 sum_a{}, sum_b{}, sum_aa{}, sum_bb{}, sum_ab{};
};

}  // namespace

simd::Float8 grey_at(const GreyImage& image, const patches::WarpedLanes& warped) {
  return simd::sample_bilinear_value(image, warped.visible ? warped.x : simd::all_lanes(1.0F),
                                     warped.visible ? warped.y : simd::all_lanes(1.0F));
}

void judge_visibility(std::span<const patches::PixelLanes> pixels,
                      std::span<const patches::WarpedLanes> warped, const GreyImage& image,
                      double common_gain, const config::PatchConfig& config, PatchOutcome& outcome) {
  const auto gain = static_cast<float>(common_gain);
  const auto count = [](simd::Int8 condition) { return std::popcount(simd::lane_bits(condition)); };
  outcome.usable_pixels = 0;
  outcome.covered_pixels = 0;
  outcome.correlation = 0;
  outcome.mean_error_grey = 0;
  int in_image = 0;
  simd::Float8 difference{}, sum_x{}, sum_y{};
  Correlation correlation;
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const patches::WarpedLanes& w = warped[i];
    in_image += count(w.in_image);
    outcome.covered_pixels += count(w.covered);
    outcome.usable_pixels += count(w.visible);
    sum_x += w.visible ? w.x : simd::Float8{};
    sum_y += w.visible ? w.y : simd::Float8{};
    const simd::Float8 observed = grey_at(image, w);
    const simd::Float8 apart = simd::abs(observed - gain * pixels[i].intensity);
    correlation.add(observed, pixels[i].intensity, w.visible);
    difference += w.visible ? apart : simd::Float8{};
  }
  outcome.centre_px = {simd::sum_of_lanes(sum_x), simd::sum_of_lanes(sum_y)};
  const int square = config.size_px * config.size_px;
  outcome.in_view = in_image > 0;
  outcome.shrunk = outcome.usable_pixels < in_image;
  outcome.extended = patches::is_extended(warped, config.size_px);
  outcome.tracked = outcome.usable_pixels >= config.min_valid_px &&
                    outcome.usable_pixels >= config.min_valid_fraction * square;
  if (outcome.usable_pixels > 0) {
    // The centres of the pixels of an even square [c - s/2, c + s/2) have their mean at c - 1/2.
    outcome.centre_px =
        outcome.centre_px / outcome.usable_pixels + Vector2d::Constant(config.size_px % 2 == 0 ? 0.5 : 0.0);
    correlation.describe(outcome);
    outcome.mean_error_grey = simd::sum_of_lanes(difference) / outcome.usable_pixels;
  }
}

bool fits_color(const PatchOutcome& outcome, const config::IekfConfig& config, const TermWeights& weights) {
  const bool photometric =
      weights.photometric <= 0 ||
      outcome.chi2_photometric <= config.max_chi2_per_measurement * outcome.photometric_residuals;
  // A gain near 0 fits any image, so a gain far from 1 indicates a wrong match, not a change of brightness.
  constexpr double kMaxGain = 2.0;
  return photometric && outcome.gain > 1.0 / kMaxGain && outcome.gain < kMaxGain;
}

bool is_consistent(const PatchOutcome& outcome, const config::IekfConfig& config,
                   const TermWeights& weights) {
  return fits_color(outcome, config, weights) &&
         outcome.chi2_geometric <= config.max_chi2_per_measurement * std::max(1, outcome.geometric_residuals);
}

}  // namespace fusebench::measurement
