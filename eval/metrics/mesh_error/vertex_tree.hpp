// Distances from points to vertices, as tools that know no surfaces measure them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"

namespace fusebench::mesh_error {

/// Finds the nearest of some points. Queries may run at once.
class VertexTree {
 public:
  /// At least one point, all finite. Copies them.
  explicit VertexTree(std::vector<Vector3d> points);
  ~VertexTree();
  VertexTree(const VertexTree&) = delete;
  VertexTree& operator=(const VertexTree&) = delete;

  struct Nearest {
    std::size_t index = 0;
    double squared_m2 = 0;
  };
  [[nodiscard]] Nearest nearest(const Vector3d& point) const;

  [[nodiscard]] const Vector3d& operator[](std::size_t index) const { return points_[index]; }

 private:
  struct Index;
  std::vector<Vector3d> points_;
  std::unique_ptr<Index> index_;
};

/// The score of SurfReg (the program that ICL-NUIM's authors publish, and that tables of ElasticFusion and
/// BundleFusion use): mean distance from the vertices of a reconstruction to the nearest vertex of the ground
/// truth. One direction only; depends on how densely both are meshed.
struct SurfregScore {
  double vertex_mean_m = 0;  ///< in the alignment that is given
  /// After ten steps of point-to-point ICP, which the program takes if the mean is below 5 cm; it prints the
  /// lesser of both. Absent if it would not, or if the steps have no solution.
  std::optional<double> after_icp_m;
};
[[nodiscard]] SurfregScore surfreg_score(std::span<const Vector3d> vertices_truth, const VertexTree& truth,
                                         const Workers& workers);

}  // namespace fusebench::mesh_error
