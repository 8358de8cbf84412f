// Triangles of one cell of marching cubes for each of the 256 patterns of signs, derived from one rule.
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

/// Three numbers of edges, counter-clockwise seen from the positive side.
using CellTriangle = std::array<std::uint8_t, 3>;

/// Triangles by pattern (bit c set: corner c is inside, distance < 0).
///
/// Rule: on a face whose signs alternate, the inside corners are cut off one by one. It looks at the face
/// alone, so the two cells at a face always agree and the surface has no cracks (Duerst 1988 describes what
/// happens otherwise). No triangle has an inner edge that lies in a face, where the neighbour could repeat
/// it, so that each edge of the surface belongs to at most two triangles.
[[nodiscard]] const std::array<std::vector<CellTriangle>, 256>& cell_triangles();

}  // namespace fusebench::meshing
