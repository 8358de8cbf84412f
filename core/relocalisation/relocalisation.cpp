#include "core/relocalisation/relocalisation.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>

#include "core/config/config.hpp"
#include "core/filter/pose_clones.hpp"
#include "core/filter/state_validity.hpp"

namespace fusebench::relocalisation {

namespace {

/// The pose of the camera as the filter wants it: of the IMU.
RelocalisedPose relocalised_pose(const FoundPlace& found, const Keyframe& keyframe, const SE3& T_imu_camera,
                                 const config::RelocalisationConfig& config) {
  const SE3 T_camera_imu = T_imu_camera.inverse();
  RelocalisedPose pose{found.T_world_camera * T_camera_imu, keyframe.T_world_camera * T_camera_imu};
  const Matrix6d to_imu = filter::pose_transport(pose.T_world_imu, found.T_world_camera);
  pose.covariance = to_imu * found.covariance * to_imu.transpose();
  // Drift of the model since the keyframe was fused into it.
  const double rotation_rad = config.keyframe_rotation_sigma_rad;
  const double position_m = config.keyframe_position_sigma_m;
  pose.reference_covariance.diagonal() << Vector3d::Constant(rotation_rad * rotation_rad),
      Vector3d::Constant(position_m * position_m);
  return pose;
}

double position_sigma_m(const filter::GaussianState& prediction) {
  return largest_sigma(prediction.covariance.block<3, 3>(filter::kPosition, filter::kPosition));
}

/// How far off a predicted camera sees a surface at some distance.
double reach_m(const filter::GaussianState& prediction) {
  constexpr double kSigmas = 2;
  constexpr double kDistance_m = 2;
  constexpr double kLargest_m = 0.5;  // beyond, surfaces are taken for one another
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
    : config_(config),
      rig_(rig),
      keyframes_(rig.camera, config),
      refused_(config.relocalisation, config.loops, config.terms, config.initialisation),
      rivals_(config.relocalisation) {}

void Relocalisation::add_keyframe(const RgbdFrame& frame, const SE3& T_world_camera,
                                  std::int64_t timestamp_ns, double blur_px) {
  if (!config_.terms.relocalisation) return;
  rivals_.clear();
  keyframes_.offer(frame.grey, frame.depth_m, T_world_camera, timestamp_ns, blur_px);
}

RelocalisedPose Relocalisation::pose_of(const FoundPlace& found) const {
  return relocalised_pose(found, keyframes_[found.keyframe], rig_.T_imu_camera, config_.relocalisation);
}

/// Those within these limits of the prediction.
std::vector<FoundPlace> Relocalisation::allowed_places(const std::vector<FoundPlace>& places,
                                                       const filter::GaussianState& prediction,
                                                       const Limits& limits) const {
  // Repeating texture gives false poses: one that is inconsistent with the predicted motion is refused. The
  // gates widen with the covariance while the tracker is lost. What repeats, as the doors of a corridor, is
  // found with all certainty in frame after frame, so that where the camera can be always decides. Written so
  // that NaN is refused as well.
  std::vector<FoundPlace> allowed;
  std::ranges::copy_if(places, std::back_inserter(allowed), [&](const FoundPlace& place) {
    const RelocalisedPose pose = pose_of(place);
    return rotation_angle_rad(pose.T_world_imu.rotation, prediction.mean.T_world_imu.rotation) <=
               limits.rotation_rad &&
           normalised_position_innovation(prediction, pose) <=
               config_.relocalisation.max_position_innovation &&
           normalised_innovation(prediction, pose) <= limits.innovation;
  });
  return allowed;
}

/// The place if the frames before found the same: where the prediction rules it out, or does not tell places
/// apart. What features found is verified by depth.
std::optional<FoundPlace> Relocalisation::supported(const FoundPlace& found, const RgbdFrame& frame,
                                                    const filter::GaussianState& prediction) {
  refused_.add({frame.timestamp_ns, pose_of(found), prediction.mean.T_world_imu});
  if (!refused_.are_enough()) return std::nullopt;
  if (found.inliers == 0) return found;
  return keyframes_.verified_by_depth(found, places::small_images_of(frame.grey, frame.depth_m));
}

std::optional<FoundPlace> Relocalisation::place_of(const RgbdFrame& frame, const UsableImages& usable,
                                                   const filter::GaussianState& prediction) {
  const SE3 T_world_camera = prediction.mean.T_world_imu * rig_.T_imu_camera;
  const PredictedPosition predicted{T_world_camera.translation, position_sigma_m(prediction)};
  const config::RelocalisationConfig& config = config_.relocalisation;
  const bool places_are_told_apart = predicted.sigma_m <= config.max_unsupported_position_sigma_m;
  const Limits likely{config.max_innovation, std::numeric_limits<double>::infinity()};
  // A filter may rule a place out because it was wrong before it was lost.
  const Limits conceivable{config.max_supported_innovation, radians(config.max_supported_rotation_deg)};
  std::vector<FoundPlace> places;
  if (usable.grey) places = keyframes_.find(frame.grey);
  rivals_.observe(frame.timestamp_ns, places);
  std::vector<FoundPlace> allowed = allowed_places(places, prediction, likely);
  const bool is_likely = !allowed.empty();
  if (!is_likely && usable.depth) allowed = allowed_places(places, prediction, conceivable);
  if (!allowed.empty()) {
    if (!rivals_.is_only_one(frame.timestamp_ns, allowed, predicted)) return std::nullopt;
    if (is_likely && places_are_told_apart) return allowed.front();
    if (usable.depth) {
      if (const auto found = supported(allowed.front(), frame, prediction)) return found;
    }
    if (!places_are_told_apart) return std::nullopt;
  }
  if (!usable.depth) return std::nullopt;
  places = keyframes_.find_by_depth(places::small_images_of(frame.grey, frame.depth_m), T_world_camera,
                                    reach_m(prediction));
  rivals_.observe(frame.timestamp_ns, places);
  allowed = allowed_places(places, prediction, likely);
  if (allowed.empty() || !rivals_.is_only_one(frame.timestamp_ns, allowed, predicted)) return std::nullopt;
  if (places_are_told_apart) return allowed.front();
  return supported(allowed.front(), frame, prediction);
}

std::optional<RelocalisedReference> Relocalisation::find(const RgbdFrame& frame, const UsableImages& usable,
                                                         const filter::GaussianState& prediction,
                                                         const tsdf::TsdfVolume& model,
                                                         const Workers& workers) {
  if (!config_.terms.relocalisation) return std::nullopt;
  const std::optional<FoundPlace> found = place_of(frame, usable, prediction);
  if (!found) return std::nullopt;
  refused_.clear();
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
