#include "eval/metrics/mesh_error/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/error.hpp"

namespace fusebench::mesh_error {

namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr std::uint32_t kSmallestPart =
    16'384;  ///< triangles; larger parts are halved before they are shared out
constexpr std::size_t kQueriesPerChunk = 4096;
constexpr int kDeepest = 64;  ///< halving 2^32 triangles takes 32 levels

Vector3d closest_point_of_edge(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d edge = b - a;
  const double length2 = edge.squaredNorm();
  const double along = length2 > 0 ? std::clamp((point - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
  return a + along * edge;
}

/// The foot of a point on the plane of a triangle a, b, c is a + v (b - a) + w (c - a).
struct Foot {
  double v = 0;
  double w = 0;
};

/// By the normal equations, whose error grows with the inverse square of the smallest angle's sine.
Foot foot_on(const Vector3d& from_a, const Vector3d& ab, const Vector3d& ac, double determinant) {
  const double along_ab = ab.dot(from_a);
  const double along_ac = ac.dot(from_a);
  return {(ac.squaredNorm() * along_ab - ab.dot(ac) * along_ac) / determinant,
          (ab.squaredNorm() * along_ac - ab.dot(ac) * along_ab) / determinant};
}

/// Of a sliver: with the height over ab orthogonalised twice, the error of the foot within the triangle stays
/// at that of the corners. ab is the longest side.
Foot foot_on_sliver(const Vector3d& from_a, const Vector3d& ab, const Vector3d& ac) {
  const double length2 = ab.squaredNorm();
  if (length2 == 0) return {};
  const double apex = ac.dot(ab) / length2;
  Vector3d height = ac - apex * ab;
  height -= height.dot(ab) / length2 * ab;
  const double height2 = height.squaredNorm();
  const double w = height2 > 0 ? from_a.dot(height) / height2 : 0.0;
  return {from_a.dot(ab) / length2 - w * apex, w};
}

Vector3d closest_point(const Vector3d& point, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                       const Foot& foot) {
  // What is nearest in a convex figure lies on a side that is seen from the point.
  const bool beyond_ac = foot.v < 0;
  const bool beyond_ab = foot.w < 0;
  const bool beyond_bc = foot.v + foot.w > 1;
  if (!beyond_ac && !beyond_ab && !beyond_bc) return a + foot.v * (b - a) + foot.w * (c - a);
  Vector3d best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](bool seen, const Vector3d& from, const Vector3d& to) {
    if (!seen) return;
    const Vector3d candidate = closest_point_of_edge(point, from, to);
    const double squared = (point - candidate).squaredNorm();
    if (squared >= least) return;
    best = candidate;
    least = squared;
  };
  consider(beyond_ab, a, b);
  consider(beyond_bc, b, c);
  consider(beyond_ac, c, a);
  return best;
}

/// Its longest side first, and whatever rounding does to its height: never worse than its sides.
Vector3d closest_point_of_sliver(const Vector3d& point, std::array<Vector3d, 3> corners) {
  const auto length2 = [&](std::size_t i) { return (corners[(i + 1) % 3] - corners[i]).squaredNorm(); };
  const std::size_t longest =
      length2(0) >= length2(1) ? (length2(0) >= length2(2) ? 0 : 2) : (length2(1) >= length2(2) ? 1 : 2);
  std::ranges::rotate(corners, corners.begin() + static_cast<std::ptrdiff_t>(longest));
  const auto& [a, b, c] = corners;
  Vector3d best = closest_point(point, a, b, c, foot_on_sliver(point - a, b - a, c - a));
  for (const Vector3d& other : {closest_point_of_edge(point, a, b), closest_point_of_edge(point, b, c),
                                closest_point_of_edge(point, c, a)}) {
    if ((point - other).squaredNorm() < (point - best).squaredNorm()) best = other;
  }
  return best;
}

}  // namespace

Vector3d closest_point_of_triangle(const Vector3d& point, const std::array<Vector3d, 3>& corners) {
  constexpr double kSliver = 1e-4;  // squared sine of an angle
  const auto& [a, b, c] = corners;
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const double sides = ab.squaredNorm() * ac.squaredNorm();
  const double determinant = sides - ab.dot(ac) * ab.dot(ac);
  // Written so that a triangle without sides is a sliver.
  if (!(determinant > kSliver * sides)) return closest_point_of_sliver(point, corners);
  return closest_point(point, a, b, c, foot_on(point - a, ab, ac, determinant));
}

double squared_distance_to_triangle(const Vector3d& point, const std::array<Vector3d, 3>& corners) {
  return (point - closest_point_of_triangle(point, corners)).squaredNorm();
}

/// Halves the triangles at the median of their centres along the longest side of these. Where each node comes
/// to lie follows from the number of triangles, so parts of the tree can be built at once.
struct TriangleTree::Builder {
  struct Item {
    Eigen::Vector3f center;
    std::uint32_t triangle = 0;
  };
  struct Part {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t node = 0;
  };

