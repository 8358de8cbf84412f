#include "core/estimator/alignment/image_alignment.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "core/config/groups/alignment_config.hpp"
#include "core/config/groups/residuals_config.hpp"

namespace fusebench::alignment {

namespace {

constexpr double kLeastDepth_m = 0.05;

/// Huber cost and weight of a whitened residual.
struct Robust {
  double cost = 0;
  double weight = 1;
};

Robust huber(double residual, double sigmas) {
  const double size = std::abs(residual);
  if (size <= sigmas) return {0.5 * residual * residual, 1.0};
  return {sigmas * (size - 0.5 * sigmas), sigmas / size};
}

}  // namespace

ImageAlignment::ImageAlignment(const config::AlignmentConfig& alignment,
                               const config::PhotometricConfig& photometric, const SensorRig& rig)
    : alignment_(alignment), photometric_(photometric), rig_(rig), brightness_prior_(photometric) {}

void ImageAlignment::observe(std::span<const GreyImage> pyramid, const ReferencePoints& reference,
                             const SE3& T_world_reference, int coarsest_level) {
  pyramid_ = pyramid;
  reference_ = &reference;
  T_world_reference_ = T_world_reference;
  coarsest_ = coarsest_level;
  light_ = {};
}

patches::PosedCamera ImageAlignment::posed(const filter::PoseHypothesis& poses) const {
  return {patches::camera_at_level(rig_.camera, level_), poses.T_world_imu_by_reference, rig_.T_imu_camera};
}

filter::MeasurementQuadratic ImageAlignment::linearise(const filter::PoseHypothesis& poses, int stage,
                                                       bool /*gate*/) {
  check(reference_ != nullptr, "an image is observed before it is aligned");
  level_ = coarsest_ - stage;
  const patches::PosedCamera camera = posed(poses);
  const GreyImage& image = pyramid_[static_cast<std::size_t>(level_)];
  const std::span<const ReferencePoint> points = reference_->level(level_);
  used_.assign(points.size(), 0);
  const double share = 1.0 / alignment_.pixels_per_measurement;
  const double per_noise = 1.0 / photometric_.noise_grey;
  filter::MeasurementQuadratic sum;
  filter::PoseQuadratic& pose = sum.by_reference;
  light_.information.setZero();
  light_.gradient.setZero();
  light_.by_pose.setZero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d in_camera = camera.to_camera(T_world_reference_ * points[i].point_camera);
    if (in_camera.z() < kLeastDepth_m) continue;
    const Vector2d pixel = camera.camera.project(in_camera);
    if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > image.width - 1 || pixel.y() > image.height - 1)
      continue;
    used_[i] = 1;
    const IntensitySample seen = sample_bilinear(image, pixel.x(), pixel.y());
    const double reference = points[i].intensity;
    const double residual = seen.value - (light_.value.x() * reference + light_.value.y());
    const Robust robust = huber(residual * per_noise, photometric_.huber_sigmas);
    const double weight = share * per_noise * per_noise * robust.weight;
    const Eigen::RowVector3d by_point =
        Eigen::RowVector2d(seen.dx, seen.dy) * camera.camera.projection_jacobian(in_camera);
    const Eigen::Matrix<double, 1, filter::kPoseSize> jacobian = camera.by_pose(by_point, in_camera);
    pose.information += weight * jacobian.transpose() * jacobian;
    pose.gradient += weight * residual * jacobian.transpose();
    pose.cost += share * robust.cost;
    const Vector2d by_light(-reference, -1.0);
    light_.information += weight * by_light * by_light.transpose();
    light_.gradient += weight * residual * by_light;
    light_.by_pose += weight * by_light * jacobian;
  }
  brightness_prior_.eliminate(light_, pose);
  return sum;
}

double ImageAlignment::seen_share() const {
  if (used_.empty()) return 0;
  return static_cast<double>(std::ranges::count(used_, 1)) / static_cast<double>(used_.size());
}

double ImageAlignment::trial_cost(const filter::PoseHypothesis& poses, const filter::TangentVector& step,
                                  double fraction) {
  light_.try_step(step.head<filter::kPoseSize>(), fraction);
  const patches::PosedCamera camera = posed(poses);
  const GreyImage& image = pyramid_[static_cast<std::size_t>(level_)];
  const std::span<const ReferencePoint> points = reference_->level(level_);
  const double per_noise = 1.0 / photometric_.noise_grey;
  double cost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (used_[i] == 0) continue;
    Vector3d in_camera = camera.to_camera(T_world_reference_ * points[i].point_camera);
    in_camera.z() = std::max(in_camera.z(), kLeastDepth_m);
    // A point that leaves the image must not lower the cost, so the nearest border pixel is used.
    const Vector2d pixel = camera.camera.project(in_camera);
    const IntensitySample seen = sample_bilinear(image, std::clamp(pixel.x(), 0.0, image.width - 1.0),
                                                 std::clamp(pixel.y(), 0.0, image.height - 1.0));
    const double residual = seen.value - (light_.trial.x() * points[i].intensity + light_.trial.y());
    cost += huber(residual * per_noise, photometric_.huber_sigmas).cost;
  }
  return cost / alignment_.pixels_per_measurement + brightness_prior_.cost(light_.trial);
}

}  // namespace fusebench::alignment
