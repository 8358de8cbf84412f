// Triangles of a marching-cubes cell for each of the 256 sign patterns, derived from one rule.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace fusebench::meshing {

/// The twelve edges of a cell. Corners are numbered by bits (1: x, 2: y, 4: z); an edge runs from its corner
/// `from` along `axis`.
struct CellEdge {
  std::uint8_t from = 0;
  std::uint8_t axis = 0;
};
[[nodiscard]] const std::array<CellEdge, 12>& cell_edges();

/// Numbers of three edges, counter-clockwise from the positive side.
using CellTriangle = std::array<std::uint8_t, 3>;

/// Triangles by pattern (bit c set: corner c is inside, distance < 0).
///
/// Rule: on a face with alternating signs, the inside corners are separated. The rule depends on the face
/// alone, so both cells at a face agree and the surface has no cracks (Duerst 1988 describes the cracks of
/// other rules). No triangle has an inner edge in a face, where the neighbour could have the same edge. Each
/// edge of the surface therefore belongs to at most two triangles.
[[nodiscard]] const std::array<std::vector<CellTriangle>, 256>& cell_triangles();

}  // namespace fusebench::meshing
