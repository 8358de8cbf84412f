// Odometry frame and current frame (REP-105: odom and map). In the odometry frame poses are never corrected:
// a self-relocalised tracker continues in it at the pose predicted by the IMU, since the prediction error
// accumulated along the whole path and not only during the loss. The estimate is in the current frame, which
// moves with each relocalisation and each correction.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::loops {

/// A self-relocalisation to a place.
struct Relocalisation {
  std::size_t known = 0;  ///< index of the matched place
  SE3 T_known_camera;
  SE3 T_odometry_camera;  ///< predicted pose
  /// Covariances of the camera pose in the first camera frame, in its tangent.
  Matrix6d predicted_covariance = Matrix6d::Zero();
  Matrix6d found_covariance = Matrix6d::Zero();
};

/// A pose in the odometry frame with its covariance, as in Relocalisation.
struct OdometryPose {
  SE3 T_odometry_camera;
  Matrix6d covariance = Matrix6d::Zero();
};

class OdometryWorld {
 public:
  [[nodiscard]] const SE3& T_current_odometry() const { return T_current_odometry_; }

  /// Records a relocalisation to T_current_camera. `last`: the last earlier pose with a covariance.
  void relocalise(const Relocalisation& found, const SE3& T_current_camera, const OdometryPose& last);
  /// Moves the current frame.
  void correct(const SE3& T_corrected_odometry) { T_current_odometry_ = T_corrected_odometry; }

  /// Number of relocalisations.
  [[nodiscard]] std::size_t relocalisations() const { return found_.size(); }
  /// Relocalisation by number, from 1 on.
  [[nodiscard]] const Relocalisation& relocalisation(std::size_t number) const { return found_[number - 1]; }

  /// Pose in the current frame, for a pose that was added after the given number of relocalisations.
  [[nodiscard]] SE3 T_current_camera(const SE3& T_odometry_camera, std::size_t relocalisations) const;
  /// As T_current_camera(), but moved by relocalisations only.
  [[nodiscard]] SE3 T_relocalised_camera(const SE3& T_odometry_camera, std::size_t relocalisations) const;
  /// Covariance that dead reckoning in all losses so far adds to poses from now on.
  [[nodiscard]] Matrix6d lost_covariance_at(const SE3& T_odometry_camera) const;

 private:
  SE3 T_current_odometry_;
  std::vector<Relocalisation> found_;
  /// Indexed by the number of earlier relocalisations; without the corrections.
  std::vector<SE3> T_relocalised_odometry_{SE3{}};
  Matrix6d lost_covariance_ = Matrix6d::Zero();  ///< at the last relocalisation
};

}  // namespace fusebench::loops
