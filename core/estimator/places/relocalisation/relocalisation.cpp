#include "core/estimator/places/relocalisation/relocalisation.hpp"

#include <algorithm>
#include <span>

#include "core/config/config.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "core/estimator/filter/state_validity.hpp"

namespace fusebench::relocalisation {

namespace {

/// Converts the pose of the camera to that of the IMU.
RelocalisedPose relocalised_pose(const FoundPlace& found, const Keyframe& keyframe, const SE3& T_imu_camera,
                                 const config::RelocalisationConfig& config) {
  const SE3 T_camera_imu = T_imu_camera.inverse();
  RelocalisedPose pose{found.T_world_camera * T_camera_imu, keyframe.T_world_camera * T_camera_imu};
  const Matrix6d to_imu = filter::pose_transport(pose.T_world_imu, found.T_world_camera);
  pose.covariance = to_imu * found.covariance * to_imu.transpose();
  // Drift of the model since the fusion of the keyframe.
  const double rotation_rad = config.keyframe_rotation_sigma_rad;
  const double position_m = config.keyframe_position_sigma_m;
  pose.reference_covariance.diagonal() << Vector3d::Constant(rotation_rad * rotation_rad),
      Vector3d::Constant(position_m * position_m);
  return pose;
}

double position_sigma_m(const filter::GaussianState& prediction) {
  return largest_sigma(prediction.covariance.block<3, 3>(filter::kPosition, filter::kPosition));
}

/// Error of a predicted surface position at the viewing distance.
double reach_m(const filter::GaussianState& prediction) {
  constexpr double kSigmas = 2;
  constexpr double kDistance_m = 2;
  constexpr double kLargest_m = 0.5;  // beyond it, alignment confuses different surfaces
  const double rotation_sigma_rad =
      largest_sigma(prediction.covariance.block<3, 3>(filter::kRotation, filter::kRotation));
  const double reach_m = kSigmas * (position_sigma_m(prediction) + kDistance_m * rotation_sigma_rad);
  return std::min(reach_m, kLargest_m);
}

UnknownMotion unknown_motion(const config::Config& config) {
  const config::InitialisationConfig& initial = config.initialisation;
  const bool gyroscope = config.terms.prior == config::Prior::imu;
  return {initial.moving_velocity_sigma_mps, gyroscope ? 0.0 : initial.angular_velocity_sigma_radps};
}

}  // namespace

Relocalisation::Relocalisation(const config::Config& config, const SensorRig& rig)
    : config_(config), rig_(rig), keyframes_(rig.camera, config), odds_(config.relocalisation) {}

void Relocalisation::add_keyframe(const RgbdFrame& frame, const SE3& T_world_camera,
                                  std::int64_t timestamp_ns, double blur_px) {
  if (!config_.terms.relocalisation) return;
  odds_.clear();
  keyframes_.offer(frame.grey, frame.depth_m, T_world_camera, timestamp_ns, blur_px);
}

RelocalisedPose Relocalisation::pose_of(const FoundPlace& found) const {
  return relocalised_pose(found, keyframes_[found.keyframe], rig_.T_imu_camera, config_.relocalisation);
}

std::optional<FoundPlace> Relocalisation::likely_one(const std::vector<FoundPlace>& candidates,
                                                     const filter::GaussianState& prediction) {
  std::vector<RelocalisedPose> poses;
  for (const FoundPlace& candidate : candidates) poses.push_back(pose_of(candidate));
  const std::optional<std::size_t> likeliest = odds_.decide(poses, prediction);
  return likeliest ? std::optional(candidates[*likeliest]) : std::nullopt;
}

/// Matches by features or, if these are insufficient, by depth alone.
std::optional<FoundPlace> Relocalisation::place_of(const RgbdFrame& frame, const UsableImages& usable,
                                                   const filter::GaussianState& prediction) {
  std::vector<FoundPlace> candidates;
  if (usable.grey) candidates = keyframes_.find(frame.grey);
  if (!usable.depth) return likely_one(candidates, prediction);
  const places::SmallImages small = places::small_images_of(frame.grey, frame.depth_m);
  if (candidates.empty()) {
    const SE3 T_world_camera = prediction.mean.T_world_imu * rig_.T_imu_camera;
    return likely_one(keyframes_.find_by_depth(small, T_world_camera, reach_m(prediction)), prediction);
  }
  for (FoundPlace& candidate : candidates)
    candidate = keyframes_.refined_by_depth(candidate, small).value_or(candidate);
  return likely_one(candidates, prediction);
}

std::optional<RelocalisedReference> Relocalisation::find(const RgbdFrame& frame, const UsableImages& usable,
                                                         const filter::GaussianState& prediction,
                                                         const tsdf::TsdfVolume& model,
                                                         const Workers& workers) {
  if (!config_.terms.relocalisation) return std::nullopt;
  const std::optional<FoundPlace> found = place_of(frame, usable, prediction);
  if (!found) return std::nullopt;
  const Keyframe& keyframe = keyframes_[found->keyframe];
  RelocalisedReference result;
  result.by_depth = found->inliers == 0;
  result.prior = relocalisation_update(prediction, pose_of(*found), unknown_motion(config_));
  if (!filter::is_valid(result.prior)) return std::nullopt;
  const int patch_levels = config_.patches.levels;
  const std::vector<GreyImage> pyramid = build_pyramid(
      keyframe.grey, alignment::pyramid_levels(rig_.camera, config_.patches.levels, config_.alignment));
  const DepthImage depth_m = keyframe.depth.unpacked_m();
  const patches::ReferenceFrame reference{std::span(pyramid).first(static_cast<std::size_t>(patch_levels)),
                                          depth_m, rig_.camera, keyframe.T_world_camera};
  result.reference.patches = patches::refresh_patches(
      reference, model, {}, {config_.patches, config_.depth, config_.terms.deformation}, workers);
  result.reference.points.take(pyramid, depth_m, rig_.camera, config_.alignment);
  result.reference.timestamp_ns = keyframe.timestamp_ns;
  return result;
}

}  // namespace fusebench::relocalisation
