// Camera tracking: registers depth and intensities of a frame with a view of the model, coarse to fine
// (Whelan et al. 2015, Secs. 3.1 and 3.2; constants of the published program).
#pragma once

#include <optional>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/baselines/elasticfusion/tracking/pyramids.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

/// Normal equations of the images for a small motion d of points in the view's camera frame (rotation in rad,
/// then translation in m): information * d = descent. The weights of depth and intensities are not those of
/// their noise, so `information` has no unit. `scatter`: covariance of the descent from the mean squared
/// residuals, for independent pixels.
struct ImageEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d descent = Vector6d::Zero();
  Matrix6d scatter = Matrix6d::Zero();
};

struct TrackedMotion {
  SE3 T_view_camera;
  double matches = 0;        ///< of points with planes, on the finest level
  double error_m = 0;        ///< sqrt(sum of squared distances) / number
  ImageEquations images;     ///< of the last step
  bool was_dropped = false;  ///< a step exceeded 0.3 m: the result is the pose of the view

  /// Largest diagonal entry of the inverse normal equations; infinite if they are singular.
  [[nodiscard]] double variance() const;
};

/// A term in addition to those of the images.
class PoseTerm {
 public:
  PoseTerm() = default;
  PoseTerm(const PoseTerm&) = delete;
  PoseTerm& operator=(const PoseTerm&) = delete;
  virtual ~PoseTerm() = default;
  /// Step from a pose by this term and the images.
  [[nodiscard]] virtual Vector6d step(const SE3& T_view_camera, const ImageEquations& images) const = 0;
};

class CameraTracker {
 public:
  /// The references must outlive it.
  CameraTracker(const config::ElasticfusionConfig& config, const Workers& workers)
      : config_(config), workers_(workers) {}

  /// Runs 4, 5 and 10 steps on the levels, finest level last, without an early end.
  [[nodiscard]] TrackedMotion track(const LivePyramid& live, const ViewPyramid& view, const SE3& T_view_start,
                                    const PoseTerm* term = nullptr) const;

 private:
  const config::ElasticfusionConfig& config_;
  const Workers& workers_;
};

}  // namespace fusebench::baselines::elasticfusion::tracking
