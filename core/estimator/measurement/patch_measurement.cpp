#include "core/estimator/measurement/patch_measurement.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/bits.hpp"
#include "core/base/error.hpp"
#include "core/base/simd/image_lanes.hpp"
#include "core/config/config.hpp"
#include "core/estimator/measurement/grey_residual.hpp"
#include "core/estimator/measurement/patch_scatter.hpp"
#include "core/estimator/measurement/patch_squares.hpp"
#include "core/estimator/measurement/patch_translation.hpp"
#include "core/estimator/measurement/posed_levels.hpp"
#include "core/estimator/patches/posed_camera.hpp"

namespace fusebench::measurement {

namespace {

/// Local origin near the points of the patches.
Vector3d origin_of(std::span<const patches::Patch> patches) {
  for (const patches::Patch& patch : patches) {
    for (const patches::PatchLevel& level : patch.levels) {
      if (!level.pixels.empty()) return level.pixels.front().point_world;
    }
  }
  return Vector3d::Zero();
}

}  // namespace

PatchMeasurement::PatchMeasurement(const config::Config& config, const SensorRig& rig, const Workers& workers)
    : config_(config),
      photometric_(config.photometric),
      rig_(rig),
      workers_(workers),
      brightness_prior_(config.photometric),
      gates_(config.geometric, config.depth, scale_.geometric),
      levels_(static_cast<std::size_t>(config.patches.levels)) {}

int PatchMeasurement::stages() const { return config_.patches.levels; }

void PatchMeasurement::observe(const ObservedFrame& frame, std::span<const patches::Patch> patches,
                               const ResidualScale& scale) {
  frame_.emplace(frame);
  patches_ = patches;
  scale_ = scale;
  weights_ = {frame.color_is_new ? config_.terms.photometric_weight : 0.0,
              frame.depth_is_new ? config_.terms.geometric_weight : 0.0};
  common_gain_.reset();
  origin_world_ = origin_of(patches);
  gates_ = AssociationGates(config_.geometric, config_.depth, scale.geometric);
  states_.assign(patches.size(), {});
  outcomes_.assign(patches.size(), {});
  workers_.for_chunks(levels_.size(), 1, [&](std::size_t l, std::size_t /*end*/) {
    Level& level = levels_[l];
    patches::pack(patches, l, origin_world_, level.lanes);
    level.fixed.assign(level.lanes.pixels.size(), {});
    level.occlusion.resize(frame.pyramid[l].width, frame.pyramid[l].height);
  });
}

filter::MeasurementQuadratic PatchMeasurement::linearise(const filter::PoseHypothesis& poses, int stage,
                                                         bool gate) {
  check(frame_.has_value(), "a frame is observed before it is measured by");
  finest_ = static_cast<std::size_t>(config_.patches.levels - 1 - stage);
  const PosedLevels posed(rig_, poses, config_.patches.levels, origin_world_);
  warp_all(posed);
  if (!common_gain_) find_common_gain();
  workers_.for_chunks(patches_.size(), kPatchesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      outcomes_[p] = {};
      associate_planes(p, posed);
      sum_photometric(p, posed);
      sum_geometric(p, posed);
      states_[p].counts = outcomes_[p].photometric_residuals + outcomes_[p].geometric_residuals > 0;
      if (finest_ == 0) judge(p, gate);
    }
  });
  photometric_variance_ = measured_variance(&PatchState::photometric);
  geometric_variance_ = measured_variance(&PatchState::geometric) + common_depth_variance();
  filter::MeasurementQuadratic sum;
  sum.compensated = frame_->motion.compensated;
  const patches::PosedCamera camera(rig_.camera, poses.T_world_imu_by_reference, rig_.T_imu_camera);
  DisplacedPatches color;
  DisplacedPatches depth;
  for (std::size_t p = 0; p < states_.size(); ++p) {
    sum.by_reference.add(states_[p].photometric, 1.0 / color_variance());
    sum.by_model.add(states_[p].geometric, 1.0 / geometric_variance_);
    const std::optional<PatchRows> rows = rows_of(p, camera);
    if (!rows) continue;
    color.add(states_[p].photometric, rows->color_weights());
    depth.add(states_[p].geometric, rows->depth_weights());
  }
  sum.readout_by_reference = color.by_readout(color_displacement(frame_->motion), color_variance());
  sum.readout_by_model = depth.by_readout(depth_displacement(frame_->motion), geometric_variance_);
  return sum;
}

