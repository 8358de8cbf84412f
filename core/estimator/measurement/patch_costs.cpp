// Costs of trial steps in PatchMeasurement: residuals of the last linearisation at other poses, without
// derivatives.
#include <vector>

#include "core/base/simd/image_lanes.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/estimator/measurement/grey_residual.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"
#include "core/estimator/measurement/posed_levels.hpp"

namespace fusebench::measurement {

double PatchMeasurement::trial_cost(const filter::PoseHypothesis& poses, const filter::TangentVector& step,
                                    double fraction) {
  const PosedLevels posed(rig_, poses, stages(), origin_world_);
  std::vector<double> costs(states_.size(), 0.0);
  workers_.for_chunks(states_.size(), kPatchesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      states_[p].brightness.try_step(step.head<filter::kPoseSize>(), fraction);
      costs[p] = patch_cost(p, posed);
    }
  });
  double sum = 0;
  for (const double cost : costs) sum += cost;
  return sum;
}

double PatchMeasurement::patch_cost(std::size_t patch, const PosedLevels& posed) const {
  const PatchState& state = states_[patch];
  if (!state.counts) return 0;
  return (brightness_prior_.cost(state.brightness.trial) + photometric_cost(patch, posed)) /
             color_variance() +
         geometric_cost(patch, posed) / geometric_variance_;
}

double PatchMeasurement::geometric_cost(std::size_t patch, const PosedLevels& posed) const {
  const Weighting weighting = geometric_weighting();
  simd::Float8 cost{};
  for (std::size_t l = finest_; l < levels_.size(); ++l) {
    const Level& level = levels_[l];
    for (std::size_t i = level.lanes.first[patch]; i < level.lanes.first[patch + 1]; ++i) {
      const PlanePairs& pairs = level.fixed[i].pairs;
      if (!simd::any(pairs.valid)) continue;
      const simd::Float8 whitened = plane_residual(posed.by_model, pairs, level.lanes.pixels[i]) /
                                    (pairs.valid ? pairs.sigma_m : simd::all_lanes(1.0F));
      cost += pairs.valid ? huber(whitened, weighting.robust_sigmas).cost : simd::Float8{};
    }
  }
  return static_cast<double>(weighting.share) * simd::sum_of_lanes(cost);
}

double PatchMeasurement::photometric_cost(std::size_t patch, const PosedLevels& posed) const {
  const Weighting weighting = photometric_weighting();
  const config::Sampling sampling = photometric_.sampling;
  const GreyResidual residual_of(states_[patch].brightness.trial,
                                 scale_.photometric * photometric_.noise_grey);
  simd::Float8 cost{};
  for (std::size_t l = finest_; l < levels_.size(); ++l) {
    const patches::LevelLanes& lanes = levels_[l].lanes;
    const GreyImage& image = frame_->pyramid[l];
    const patches::PosedLanes& camera = posed.at[l];
    for (std::size_t i = lanes.first[patch]; i < lanes.first[patch + 1]; ++i) {
      const simd::Int8 used = levels_[l].fixed[i].photometric;
      if (!simd::any(used)) continue;
      // A pixel that leaves the image or passes behind the camera keeps its cost at the border, so leaving
      // the image does not lower the cost.
      const simd::Points point = camera.to_camera(lanes.projected(i));
      const simd::Float8 inverse_z =
          1.0F / simd::max(used ? point.z : simd::all_lanes(1.0F), simd::all_lanes(1e-3F));
      simd::Float8 x = camera.fx_px * point.x * inverse_z + camera.cx_px;
      simd::Float8 y = camera.fy_px * point.y * inverse_z + camera.cy_px;
      if (!lanes.warp_points.empty()) {
        x += lanes.warp_points[i].offset_x;
        y += lanes.warp_points[i].offset_y;
      }
      x = sampled_at(simd::clamp(x, 1.0F, static_cast<float>(image.width - 2)), sampling);
      y = sampled_at(simd::clamp(y, 1.0F, static_cast<float>(image.height - 2)), sampling);
      const simd::Float8 observed = simd::sample_bicubic_value(image, x, y);
      const simd::Float8 whitened = residual_of(observed, lanes.pixels[i].intensity) * residual_of.per_noise;
      cost += used ? huber(whitened, weighting.robust_sigmas).cost : simd::Float8{};
    }
  }
  return static_cast<double>(weighting.share) * simd::sum_of_lanes(cost);
}

}  // namespace fusebench::measurement