  const PreciseMesh& mesh;
  std::vector<Node>& nodes;
  std::vector<Item> items;
  std::map<std::uint32_t, std::uint32_t> sizes = {};  ///< nodes of a tree of so many triangles

  Builder(const PreciseMesh& of, std::vector<Node>& into, const Workers& workers)
      : mesh(of), nodes(into), items(of.triangles.size()) {
    workers.for_chunks(items.size(), kQueriesPerChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const auto& [i, j, k] = mesh.triangles[t];
        const Vector3d center = (mesh.vertices[i] + mesh.vertices[j] + mesh.vertices[k]) / 3;
        items[t] = {center.cast<float>(), static_cast<std::uint32_t>(t)};
      }
    });
    nodes.resize(size_of(static_cast<std::uint32_t>(items.size())));
  }

  std::uint32_t size_of(std::uint32_t triangles) {
    if (triangles <= kLeafSize) return 1;
    if (const auto known = sizes.find(triangles); known != sizes.end()) return known->second;
    const std::uint32_t half = triangles / 2;
    return sizes[triangles] = 1 + size_of(half) + size_of(triangles - half);
  }

  void build(const Workers& workers) {
    std::vector<Part> inner;  // parents before their children
    std::vector<Part> parts = {{0, static_cast<std::uint32_t>(items.size()), 0}};
    for (std::size_t at = 0; at < parts.size();) {
      const Part part = parts[at];
      if (part.end - part.begin <= kSmallestPart) {
        ++at;
        continue;
      }
      const auto [left, right] = halves(part);
      inner.push_back(part);
      parts[at] = left;
      parts.push_back(right);
    }
    workers.for_chunks(parts.size(), 1, [&](std::size_t begin, std::size_t) { build(parts[begin]); });
    for (std::size_t k = inner.size(); k > 0; --k) enclose_children(inner[k - 1]);
  }

  void build(const Part& part) {
    if (part.end - part.begin <= kLeafSize) {
      enclose_triangles(part);
      return;
    }
    const auto [left, right] = halves(part);
    build(left);
    build(right);
    enclose_children(part);
  }

  /// Brings the items into order about their median.
  std::pair<Part, Part> halves(const Part& part) {
    Eigen::AlignedBox3f box;
    for (std::uint32_t at = part.begin; at < part.end; ++at) box.extend(items[at].center);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::uint32_t half = (part.end - part.begin) / 2;
    const std::uint32_t middle = part.begin + half;
    // Equal centres are told apart by number, so that the tree is the same with any library.
    std::nth_element(items.begin() + part.begin, items.begin() + middle, items.begin() + part.end,
                     [axis](const Item& a, const Item& b) {
                       return std::pair(a.center[axis], a.triangle) < std::pair(b.center[axis], b.triangle);
                     });
    const std::uint32_t right = part.node + 1 + (half <= kLeafSize ? 1 : sizes.at(half));
    return {{part.begin, middle, part.node + 1}, {middle, part.end, right}};
  }

  void enclose_triangles(const Part& part) {
    Eigen::AlignedBox3d box;
    for (std::uint32_t at = part.begin; at < part.end; ++at) {
      for (const std::uint32_t vertex : mesh.triangles[items[at].triangle]) box.extend(mesh.vertices[vertex]);
    }
    Node& node = nodes[part.node];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.low[axis] = rounded_down(box.min()[static_cast<Eigen::Index>(axis)]);
      node.high[axis] = -rounded_down(-box.max()[static_cast<Eigen::Index>(axis)]);
    }
    node.first = part.begin;
    node.count = part.end - part.begin;
  }

  void enclose_children(const Part& part) {
    Node& node = nodes[part.node];
    const std::uint32_t half = (part.end - part.begin) / 2;
    node.first = part.node + 1 + (half <= kLeafSize ? 1 : sizes.at(half));
    const Node& left = nodes[part.node + 1];
    const Node& right = nodes[node.first];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.low[axis] = std::min(left.low[axis], right.low[axis]);
      node.high[axis] = std::max(left.high[axis], right.high[axis]);
    }
  }

  static float rounded_down(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) <= value
               ? nearest
               : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
  }
};