/// Estimates the common gain at the first linearisation, since patches can be seconds old. Eq. 3 without
/// brightness has no gain.
void PatchMeasurement::find_common_gain() {
  const bool has_gain = frame_->color_is_new && photometric_.gain_sigma > 0;
  common_gain_ =
      has_gain ? measurement::common_gain(levels_.back().lanes, frame_->pyramid[levels_.size() - 1]) : 1;
  brightness_prior_ = BrightnessPrior(photometric_, *common_gain_);
  for (PatchState& state : states_) state.brightness.value = brightness_prior_.mean();
}

/// Nothing if the patch has no residuals.
std::optional<PatchRows> PatchMeasurement::rows_of(std::size_t patch,
                                                   const patches::PosedCamera& camera) const {
  const auto& pixels = patches_[patch].levels.front().pixels;
  if (!states_[patch].counts || pixels.empty()) return std::nullopt;
  const Vector3d centre = camera.to_camera(pixels[pixels.size() / 2].point_world);
  if (centre.z() <= 0) return std::nullopt;
  const double last_row = rig_.camera.height_px - 1;
  const auto share = [&](double row) { return std::clamp(row / last_row, 0.0, 1.0) - 0.5; };
  return PatchRows{share(rig_.camera.project(centre).y()), share(patches_[patch].centre_px.y())};
}

/// Variance factor of the errors that are independent between frames. A residual contains the noise of two
/// images. The noise of an anchor's image is common to all frames compared with it and counts as an error of
/// the anchor's pose (filter::with_anchor_noise()). Half of the variance remains.
double PatchMeasurement::color_variance() const { return 0.5 * photometric_variance_; }

Matrix6d PatchMeasurement::color_information() const {
  Matrix6d sum = Matrix6d::Zero();
  for (const PatchState& state : states_) sum += state.photometric.information;
  return sum / color_variance();
}

double PatchMeasurement::measured_variance(filter::PoseQuadratic PatchState::*kind) const {
  std::vector<filter::PoseQuadratic> clusters;
  clusters.reserve(states_.size());
  for (const PatchState& state : states_) clusters.push_back(state.*kind);
  return variance_factor(patch_scatter(clusters), config_.iekf.scatter_prior_freedom);
}

double PatchMeasurement::common_depth_variance() const {
  // Without an IMU, nothing else constrains the rotation where colour has little information.
  if (config_.terms.prior != config::Prior::imu) return 0;
  int residuals = 0;
  for (std::size_t p = 0; p < states_.size(); ++p) {
    if (states_[p].counts) residuals += outcomes_[p].geometric_residuals;
  }
  const double measurements = static_cast<double>(residuals) * geometric_weighting().share;
  return common_error_factor(measurements, config_.geometric.common_error_share);
}

/// Levels are independent and have similar numbers of pixels.
void PatchMeasurement::warp_all(const PosedLevels& posed) {
  const bool coarse = finest_ > 0;
  const double tolerance_m = (coarse ? 2.0 : 1.0) * config_.patches.occlusion_distance_m;
  workers_.for_chunks(levels_.size() - finest_, 1, [&](std::size_t begin, std::size_t /*end*/) {
    const std::size_t l = finest_ + begin;
    patches::LevelLanes& lanes = levels_[l].lanes;
    patches::warp_level(lanes.pixels, lanes.warp_points, posed.at[l], lanes.warped);
    if (!config_.terms.visibility_test) return;
    levels_[l].occlusion.test(lanes.warped, config_.depth, config_.patches.shrink_test);
    patches::test_measured_occlusion(lanes.warped, frame_->depth_m, 1 << l, tolerance_m, config_.depth);
  });
}

void PatchMeasurement::associate_planes(std::size_t patch, const PosedLevels& posed) {
  if (weights_.geometric <= 0) return;
  for (std::size_t l = finest_; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    for (std::size_t i = level.lanes.first[patch]; i < level.lanes.first[patch + 1]; ++i) {
      PlanePairs& pairs = level.fixed[i].pairs;
      pairs = associate(posed.by_model, level.lanes.pixels[i], frame_->depth_m, gates_, pairs);
    }
  }
}

