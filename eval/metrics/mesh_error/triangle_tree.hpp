// Exact distances to the surface of a mesh: a tree of boxes over its triangles, in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"

namespace fusebench::mesh_error {

/// The nearest point of a triangle (its inside, edges and corners; also of triangles without area).
[[nodiscard]] Vector3d closest_point_of_triangle(const Vector3d& point,
                                                 const std::array<Vector3d, 3>& corners);
[[nodiscard]] double squared_distance_to_triangle(const Vector3d& point,
                                                  const std::array<Vector3d, 3>& corners);

/// The nearest triangle and the squared distance to it.
struct NearestTriangle {
  double squared_m2 = std::numeric_limits<double>::infinity();
  std::uint32_t place = 0;  ///< of the triangle within its tree
};

/// Copies what it needs of the mesh. Queries may run at once and equal a search through all triangles.
class TriangleTree {
 public:
  /// Vertices finite, indices in range, at least one triangle.
  TriangleTree(const PreciseMesh& mesh, const Workers& workers);

  /// hint: the answer for a point nearby, which saves time and changes nothing else.
  [[nodiscard]] NearestTriangle nearest(const Vector3d& point, const NearestTriangle& hint = {}) const;

  /// Of a triangle that nearest() found: its point nearest to the given one, and its unit normal (zero of a
  /// triangle without area).
  [[nodiscard]] Vector3d closest_point(const Vector3d& point, std::uint32_t place) const;
  [[nodiscard]] Vector3d normal(std::uint32_t place) const;

  /// Whether a triangle crosses the straight line from one point to the other, from whichever side.
  [[nodiscard]] bool blocked(const Vector3d& from, const Vector3d& to) const;

 private:
  /// A box around the triangles below it, rounded outwards.
  struct Node {
    std::array<float, 3> low;
    std::array<float, 3> high;
    std::uint32_t first = 0;  ///< triangle of a leaf; right child otherwise (the left one comes next)
    std::uint32_t count = 0;  ///< triangles of a leaf; 0 otherwise
  };
  struct Builder;

  [[nodiscard]] std::array<Vector3d, 3> corners(std::uint32_t place) const {
    const auto& [i, j, k] = triangles_[place];
    return {vertices_[i], vertices_[j], vertices_[k]};
  }

  std::vector<Node> nodes_;
  std::vector<Vector3d> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;  ///< in the order of the leaves
};

}  // namespace fusebench::mesh_error
