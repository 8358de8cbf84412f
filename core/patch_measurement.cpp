#include "core/patch_measurement.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/depth_gates.hpp"
#include "core/patch_scatter.hpp"
#include "core/residuals.hpp"

namespace fusebench {

namespace {
// Patches a task: fixed, so that the work is cut alike for every number of threads.
constexpr std::size_t kPatchesPerChunk = 8;

/// Information of a prior with that standard deviation; zero sigma pins the value.
double prior_information(double sigma) { return sigma > 0 ? 1.0 / (sigma * sigma) : 1e18; }
}  // namespace

struct PatchMeasurement::PosedLevels {
  PosedLevels(const SensorRig& rig, const PoseHypothesis& poses, int levels)
      : by_model(rig.camera, poses.T_world_imu_by_model, rig.T_imu_camera) {
    for (int level = 0; level < levels; ++level) {
      at.emplace_back(camera_at_level(rig.camera, level), poses.T_world_imu_by_reference, rig.T_imu_camera);
    }
  }
  std::vector<PosedCamera> at;  ///< by reference
  PosedCamera by_model;
};

PatchMeasurement::PatchMeasurement(const Config& config, const SensorRig& rig, const ObservedFrame& frame,
                                   std::span<const Patch> patches, const ResidualScale& scale,
                                   const Workers& workers)
    : config_(config),
      rig_(rig),
      frame_(frame),
      patches_(patches),
      scale_(scale),
      workers_(workers),
      warped_(static_cast<std::size_t>(config.patches.levels)),
      states_(patches.size()),
      outcomes_(patches.size()) {
  for (auto& level : warped_) level.resize(patches.size());
}

MeasurementQuadratic PatchMeasurement::linearise(const PoseHypothesis& poses, int stage, bool gate) {
  const int finest_level = config_.patches.levels - 1 - stage;
  const PosedLevels posed(rig_, poses, config_.patches.levels);
  warp_all(posed, finest_level);
  workers_.for_chunks(patches_.size(), kPatchesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      outcomes_[p] = {};
      states_[p].photometric = {};
      states_[p].geometric = {};
      associate_planes(p, posed, finest_level);
      sum_photometric(p, posed, finest_level);
      sum_geometric(p, posed);
      if (finest_level == 0) judge_visibility(p, gate);
    }
  });
  photometric_variance_ = measured_variance(&PatchState::photometric);
  geometric_variance_ = measured_variance(&PatchState::geometric);
  MeasurementQuadratic sum;
  for (const PatchState& state : states_) {
    sum.by_reference.add(state.photometric, 1.0 / photometric_variance_);
    sum.by_model.add(state.geometric, 1.0 / geometric_variance_);
  }
  return sum;
}

double PatchMeasurement::measured_variance(PoseQuadratic PatchState::*kind) const {
  std::vector<PoseQuadratic> clusters;
  clusters.reserve(states_.size());
  for (const PatchState& state : states_) clusters.push_back(state.*kind);
  return variance_factor(patch_scatter(clusters), config_.iekf.scatter_prior_freedom);
}

void PatchMeasurement::warp_all(const PosedLevels& posed, int finest_level) {
  const bool coarse = finest_level > 0;
  const double tolerance_m = (coarse ? 2.0 : 1.0) * config_.patches.occlusion_distance_m;
  for (int level = finest_level; level < config_.patches.levels; ++level) {
    auto& warped = warped_[static_cast<std::size_t>(level)];
    const PosedCamera& camera = posed.at[static_cast<std::size_t>(level)];
    workers_.for_chunks(patches_.size(), kPatchesPerChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        warped[p] = warp_level(patches_[p].levels[static_cast<std::size_t>(level)], camera);
      }
    });
    if (!config_.terms.visibility_test) continue;
    test_mutual_occlusion(warped, camera.camera.width_px, camera.camera.height_px, config_.depth);
    for (auto& patch : warped) {
      test_measured_occlusion(patch, frame_.depth_m, 1 << level, tolerance_m, config_.depth);
    }
  }
}

