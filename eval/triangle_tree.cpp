#include "eval/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.hpp"

namespace fusebench {

namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr int kDeepest = 64;  ///< halving 2^32 triangles takes 32 levels

double squared_distance_to_edge(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d edge = b - a;
  const double length2 = edge.squaredNorm();
  const double along = length2 > 0 ? std::clamp((point - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
  return (point - a - along * edge).squaredNorm();
}

}  // namespace

double squared_distance_to_triangle(const Vector3d& point, const std::array<Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vector3d normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  const auto left_of = [&](const Vector3d& from, const Vector3d& to) {
    return normal.cross(to - from).dot(point - from) >= 0;
  };
  if (area2 > 0 && left_of(a, b) && left_of(b, c) && left_of(c, a)) {
    const double height = normal.dot(point - a);
    return height * height / area2;
  }
  return std::min({squared_distance_to_edge(point, a, b), squared_distance_to_edge(point, b, c),
                   squared_distance_to_edge(point, c, a)});
}

/// Halves the triangles at the median of their centres along the longest side of these.
struct TriangleTree::Builder {
  const Mesh& mesh;
  std::vector<std::uint32_t> order;
  std::vector<Eigen::Vector3f> centers;
  std::vector<Node>& nodes;

  Builder(const Mesh& of, std::vector<Node>& into) : mesh(of), order(of.triangles.size()), nodes(into) {
    std::iota(order.begin(), order.end(), 0U);
    for (const auto& [i, j, k] : mesh.triangles) {
      centers.push_back((mesh.vertices[i] + mesh.vertices[j] + mesh.vertices[k]) / 3);
    }
  }

  void build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t index = nodes.size();
    nodes.emplace_back();
    Eigen::AlignedBox3f box;
    Eigen::AlignedBox3f center_box;
    for (std::uint32_t at = begin; at < end; ++at) {
      for (const std::uint32_t vertex : mesh.triangles[order[at]]) box.extend(mesh.vertices[vertex]);
      center_box.extend(centers[order[at]]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      nodes[index].low[static_cast<std::size_t>(axis)] = box.min()[axis];
      nodes[index].high[static_cast<std::size_t>(axis)] = box.max()[axis];
    }
    if (end - begin <= kLeafSize) {
      nodes[index].first = begin;
      nodes[index].count = end - begin;
      return;
    }
    int axis = 0;
    center_box.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    // Equal centres are told apart by index, so that the tree is the same with any library.
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return std::pair(centers[a][axis], a) < std::pair(centers[b][axis], b);
                     });
    build(begin, middle);
    nodes[index].first = static_cast<std::uint32_t>(nodes.size());
    build(middle, end);
  }
};

TriangleTree::TriangleTree(const Mesh& mesh) {
  check(!mesh.triangles.empty(), "a tree has triangles");
  Builder builder(mesh, nodes_);
  builder.build(0, static_cast<std::uint32_t>(mesh.triangles.size()));
  triangles_.reserve(mesh.triangles.size());
  for (const std::uint32_t index : builder.order) {
    const auto& [i, j, k] = mesh.triangles[index];
    triangles_.push_back({mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]});
  }
}

std::array<Vector3d, 3> TriangleTree::corners(std::uint32_t place) const {
  const Corners& of = triangles_[place];
  return {of[0].cast<double>(), of[1].cast<double>(), of[2].cast<double>()};
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

}  // namespace fusebench
