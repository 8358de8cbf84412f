// Where the camera is: a frame's depth and intensities against a view of the model, coarse to fine (Whelan et
// al. 2015, Sec. 3.1 and 3.2; constants are the program's).
#pragma once

#include <optional>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/config.hpp"
#include "core/systems/elasticfusion/tracking/pyramids.hpp"

namespace fusebench::systems::elasticfusion::tracking {

struct TrackedMotion {
  SE3 T_view_camera;
  double matches = 0;                           ///< of points with planes, on the finest level
  double error_m = 0;                           ///< root of their summed squared distances, by their number
  Matrix6d information = Matrix6d::Identity();  ///< of the last normal equations
  bool was_dropped = false;                     ///< a step of more than 0.3 m: the pose is that of the view

  /// The largest diagonal entry of the inverse of the normal equations; infinite if there is none.
  [[nodiscard]] double variance() const;
};

/// A term beside those of images: adds to the normal equations at a pose. Steps move points in the frame of
/// the view's camera (rotation, then translation).
class PoseTerm {
 public:
  PoseTerm() = default;
  PoseTerm(const PoseTerm&) = delete;
  PoseTerm& operator=(const PoseTerm&) = delete;
  virtual ~PoseTerm() = default;
  virtual void add(const SE3& T_view_camera, Matrix6d& information, Vector6d& descent) const = 0;
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
