// Bends space: a graph of affine motions, embedded in the model by time and place (Sumner et al., "Embedded
// Deformation for Shape Manipulation", 2007; Whelan et al. 2015, Sec. 4).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::systems::elasticfusion::deformation {

/// A point of the world and the frame that it is of.
struct TimedPoint {
  Vector3d position = Vector3d::Zero();  ///< metres
  std::int32_t time = 0;
};

/// A point that has to come to another place. The place moves with the graph too if it is a point of it.
struct PointConstraint {
  TimedPoint source;
  TimedPoint target;
  bool target_moves = false;
};

/// What an optimisation has come to.
struct DeformationResult {
  double error_before_m = 0;  ///< mean distance of constraints
  double error_after_m = 0;
  double energy = 0;  ///< the weighted sum of all terms
};

class DeformationGraph {
 public:
  /// Nodes at these points, sorted by time, which do nothing yet. Nothing if there are fewer than five.
  [[nodiscard]] static std::optional<DeformationGraph> make(std::span<const TimedPoint> nodes);

  /// The four nearest nodes of the twenty around the point's time, and how much each counts: (1 - d / m)^2,
  /// where m is the distance of the fifth, in shares of 1.
  struct Influence {
    std::array<std::size_t, 4> node{};
    std::array<double, 4> share{};
  };
  [[nodiscard]] Influence influence_of(const TimedPoint& point) const;

  /// Finds the motions of least energy: 1 of rotations that are none, 10 of neighbours (by time) that move
  /// apart, 100 of constraints; at most three steps of Gauss-Newton. Nodes of frames up to `fixed_until` stay
  /// where they are. Nothing if the equations have no solution.
  [[nodiscard]] std::optional<DeformationResult> optimise(std::span<const PointConstraint> constraints,
                                                          std::int32_t fixed_until = -1);

  [[nodiscard]] Vector3d moved(const Vector3d& position, const Influence& influence) const;
  /// The blended linear part there.
  [[nodiscard]] Matrix3d linear(const Influence& influence) const;
  [[nodiscard]] TimedPoint moved(const TimedPoint& point) const;
  /// A camera's pose of this time.
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

}  // namespace fusebench::systems::elasticfusion::deformation