void PatchMeasurement::associate_planes(std::size_t patch, const PosedLevels& posed, int finest_level) {
  PatchState& state = states_[patch];
  state.pairs.clear();
  if (config_.terms.geometric_weight <= 0) return;
  const PosedCamera& camera = posed.by_model;
  const double min_normal_cosine = std::cos(radians(config_.geometric.max_normal_angle_deg));
  const double min_incidence_cosine = std::cos(radians(config_.depth.max_incidence_deg));
  for (int level = finest_level; level < config_.patches.levels; ++level) {
    for (const PatchPixel& pixel : patches_[patch].levels[static_cast<std::size_t>(level)].pixels) {
      // Projective association: the measurement at the pixel where the model point lands.
      const Vector3d predicted_camera = camera.to_camera(pixel.point_world);
      if (predicted_camera.z() <= 0) continue;
      const Vector2d landed = camera.camera.project(predicted_camera);
      if (!(std::abs(landed.x()) < 1e6 && std::abs(landed.y()) < 1e6)) continue;
      const int x = static_cast<int>(std::lround(landed.x()));
      const int y = static_cast<int>(std::lround(landed.y()));
      if (!frame_.depth_m.contains(x, y) || frame_.depth_m(x, y) <= 0) continue;
      const Vector3d measured_camera = camera.camera.back_project(x, y, frame_.depth_m(x, y));
      if ((measured_camera - predicted_camera).norm() > config_.geometric.max_distance_m) continue;
      const Vector3d normal_camera = camera.R_camera_world * pixel.normal_world;
      const Vector3d measured_normal_camera = measured_normal(frame_.depth_m, camera.camera, x, y);
      if (measured_normal_camera.dot(normal_camera) < min_normal_cosine) continue;
      const double incidence_cosine = -measured_camera.normalized().dot(normal_camera);
      if (incidence_cosine < min_incidence_cosine) continue;
      // Depth noise acts along the ray; the plane sees its share along the normal.
      const double along_ray_m =
          depth_sigma_m(measured_camera.z(), config_.depth) * measured_camera.norm() / measured_camera.z();
      state.pairs.push_back(
          {camera.to_imu(measured_camera), pixel.point_world, pixel.normal_world,
           scale_.geometric * std::hypot(along_ray_m * incidence_cosine, config_.geometric.model_noise_m)});
    }
  }
}

void PatchMeasurement::sum_photometric(std::size_t patch, const PosedLevels& posed, int finest_level) {
  PatchState& state = states_[patch];
  PatchOutcome& outcome = outcomes_[patch];
  PoseQuadratic& sum = state.photometric;
  Brightness& light = state.brightness;
  state.active.clear();
  light.information.setZero();
  light.gradient.setZero();
  light.by_pose.setZero();
  const double noise = scale_.photometric * config_.photometric.noise_grey;
  const double share = config_.terms.photometric_weight / config_.photometric.pixels_per_measurement;
  for (int level = finest_level; level < config_.patches.levels; ++level) {
    const auto l = static_cast<std::size_t>(level);
    const auto& pixels = patches_[patch].levels[l].pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const WarpedPixel& w = warped_[l][patch][i];
      if (!w.visible || !pixels[i].depth_confirmed) continue;
      const IntensitySample observed = sample_bicubic(frame_.pyramid[l], w.pixel_px.x(), w.pixel_px.y());
      const Projection projection = project_with_jacobian(posed.at[l], w.warp_point_camera);
      const PhotometricResidual r = photometric_residual(observed, projection.jacobian, pixels[i].intensity,
                                                         light.value.x(), light.value.y());
      const double whitened = r.value_grey / noise;
      const RobustValue robust = huber(whitened, config_.photometric.huber_sigmas);
      const double weight = share * robust.weight / (noise * noise);
      const Vector2d by_light(-pixels[i].intensity, -1.0);
      sum.information += weight * r.jacobian.transpose() * r.jacobian;
      sum.gradient += weight * r.value_grey * r.jacobian.transpose();
      sum.cost += share * robust.cost;
      light.information += weight * by_light * by_light.transpose();
      light.gradient += weight * r.value_grey * by_light;
      light.by_pose += weight * by_light * r.jacobian;
      outcome.chi2_photometric += whitened * whitened;
      outcome.robust_photometric += robust.weight * whitened * whitened;
      ++outcome.photometric_residuals;
      state.active.push_back({level, &pixels[i]});
    }
  }
  reduce_brightness(state);
}

