// A deformation graph of affine motions, embedded in the model by time and position (Sumner et al., "Embedded
// Deformation for Shape Manipulation", 2007; Whelan et al. 2015, Sec. 4).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

/// A world point and the frame of its observation.
struct TimedPoint {
  Vector3d position = Vector3d::Zero();  ///< metres
  std::int32_t time = 0;
};

/// A point with a target position. If the target is a TimedPoint, it moves with the graph too.
struct PointConstraint {
  TimedPoint source;
  TimedPoint target;
  bool target_moves = false;
};

/// Result of an optimisation.
struct DeformationResult {
  double error_before_m = 0;  ///< mean distance of constraints
  double error_after_m = 0;
  double energy = 0;  ///< weighted sum of all terms
};

class DeformationGraph {
 public:
  /// Creates identity nodes at these points, sorted by time. Nothing if there are fewer than five.
  [[nodiscard]] static std::optional<DeformationGraph> make(std::span<const TimedPoint> nodes);

  /// The four nearest nodes among the twenty around the time of the point, with normalised weights (1 - d /
  /// m)^2, where m is the distance of the fifth.
  struct Influence {
    std::array<std::size_t, 4> node{};
    std::array<double, 4> share{};
  };
  [[nodiscard]] Influence influence_of(const TimedPoint& point) const;

  /// Minimises the energy: weight 1 for deviations from a rotation, 10 for differences between neighbours (by
  /// time), 100 for constraints; at most three Gauss-Newton steps. Nodes of frames up to `fixed_until` are
  /// fixed. Nothing if the equations are singular.
  [[nodiscard]] std::optional<DeformationResult> optimise(std::span<const PointConstraint> constraints,
                                                          std::int32_t fixed_until = -1);

  [[nodiscard]] Vector3d moved(const Vector3d& position, const Influence& influence) const;
  /// The blended linear part.
  [[nodiscard]] Matrix3d linear(const Influence& influence) const;
  [[nodiscard]] TimedPoint moved(const TimedPoint& point) const;
  /// Deformed pose of a camera at this time.
  [[nodiscard]] SE3 moved(const SE3& T_world_camera, std::int32_t time) const;

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

 private:
  class Equations;
  struct Motion {
    Matrix3d linear = Matrix3d::Identity();
    Vector3d shift = Vector3d::Zero();
  };

  [[nodiscard]] std::vector<std::size_t> neighbours_of(std::size_t node) const;
  [[nodiscard]] double mean_error_m(std::span<const PointConstraint> constraints) const;
  void add_terms(std::span<const PointConstraint> constraints, Equations& equations) const;

  std::vector<TimedPoint> nodes_;
  std::vector<Motion> motions_;
};

}  // namespace fusebench::baselines::elasticfusion::deformation
