// Two worlds. That of the odometry is as if nothing was ever corrected: a lost tracker that finds itself by a
// place goes on in it as the IMU carried it, since what the prediction was off by came on along the whole
// path since that place, and not where the tracker was lost. The estimate is in the current one, which moves
// with each relocalisation and with each correction.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::loops {

/// A lost tracker found itself by a place.
struct Relocalisation {
  std::size_t known = 0;  ///< the place, by index
  SE3 T_known_camera;
  SE3 T_odometry_camera;  ///< as predicted
  /// Of the camera's pose in the world of the first camera, in its tangent.
  Matrix6d predicted_covariance = Matrix6d::Zero();
  Matrix6d found_covariance = Matrix6d::Zero();
};

/// A pose of the odometry with its covariance, as in Relocalisation.
struct OdometryPose {
  SE3 T_odometry_camera;
  Matrix6d covariance = Matrix6d::Zero();
};

class OdometryWorld {
 public:
  [[nodiscard]] const SE3& T_current_odometry() const { return T_current_odometry_; }

  /// The estimate found itself at T_current_camera; `last` is the last pose before whose covariance is known.
  void relocalise(const Relocalisation& found, const SE3& T_current_camera, const OdometryPose& last);
  /// All of the current world moves.
  void correct(const SE3& T_corrected_odometry) { T_current_odometry_ = T_corrected_odometry; }

  /// How often the tracker was lost and found so far.
  [[nodiscard]] std::size_t relocalisations() const { return found_.size(); }
  /// The one with that number, from 1 on.
  [[nodiscard]] const Relocalisation& relocalisation(std::size_t number) const { return found_[number - 1]; }

  /// In the current world, of a pose that was added after so many relocalisations.
  [[nodiscard]] SE3 T_current_camera(const SE3& T_odometry_camera, std::size_t relocalisations) const;
  /// The same as if nothing but relocalisations had moved that world.
  [[nodiscard]] SE3 T_relocalised_camera(const SE3& T_odometry_camera, std::size_t relocalisations) const;
  /// What dead reckoning added to the covariance of poses from now on, in all times that the tracker was
  /// lost.
  [[nodiscard]] Matrix6d lost_covariance_at(const SE3& T_odometry_camera) const;

 private:
  SE3 T_current_odometry_;
  std::vector<Relocalisation> found_;
  /// By the number of relocalisations before: of that world, what is no correction.
  std::vector<SE3> T_relocalised_odometry_{SE3{}};
  Matrix6d lost_covariance_ = Matrix6d::Zero();  ///< at the last relocalisation
};

}  // namespace fusebench::loops