void PatchMeasurement::reduce_brightness(PatchState& state) const {
  Brightness& light = state.brightness;
  const Vector2d prior(prior_information(config_.photometric.gain_sigma),
                       prior_information(config_.photometric.offset_sigma_grey));
  light.information += prior.asDiagonal().toDenseMatrix();
  light.gradient += prior.cwiseProduct(light.value - Vector2d(1.0, 0.0));
  state.photometric.cost += brightness_cost(light.value);
  const Eigen::Matrix2d inverse = light.information.inverse();
  state.photometric.information -= light.by_pose.transpose() * inverse * light.by_pose;
  state.photometric.gradient -= light.by_pose.transpose() * inverse * light.gradient;
}

double PatchMeasurement::brightness_cost(const Vector2d& value) const {
  const double gain = value.x() - 1.0;
  const double offset = value.y();
  return 0.5 * (gain * gain * prior_information(config_.photometric.gain_sigma) +
                offset * offset * prior_information(config_.photometric.offset_sigma_grey));
}

void PatchMeasurement::sum_geometric(std::size_t patch, const PosedLevels& posed) {
  PatchState& state = states_[patch];
  PatchOutcome& outcome = outcomes_[patch];
  const double share = config_.terms.geometric_weight / config_.geometric.pixels_per_measurement;
  for (const PlanePair& pair : state.pairs) {
    const PlaneResidual r =
        point_to_plane_residual(posed.by_model, pair.point_imu, pair.plane_point_world, pair.normal_world);
    const double whitened = r.value_m / pair.sigma_m;
    const RobustValue robust = huber(whitened, config_.geometric.huber_sigmas);
    const double weight = share * robust.weight / (pair.sigma_m * pair.sigma_m);
    state.geometric.information += weight * r.jacobian.transpose() * r.jacobian;
    state.geometric.gradient += weight * r.value_m * r.jacobian.transpose();
    state.geometric.cost += share * robust.cost;
    outcome.chi2_geometric += whitened * whitened;
    outcome.robust_geometric += robust.weight * whitened * whitened;
    ++outcome.geometric_residuals;
  }
}

void PatchMeasurement::judge_visibility(std::size_t patch, bool gate) {
  PatchState& state = states_[patch];
  PatchOutcome& outcome = outcomes_[patch];
  const auto& pixels = patches_[patch].levels.front().pixels;
  const auto& warped = warped_.front()[patch];
  int in_image = 0;
  double difference = 0;
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const WarpedPixel& w = warped[i];
    in_image += w.in_image ? 1 : 0;
    outcome.covered_pixels += w.covered ? 1 : 0;
    if (!w.visible) continue;
    ++outcome.usable_pixels;
    outcome.centre_px += w.pixel_px;
    difference += std::abs(sample_bilinear(frame_.pyramid.front(), w.pixel_px.x(), w.pixel_px.y()).value -
                           pixels[i].intensity);
  }
  const int square = config_.patches.size_px * config_.patches.size_px;
  outcome.in_view = in_image > 0;
  outcome.gain = state.brightness.value.x();
  outcome.shrunk = outcome.usable_pixels < in_image;
  outcome.extended = is_extended(warped, config_.patches.size_px);
  outcome.tracked = outcome.usable_pixels >= config_.patches.min_valid_px &&
                    outcome.usable_pixels >= config_.patches.min_valid_fraction * square;
  if (outcome.usable_pixels > 0) {
    // An even square [c - s/2, c + s/2) has the mean of its pixel centres half a pixel before c.
    outcome.centre_px = outcome.centre_px / outcome.usable_pixels +
                        Vector2d::Constant(config_.patches.size_px % 2 == 0 ? 0.5 : 0.0);
    outcome.mean_error_grey = difference / outcome.usable_pixels;
  }
  const bool informative = outcome.photometric_residuals + outcome.geometric_residuals > 0;
  outcome.accepted = outcome.tracked && informative && (!gate || is_consistent(outcome));
  if (!outcome.accepted) {
    // Rejected honestly: neither its residuals nor its brightness prior count.
    state.active.clear();
    state.pairs.clear();
    state.photometric = {};
    state.geometric = {};
  }
}

