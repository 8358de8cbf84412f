#include "core/estimator/model/meshing/marching_cubes_table.hpp"

#include <cstddef>
#include <span>

#include "core/base/error.hpp"

namespace fusebench::meshing {
namespace {

constexpr std::uint8_t kNoEdge = 255;

bool inside(unsigned pattern, unsigned corner) { return ((pattern >> corner) & 1U) != 0; }

std::uint8_t edge_between(unsigned a, unsigned b) {
  const auto& edges = cell_edges();
  for (std::uint8_t e = 0; e < edges.size(); ++e) {
    const unsigned from = edges[e].from;
    const unsigned to = from | 1U << edges[e].axis;
    if ((from == a && to == b) || (from == b && to == a)) return e;
  }
  throw InternalError("two corners of a cell without an edge");
}

// The corners of a face, counter-clockwise from outside the cell.
std::array<unsigned, 4> face_corners(unsigned axis, bool upper) {
  const unsigned u = 1U << (axis + 1) % 3;
  const unsigned v = 1U << (axis + 2) % 3;
  const unsigned w = upper ? 1U << axis : 0U;
  if (upper) return {w, w | u, w | u | v, w | v};
  return {w, w | v, w | u | v, w | u};
}

// Traces the outline of the surface on the faces. Entry e: the crossed edge that follows edge e in the
// outline. On each face, an edge where the boundary enters the inside is followed by the next one where it
// leaves.
std::array<std::uint8_t, 12> outline(unsigned pattern) {
  std::array<std::uint8_t, 12> next{};
  next.fill(kNoEdge);
  for (unsigned face = 0; face < 6; ++face) {
    const std::array<unsigned, 4> corner = face_corners(face / 2, face % 2 == 1);
    for (std::size_t i = 0; i < 4; ++i) {
      if (inside(pattern, corner[i]) || !inside(pattern, corner[(i + 1) % 4])) continue;
      std::size_t j = i + 1;
      while (inside(pattern, corner[(j + 1) % 4])) ++j;
      next[edge_between(corner[i], corner[(i + 1) % 4])] = edge_between(corner[j % 4], corner[(j + 1) % 4]);
    }
  }
  return next;
}

bool share_a_face(std::uint8_t a, std::uint8_t b) {
  const auto corners = [](std::uint8_t e) {
    const CellEdge edge = cell_edges()[e];
    return std::array<unsigned, 2>{edge.from, edge.from | 1U << edge.axis};
  };
  for (unsigned axis = 0; axis < 3; ++axis) {
    unsigned ones = 0;
    for (const std::uint8_t e : {a, b}) {
      for (const unsigned corner : corners(e)) ones += (corner >> axis) & 1U;
    }
    if (ones == 0 || ones == 4) return true;
  }
  return false;
}

// Triangulates a polygon beyond the side (first, last) such that no inner edge is in a face, by trying all
// apexes.
bool triangulate(std::span<const std::uint8_t> polygon, std::vector<CellTriangle>& triangles) {
  if (polygon.size() < 3) return true;
  const std::size_t last = polygon.size() - 1;
  const std::size_t kept = triangles.size();
  for (std::size_t apex = 1; apex < last; ++apex) {
    if (apex > 1 && share_a_face(polygon[0], polygon[apex])) continue;
    if (apex < last - 1 && share_a_face(polygon[apex], polygon[last])) continue;
    triangles.push_back({polygon[0], polygon[apex], polygon[last]});
    if (triangulate(polygon.first(apex + 1), triangles) && triangulate(polygon.subspan(apex), triangles))
      return true;
    triangles.resize(kept);
  }
  return false;
}

std::vector<CellTriangle> triangles_of(unsigned pattern) {
  std::vector<CellTriangle> triangles;
  std::array<std::uint8_t, 12> next = outline(pattern);
  for (std::uint8_t start = 0; start < 12; ++start) {
    std::vector<std::uint8_t> polygon;
    for (std::uint8_t e = start; next[e] != kNoEdge;) {
      polygon.push_back(e);
      const std::uint8_t following = next[e];
      next[e] = kNoEdge;
      e = following;
    }
    check(triangulate(polygon, triangles), "each outline has a triangulation off the faces");
  }
  return triangles;
}

}  // namespace

const std::array<CellEdge, 12>& cell_edges() {
  static const std::array<CellEdge, 12> edges = [] {
    std::array<CellEdge, 12> result{};
    std::size_t count = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned corner = 0; corner < 8; ++corner) {
        if (((corner >> axis) & 1U) != 0) continue;
        result[count++] = {static_cast<std::uint8_t>(corner), static_cast<std::uint8_t>(axis)};
      }
    }
    return result;
  }();
  return edges;
}

const std::array<std::vector<CellTriangle>, 256>& cell_triangles() {
  static const std::array<std::vector<CellTriangle>, 256> table = [] {
    std::array<std::vector<CellTriangle>, 256> result;
    for (unsigned pattern = 0; pattern < 256; ++pattern) result[pattern] = triangles_of(pattern);
    return result;
  }();
  return table;
}

}  // namespace fusebench::meshing