PatchMeasurement::Weighting PatchMeasurement::photometric_weighting() const {
  return {static_cast<float>(weights_.photometric / photometric_.pixels_per_measurement),
          static_cast<float>(photometric_.huber_sigmas)};
}

PatchMeasurement::Weighting PatchMeasurement::geometric_weighting() const {
  return {static_cast<float>(weights_.geometric / config_.geometric.pixels_per_measurement),
          static_cast<float>(config_.geometric.huber_sigmas)};
}

void PatchMeasurement::sum_photometric(std::size_t patch, const PosedLevels& posed) {
  PatchState& state = states_[patch];
  const Weighting weighting = photometric_weighting();
  const config::Sampling sampling = photometric_.sampling;
  const GreyResidual residual_of(state.brightness.value, scale_.photometric * photometric_.noise_grey);
  QuadraticSums sums;
  BrightnessSums light;
  FitSums fit;
  for (std::size_t l = finest_; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const patches::LevelLanes& lanes = level.lanes;
    for (std::size_t i = lanes.first[patch]; i < lanes.first[patch + 1]; ++i) {
      const patches::PixelLanes& pixels = lanes.pixels[i];
      const patches::WarpedLanes& w = lanes.warped[i];
      const simd::Int8 used = w.visible & pixels.depth_confirmed;
      level.fixed[i].photometric = used;
      if (!simd::any(used)) continue;
      const simd::IntensityLanes observed =
          simd::sample_bicubic(frame_->pyramid[l], sampled_at(used ? w.x : simd::all_lanes(1.0F), sampling),
                               sampled_at(used ? w.y : simd::all_lanes(1.0F), sampling));
      simd::Points point = posed.at[l].to_camera(lanes.projected(i));
      point.z = used ? point.z : simd::all_lanes(1.0F);
      const JacobianLanes jacobian = photometric_jacobian(posed.at[l], point, observed.dx, observed.dy);
      const simd::Float8 residual = residual_of(observed.value, pixels.intensity);
      const simd::Float8 whitened = residual * residual_of.per_noise;
      const RobustLanes robust = huber(whitened, weighting.robust_sigmas);
      const simd::Float8 weight =
          used ? weighting.share * residual_of.per_noise * residual_of.per_noise * robust.weight
               : simd::Float8{};
      sums.add(jacobian, residual, weight, used ? weighting.share * robust.cost : simd::Float8{});
      light.add(jacobian, residual, weight, pixels.intensity);
      fit.add(whitened, robust.weight, used);
    }
  }
  state.photometric = sums.total();
  state.brightness.information = light.information();
  state.brightness.gradient = light.gradient();
  state.brightness.by_pose = light.by_pose();
  outcomes_[patch].chi2_photometric = simd::sum_of_lanes(fit.chi2);
  outcomes_[patch].robust_photometric = simd::sum_of_lanes(fit.robust);
  outcomes_[patch].photometric_residuals = fit.count;
  brightness_prior_.eliminate(state.brightness, state.photometric);
}

void PatchMeasurement::sum_geometric(std::size_t patch, const PosedLevels& posed) {
  const Weighting weighting = geometric_weighting();
  QuadraticSums sums;
  FitSums fit;
  for (std::size_t l = finest_; l < levels_.size(); ++l) {
    const Level& level = levels_[l];
    for (std::size_t i = level.lanes.first[patch]; i < level.lanes.first[patch + 1]; ++i) {
      const PlanePairs& pairs = level.fixed[i].pairs;
      if (!simd::any(pairs.valid)) continue;
      const patches::PixelLanes& planes = level.lanes.pixels[i];
      const simd::Float8 per_sigma = 1.0F / (pairs.valid ? pairs.sigma_m : simd::all_lanes(1.0F));
      const simd::Float8 residual_m =
          pairs.valid ? plane_residual(posed.by_model, pairs, planes) : simd::Float8{};
      const simd::Float8 whitened = residual_m * per_sigma;
      const RobustLanes robust = huber(whitened, weighting.robust_sigmas);
      const simd::Float8 weight =
          pairs.valid ? weighting.share * per_sigma * per_sigma * robust.weight : simd::Float8{};
      sums.add(plane_jacobian(posed.by_model, pairs, planes), residual_m, weight,
               pairs.valid ? weighting.share * robust.cost : simd::Float8{});
      fit.add(whitened, robust.weight, pairs.valid);
    }
  }
  states_[patch].geometric = sums.total();
  outcomes_[patch].chi2_geometric = simd::sum_of_lanes(fit.chi2);
  outcomes_[patch].robust_geometric = simd::sum_of_lanes(fit.robust);
  outcomes_[patch].geometric_residuals = fit.count;
}