bool PatchMeasurement::is_consistent(const PatchOutcome& outcome) const {
  const double limit = config_.iekf.max_chi2_per_measurement;
  const bool photometric = config_.terms.photometric_weight <= 0 ||
                           outcome.chi2_photometric <= limit * outcome.photometric_residuals;
  // Any image explains a patch that is dimmed to nothing: a gain far from 1 is no brightness change but
  // another scene.
  constexpr double kMaxGain = 2.0;
  const bool plausible = outcome.gain > 1.0 / kMaxGain && outcome.gain < kMaxGain;
  return photometric && plausible &&
         outcome.chi2_geometric <= limit * std::max(1, outcome.geometric_residuals);
}

double PatchMeasurement::trial_cost(const PoseHypothesis& poses, const MeasuredVector& step,
                                    double fraction) {
  const PosedLevels posed(rig_, poses, config_.patches.levels);
  std::vector<double> costs(states_.size(), 0.0);
  workers_.for_chunks(states_.size(), kPatchesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Brightness& light = states_[p].brightness;
      const Vector2d light_step =
          -light.information.inverse() * (light.gradient + light.by_pose * step.head<kPoseSize>());
      light.trial = light.value + fraction * light_step;
      costs[p] = patch_cost(states_[p], posed);
    }
  });
  double sum = 0;
  for (const double cost : costs) sum += cost;
  return sum;
}

double PatchMeasurement::patch_cost(const PatchState& state, const PosedLevels& posed) const {
  if (state.active.empty() && state.pairs.empty()) return 0;
  double cost =
      (brightness_cost(state.brightness.trial) + photometric_cost(state, posed)) / photometric_variance_;
  const double share = config_.terms.geometric_weight / config_.geometric.pixels_per_measurement;
  for (const PlanePair& pair : state.pairs) {
    const PosedCamera& camera = posed.by_model;
    const Vector3d point_world = camera.R_world_imu * pair.point_imu + camera.t_world_imu_m;
    const double whitened = pair.normal_world.dot(point_world - pair.plane_point_world) / pair.sigma_m;
    cost += share * huber(whitened, config_.geometric.huber_sigmas).cost / geometric_variance_;
  }
  return cost;
}

double PatchMeasurement::photometric_cost(const PatchState& state, const PosedLevels& posed) const {
  const double share = config_.terms.photometric_weight / config_.photometric.pixels_per_measurement;
  double cost = 0;
  for (const ActivePixel& active : state.active) {
    const auto level = static_cast<std::size_t>(active.level);
    const GreyImage& image = frame_.pyramid[level];
    const PosedCamera& camera = posed.at[level];
    // A pixel that leaves the image, or passes behind the camera, keeps counting at the border: leaving must
    // not pay.
    Vector3d point_camera = camera.to_camera(active.pixel->warp_point_world);
    point_camera.z() = std::max(point_camera.z(), 1e-3);
    const Vector2d pixel = camera.camera.project(point_camera) + active.pixel->warp_offset_px;
    const double x = std::clamp(pixel.x(), 1.0, image.width - 2.0);
    const double y = std::clamp(pixel.y(), 1.0, image.height - 2.0);
    const double predicted =
        state.brightness.trial.x() * active.pixel->intensity + state.brightness.trial.y();
    const double whitened = (sample_bicubic(image, x, y).value - predicted) /
                            (scale_.photometric * config_.photometric.noise_grey);
    cost += share * huber(whitened, config_.photometric.huber_sigmas).cost;
  }
  return cost;
}

void PatchMeasurement::accept() {
  for (PatchState& state : states_) state.brightness.value = state.brightness.trial;
}

TrackedPixels PatchMeasurement::tracked_pixels() const {
  TrackedPixels tracked;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    if (!outcomes_[p].tracked) continue;
    const auto& pixels = patches_[p].levels.front().pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const WarpedPixel& w = warped_.front()[p][i];
      if (!w.visible) continue;
      const double observed = sample_bilinear(frame_.pyramid.front(), w.pixel_px.x(), w.pixel_px.y()).value;
      tracked.intensity.push_back({pixels[i].reference_pixel,
                                   static_cast<float>(std::abs(observed - pixels[i].intensity)),
                                   outcomes_[p].accepted});
      tracked.landings.push_back({static_cast<std::uint32_t>(p), w.pixel_px.cast<float>(),
                                  static_cast<float>(pixels[i].intensity), static_cast<float>(observed)});
    }
  }
  return tracked;
}

}  // namespace fusebench
