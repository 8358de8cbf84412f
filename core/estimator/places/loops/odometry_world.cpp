#include "core/estimator/places/loops/odometry_world.hpp"

#include "core/base/solvers.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "core/estimator/places/loops/loop_edges.hpp"

namespace fusebench::loops {

void OdometryWorld::relocalise(const Relocalisation& found, const SE3& T_current_camera,
                               const OdometryPose& last) {
  // Moves the current frame relative to the odometry frame, which continues as predicted.
  const SE3 T_corrected_relocalised = T_current_odometry_ * T_relocalised_odometry_.back().inverse();
  T_current_odometry_ = T_current_camera * found.T_odometry_camera.inverse();
  T_relocalised_odometry_.push_back(T_corrected_relocalised.inverse() * T_current_odometry_);
  const Matrix6d carried = filter::pose_transport(found.T_odometry_camera, last.T_odometry_camera);
  lost_covariance_ =
      lost_covariance_at(found.T_odometry_camera) +
      not_negative(found.predicted_covariance - carried * last.covariance * carried.transpose());
  found_.push_back(found);
}

SE3 OdometryWorld::T_current_camera(const SE3& T_odometry_camera, std::size_t relocalisations) const {
  if (relocalisations == found_.size()) return T_current_odometry_ * T_odometry_camera;
  const SE3 T_corrected_relocalised = T_current_odometry_ * T_relocalised_odometry_.back().inverse();
  return T_corrected_relocalised * T_relocalised_odometry_[relocalisations] * T_odometry_camera;
}

SE3 OdometryWorld::T_relocalised_camera(const SE3& T_odometry_camera, std::size_t relocalisations) const {
  return relocalisations == 0 ? T_odometry_camera
                              : T_relocalised_odometry_[relocalisations] * T_odometry_camera;
}

Matrix6d OdometryWorld::lost_covariance_at(const SE3& T_odometry_camera) const {
  if (found_.empty()) return Matrix6d::Zero();
  const Matrix6d carried = filter::pose_transport(T_odometry_camera, found_.back().T_odometry_camera);
  return carried * lost_covariance_ * carried.transpose();
}

}  // namespace fusebench::loops