void PatchMeasurement::judge(std::size_t patch, bool gate) {
  PatchState& state = states_[patch];
  PatchOutcome& outcome = outcomes_[patch];
  outcome.gain = state.brightness.value.x() / *common_gain_;
  judge_visibility(levels_.front().lanes.pixels_of(patch), levels_.front().lanes.warped_of(patch),
                   frame_->pyramid.front(), *common_gain_, config_.patches, outcome);
  outcome.contradicts_color = outcome.tracked && !fits_color(outcome, config_.iekf, weights_);
  outcome.accepted =
      outcome.tracked && state.counts && (!gate || is_consistent(outcome, config_.iekf, weights_));
  if (!outcome.accepted) {
    // A rejected patch contributes neither its residuals nor its brightness prior.
    state.counts = false;
    state.photometric = {};
    state.geometric = {};
  }
}

void PatchMeasurement::move_patches_alone(const SE3& T_world_imu_predicted) {
  check(frame_.has_value() && finest_ == 0, "patches are moved after the last linearisation");
  warp_all(PosedLevels(rig_, {T_world_imu_predicted, T_world_imu_predicted}, config_.patches.levels,
                       origin_world_));
  workers_.for_chunks(patches_.size(), kPatchesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      std::vector<PlacedPatch> placed;
      for (std::size_t l = 0; l < levels_.size(); ++l) {
        const patches::LevelLanes& lanes = levels_[l].lanes;
        placed.push_back({lanes.pixels_of(p), lanes.warped_of(p), frame_->pyramid[l]});
      }
      patches::LevelLanes& finest = levels_.front().lanes;
      const GreyImage& image = frame_->pyramid.front();
      translate(finest.warped_of(p), own_translation_px(placed), image);
      judge_visibility(finest.pixels_of(p), finest.warped_of(p), image, *common_gain_, config_.patches,
                       outcomes_[p]);
      outcomes_[p].accepted &= outcomes_[p].tracked;
    }
  });
}

void PatchMeasurement::accept() {
  for (PatchState& state : states_) state.brightness.value = state.brightness.trial;
}

TrackedPixels PatchMeasurement::tracked_pixels() const {
  TrackedPixels tracked;
  std::size_t count = 0;
  for (const PatchOutcome& outcome : outcomes_)
    count += outcome.tracked ? static_cast<std::size_t>(outcome.usable_pixels) : 0;
  tracked.intensity.reserve(count);
  tracked.warped.reserve(count);
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    if (!outcomes_[p].tracked) continue;
    const auto& pixels = patches_[p].levels.front().pixels;
    const auto warped = levels_.front().lanes.warped_of(p);
    if (config_.evaluation.intensity_readings)
      add_square({static_cast<std::uint32_t>(p), outcomes_[p].accepted, patches_[p], warped},
                 frame_->pyramid.front(), rig_.camera.width_px, tracked.squares);
    for (std::size_t group = 0; group < warped.size(); ++group) {
      const patches::WarpedLanes& w = warped[group];
      const simd::Float8 observed = grey_at(frame_->pyramid.front(), w);
      for_each_bit(simd::lane_bits(w.visible), [&](std::size_t lane) {
        const patches::PatchPixel& pixel = pixels[group * simd::kLanes + lane];
        const float reference = pixel.intensity;
        const auto nearest = [](float place_px, int size_px) {
          return static_cast<std::uint32_t>(std::clamp(std::lround(place_px), 0L, long{size_px} - 1));
        };
        const std::uint32_t landing =
            nearest(w.y[lane], rig_.camera.height_px) * static_cast<std::uint32_t>(rig_.camera.width_px) +
            nearest(w.x[lane], rig_.camera.width_px);
        tracked.intensity.push_back({landing, std::abs(observed[lane] - reference), outcomes_[p].accepted});
        tracked.warped.push_back({static_cast<std::uint32_t>(p),
                                  pixel.reference_pixel,
                                  {w.x[lane], w.y[lane]},
                                  reference,
                                  observed[lane]});
      });
    }
  }
  return tracked;
}

}  // namespace fusebench::measurement