TriangleTree::TriangleTree(const PreciseMesh& mesh, const Workers& workers) : vertices_(mesh.vertices) {
  check(!mesh.triangles.empty(), "a tree has triangles");
  Builder builder(mesh, nodes_, workers);
  builder.build(workers);
  triangles_.resize(builder.items.size());
  workers.for_chunks(triangles_.size(), kQueriesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at) triangles_[at] = mesh.triangles[builder.items[at].triangle];
  });
}

Vector3d TriangleTree::closest_point(const Vector3d& point, std::uint32_t place) const {
  return closest_point_of_triangle(point, corners(place));
}

Vector3d TriangleTree::normal(std::uint32_t place) const {
  const auto [a, b, c] = corners(place);
  return (b - a).cross(c - a).stableNormalized();
}

NearestTriangle TriangleTree::nearest(const Vector3d& point, const NearestTriangle& hint) const {
  NearestTriangle best;
  if (hint.place < triangles_.size()) {
    best = {squared_distance_to_triangle(point, corners(hint.place)), hint.place};
  }
  const auto box_distance = [&](const Node& node) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = point[static_cast<Eigen::Index>(axis)];
      const double outside = std::max({node.low[axis] - x, x - node.high[axis], 0.0});
      sum += outside * outside;
    }
    return sum;
  };
  struct Waiting {
    std::uint32_t node;
    double squared_m2;
  };
  std::array<Waiting, kDeepest> stack;
  int waiting = 0;
  stack[static_cast<std::size_t>(waiting++)] = {0, box_distance(nodes_[0])};
  while (waiting > 0) {
    const Waiting at = stack[static_cast<std::size_t>(--waiting)];
    if (at.squared_m2 >= best.squared_m2) continue;
    const Node& node = nodes_[at.node];
    for (std::uint32_t place = node.first; place < node.first + node.count; ++place) {
      const double squared_m2 = squared_distance_to_triangle(point, corners(place));
      if (squared_m2 < best.squared_m2) best = {squared_m2, place};
    }
    if (node.count > 0) continue;
    Waiting near{at.node + 1, box_distance(nodes_[at.node + 1])};
    Waiting far{node.first, box_distance(nodes_[node.first])};
    if (far.squared_m2 < near.squared_m2) std::swap(near, far);
    if (far.squared_m2 < best.squared_m2) stack[static_cast<std::size_t>(waiting++)] = far;
    if (near.squared_m2 < best.squared_m2) stack[static_cast<std::size_t>(waiting++)] = near;
  }
  return best;
}

bool TriangleTree::blocked(const Vector3d& from, const Vector3d& to) const {
  const Vector3d direction = to - from;
  const Vector3d inverse = direction.cwiseInverse();
  const auto passes = [&](const Node& node) {
    double enter = 0;
    double leave = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      // A line within the plane of a side gives NaN, which leaves the bounds alone.
      const double a = (node.low[axis] - from[i]) * inverse[i];
      const double b = (node.high[axis] - from[i]) * inverse[i];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
  };
  const auto crosses = [&](const std::array<Vector3d, 3>& t) {  // Moeller and Trumbore, 1997
    const Vector3d edge1 = t[1] - t[0];
    const Vector3d edge2 = t[2] - t[0];
    const Vector3d p = direction.cross(edge2);
    const double determinant = edge1.dot(p);
    if (determinant == 0) return false;
    const Vector3d s = from - t[0];
    const double u = s.dot(p) / determinant;
    const Vector3d q = s.cross(edge1);
    const double v = direction.dot(q) / determinant;
    const double along = edge2.dot(q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && along >= 0 && along <= 1;
  };
  std::array<std::uint32_t, kDeepest> stack;
  int waiting = 0;
  stack[static_cast<std::size_t>(waiting++)] = 0;
  while (waiting > 0) {
    const std::uint32_t index = stack[static_cast<std::size_t>(--waiting)];
    const Node& node = nodes_[index];
    if (!passes(node)) continue;
    for (std::uint32_t place = node.first; place < node.first + node.count; ++place) {
      if (crosses(corners(place))) return true;
    }
    if (node.count > 0) continue;
    stack[static_cast<std::size_t>(waiting++)] = node.first;
    stack[static_cast<std::size_t>(waiting++)] = index + 1;
  }
  return false;
}

}  // namespace fusebench::mesh_error
