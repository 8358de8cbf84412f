// Where the camera is: a frame's depth and intensities against a view of the model, coarse to fine (Whelan et
// al. 2015, Sec. 3.1 and 3.2; constants are the program's).
#pragma once

#include <optional>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/systems/elasticfusion/tracking/pyramids.hpp"

namespace fusebench::systems::elasticfusion::tracking {

/// What images say of a small motion d of points in the frame of the view's camera (rotation in rad, then
/// translation in m): information * d = descent. The weights of depth and intensities are not those of their
/// noise, so that `information` is in no unit; `scatter` is the covariance that the descent has by the mean
/// squares of the residuals, if those of all pixels are independent.
struct ImageEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d descent = Vector6d::Zero();
  Matrix6d scatter = Matrix6d::Zero();
};

struct TrackedMotion {
  SE3 T_view_camera;
  double matches = 0;        ///< of points with planes, on the finest level
  double error_m = 0;        ///< root of their summed squared distances, by their number
  ImageEquations images;     ///< of the last step
  bool was_dropped = false;  ///< a step of more than 0.3 m: the pose is that of the view

  /// The largest diagonal entry of the inverse of the normal equations; infinite if there is none.
  [[nodiscard]] double variance() const;
};

/// A term beside those of images.
class PoseTerm {
 public:
  PoseTerm() = default;
  PoseTerm(const PoseTerm&) = delete;
  PoseTerm& operator=(const PoseTerm&) = delete;
  virtual ~PoseTerm() = default;
  /// The step from a pose, by this term and the images.
  [[nodiscard]] virtual Vector6d step(const SE3& T_view_camera, const ImageEquations& images) const = 0;
};

class CameraTracker {
 public:
  /// The references must outlive it.
  CameraTracker(const config::ElasticfusionConfig& config, const Workers& workers)
      : config_(config), workers_(workers) {}

  /// 4, 5 and 10 steps on the levels, the finest one last; all are taken.
  [[nodiscard]] TrackedMotion track(const LivePyramid& live, const ViewPyramid& view, const SE3& T_view_start,
                                    const PoseTerm* term = nullptr) const;

 private:
  const config::ElasticfusionConfig& config_;
  const Workers& workers_;
};

}  // namespace fusebench::systems::elasticfusion::tracking
