#include "eval/metrics/mesh_error/vertex_tree.hpp"

#include <cmath>
#include <nanoflann.hpp>

#include "core/base/error.hpp"
#include "eval/metrics/trajectory_error/alignment.hpp"

namespace fusebench::mesh_error {

namespace {

constexpr std::size_t kVerticesPerChunk = 1024;

/// The points, in the words of nanoflann.
struct PointCloud {
  const std::vector<Vector3d>& points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;  // it finds the box itself
  }
};

struct Matches {
  std::vector<Vector3d> nearest;
  double mean_m = 0;
};

Matches match(std::span<const Vector3d> points, const VertexTree& tree, const Workers& workers) {
  Matches matches;
  matches.nearest.resize(points.size());
  std::vector<double> distances_m(points.size());
  workers.for_chunks(points.size(), kVerticesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const VertexTree::Nearest found = tree.nearest(points[i]);
      matches.nearest[i] = tree[found.index];
      distances_m[i] = std::sqrt(found.squared_m2);
    }
  });
  for (const double distance_m : distances_m) matches.mean_m += distance_m;
  matches.mean_m /= static_cast<double>(points.size());
  return matches;
}

}  // namespace

struct VertexTree::Index {
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointCloud>,
                                                   PointCloud, 3, std::size_t>;
  explicit Index(const std::vector<Vector3d>& points) : cloud{points}, tree(3, cloud) {}
  PointCloud cloud;
  Tree tree;
};

VertexTree::VertexTree(std::vector<Vector3d> points) : points_(std::move(points)) {
  check(!points_.empty(), "a tree has points");
  index_ = std::make_unique<Index>(points_);
}

VertexTree::~VertexTree() = default;

VertexTree::Nearest VertexTree::nearest(const Vector3d& point) const {
  Nearest nearest;
  index_->tree.knnSearch(point.data(), 1, &nearest.index, &nearest.squared_m2);
  return nearest;
}

SurfregScore surfreg_score(std::span<const Vector3d> vertices_truth, const VertexTree& truth,
                           const Workers& workers) {
  constexpr double kWorthIcp_m = 0.05;
  constexpr int kSteps = 10;
  SurfregScore score;
  Matches matches = match(vertices_truth, truth, workers);
  score.vertex_mean_m = matches.mean_m;
  if (!(score.vertex_mean_m < kWorthIcp_m)) return score;
  std::vector<Vector3d> moved(vertices_truth.begin(), vertices_truth.end());
  for (int step = 0; step < kSteps; ++step) {
    const auto closer = trajectory_error::align_positions(matches.nearest, moved, /*with_scale=*/false);
    if (!closer) return score;
    for (Vector3d& point : moved) point = *closer * point;
    matches = match(moved, truth, workers);
  }
  score.after_icp_m = matches.mean_m;
  return score;
}

}  // namespace fusebench::mesh_error
