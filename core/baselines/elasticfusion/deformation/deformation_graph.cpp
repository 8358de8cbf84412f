#include "core/baselines/elasticfusion/deformation/deformation_graph.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/base/solvers.hpp"
#include "core/base/sparse_matrix.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

namespace {

constexpr std::size_t kFewestNodes = 5;
constexpr std::size_t kCandidates = 20;
constexpr std::size_t kNeighbours = 4;
constexpr int kMostSteps = 3;
constexpr double kSmallStep = 1e-6;
constexpr SparseIndex kUnknowns = 12;  // of a node: linear part by columns, then translation
const double kRootRegularity = std::sqrt(10.0);
constexpr double kRootConstraint = 10;
constexpr double kDamping = 1e-9;  // keeps unconstrained nodes unchanged

}  // namespace

/// Rows of a linear least-squares problem in the changes of the free nodes.
class DeformationGraph::Equations {
 public:
  explicit Equations(std::size_t first_free) : first_free_(static_cast<SparseIndex>(first_free)) {}

  void add(SparseIndex node, SparseIndex unknown, double value) {
    if (node < first_free_) return;
    entries_.emplace_back(rows_, (node - first_free_) * kUnknowns + unknown, value);
  }
  void end_row(double residual) {
    residuals_.push_back(residual);
    ++rows_;
  }

  [[nodiscard]] double energy() const {
    double sum = 0;
    for (const double residual : residuals_) sum += residual * residual;
    return sum;
  }

  /// The least-squares change; nothing if the equations are singular.
  [[nodiscard]] std::optional<Eigen::VectorXd> solve(std::size_t nodes) const {
    const auto unknowns = (static_cast<SparseIndex>(nodes) - first_free_) * kUnknowns;
    SparseMatrixd jacobian(rows_, unknowns);
    jacobian.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::Map<const Eigen::VectorXd> residuals(residuals_.data(), rows_);
    SparseMatrixd normal = jacobian.transpose() * jacobian;
    for (SparseIndex i = 0; i < unknowns; ++i) normal.coeffRef(i, i) += kDamping;
    const Eigen::SimplicialLDLT<SparseMatrixd> factor(normal);
    if (factor.info() != Eigen::Success) return std::nullopt;
    Eigen::VectorXd change = factor.solve(-(jacobian.transpose() * residuals));
    if (!change.allFinite()) return std::nullopt;
    return change;
  }

 private:
  SparseIndex first_free_;
  std::vector<Eigen::Triplet<double, SparseIndex>> entries_;
  std::vector<double> residuals_;
  SparseIndex rows_ = 0;
};

std::optional<DeformationGraph> DeformationGraph::make(std::span<const TimedPoint> nodes) {
  if (nodes.size() < kFewestNodes) return std::nullopt;
  DeformationGraph graph;
  graph.nodes_.assign(nodes.begin(), nodes.end());
  graph.motions_.resize(nodes.size());
  return graph;
}

/// The nearest four nodes in the order of time.
std::vector<std::size_t> DeformationGraph::neighbours_of(std::size_t node) const {
  const std::size_t first =
      std::min(node > kNeighbours / 2 ? node - kNeighbours / 2 : 0, nodes_.size() - kNeighbours - 1);
  std::vector<std::size_t> neighbours;
  for (std::size_t other = first; other <= first + kNeighbours; ++other) {
    if (other != node) neighbours.push_back(other);
  }
  return neighbours;
}

DeformationGraph::Influence DeformationGraph::influence_of(const TimedPoint& point) const {
  const auto at = static_cast<std::size_t>(
      std::ranges::lower_bound(nodes_, point.time, {}, &TimedPoint::time) - nodes_.begin());
  const std::size_t count = std::min(kCandidates, nodes_.size());
  const std::size_t first = std::min(at > kCandidates / 2 ? at - kCandidates / 2 : 0, nodes_.size() - count);
  std::array<std::pair<double, std::size_t>, kCandidates> candidates;
  for (std::size_t i = 0; i < count; ++i)
    candidates[i] = {(nodes_[first + i].position - point.position).norm(), first + i};
  std::partial_sort(candidates.begin(), candidates.begin() + kNeighbours + 1,
                    candidates.begin() + static_cast<std::ptrdiff_t>(count));
  Influence influence;
  const double reach_m = candidates[kNeighbours].first;
  double total = 0;
  for (std::size_t i = 0; i < kNeighbours; ++i) {
    influence.node[i] = candidates[i].second;
    const double left = reach_m > 0 ? 1 - candidates[i].first / reach_m : 1.0;
    influence.share[i] = left * left;
    total += influence.share[i];
  }
  // All five have equal distances: equal weights.
  for (double& share : influence.share) share = total > 0 ? share / total : 1.0 / kNeighbours;
  return influence;
}

Vector3d DeformationGraph::moved(const Vector3d& position, const Influence& influence) const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < kNeighbours; ++i) {
    const Vector3d& node = nodes_[influence.node[i]].position;
    const Motion& motion = motions_[influence.node[i]];
    sum += influence.share[i] * (motion.linear * (position - node) + node + motion.shift);
  }
  return sum;
}

Matrix3d DeformationGraph::linear(const Influence& influence) const {
  Matrix3d sum = Matrix3d::Zero();
  for (std::size_t i = 0; i < kNeighbours; ++i)
    sum += influence.share[i] * motions_[influence.node[i]].linear;
  return sum;
}

TimedPoint DeformationGraph::moved(const TimedPoint& point) const {
  return {moved(point.position, influence_of(point)), point.time};
}

SE3 DeformationGraph::moved(const SE3& T_world_camera, std::int32_t time) const {
  const Influence influence = influence_of({T_world_camera.translation, time});
  const Eigen::JacobiSVD<Matrix3d> svd(linear(influence), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  if (nearest.determinant() < 0) nearest = Matrix3d::Identity();  // a reflection cannot belong to a camera
  return {(Quaterniond(nearest) * T_world_camera.rotation).normalized(),
          moved(T_world_camera.translation, influence)};
}

double DeformationGraph::mean_error_m(std::span<const PointConstraint> constraints) const {
  if (constraints.empty()) return 0;
  double sum = 0;
  for (const PointConstraint& constraint : constraints) {
    const Vector3d target =
        constraint.target_moves ? moved(constraint.target).position : constraint.target.position;
    sum += (moved(constraint.source).position - target).norm();
  }
  return sum / static_cast<double>(constraints.size());
}

void DeformationGraph::add_terms(std::span<const PointConstraint> constraints, Equations& equations) const {
  constexpr std::array<std::pair<int, int>, 6> kProducts = {{{0, 1}, {0, 2}, {1, 2}, {0, 0}, {1, 1}, {2, 2}}};
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const auto node = static_cast<SparseIndex>(n);
    const Motion& motion = motions_[n];
    for (const auto& [a, b] : kProducts) {  // orthogonality and unit length of the columns of a rotation
      for (int i = 0; i < 3; ++i) {
        equations.add(node, 3 * a + i, motion.linear(i, b));
        equations.add(node, 3 * b + i, motion.linear(i, a));  // repeated entries are added
      }
      equations.end_row(motion.linear.col(a).dot(motion.linear.col(b)) - (a == b ? 1 : 0));
    }
    for (const std::size_t other : neighbours_of(n)) {
      const Vector3d apart = nodes_[other].position - nodes_[n].position;
      const Vector3d residual = motion.linear * apart + motion.shift - apart - motions_[other].shift;
      for (int i = 0; i < 3; ++i) {
        for (int column = 0; column < 3; ++column)
          equations.add(node, 3 * column + i, kRootRegularity * apart[column]);
        equations.add(node, 9 + i, kRootRegularity);
        equations.add(static_cast<SparseIndex>(other), 9 + i, -kRootRegularity);
        equations.end_row(kRootRegularity * residual[i]);
      }
    }
  }
  for (const PointConstraint& constraint : constraints) {
    const auto add_point = [&](const TimedPoint& point, const Influence& influence, int axis, double sign) {
      for (std::size_t i = 0; i < kNeighbours; ++i) {
        const auto node = static_cast<SparseIndex>(influence.node[i]);
        const double factor = sign * kRootConstraint * influence.share[i];
        const Vector3d arm = point.position - nodes_[influence.node[i]].position;
        for (int column = 0; column < 3; ++column)
          equations.add(node, 3 * column + axis, factor * arm[column]);
        equations.add(node, 9 + axis, factor);
      }
    };
    const Influence of_source = influence_of(constraint.source);
    const Influence of_target = influence_of(constraint.target);
    const Vector3d target =
        constraint.target_moves ? moved(constraint.target.position, of_target) : constraint.target.position;
    const Vector3d residual = moved(constraint.source.position, of_source) - target;
    for (int axis = 0; axis < 3; ++axis) {
      add_point(constraint.source, of_source, axis, 1);
      if (constraint.target_moves) add_point(constraint.target, of_target, axis, -1);
      equations.end_row(kRootConstraint * residual[axis]);
    }
  }
}

std::optional<DeformationResult> DeformationGraph::optimise(std::span<const PointConstraint> constraints,
                                                            std::int32_t fixed_until) {
  DeformationResult result;
  result.error_before_m = mean_error_m(constraints);
  const auto first_free = static_cast<std::size_t>(
      std::ranges::upper_bound(nodes_, fixed_until, {}, &TimedPoint::time) - nodes_.begin());
  for (int step = 0; step < kMostSteps && first_free < nodes_.size(); ++step) {
    Equations equations(first_free);
    add_terms(constraints, equations);
    const auto change = equations.solve(nodes_.size());
    if (!change) return std::nullopt;
    for (std::size_t n = first_free; n < nodes_.size(); ++n) {
      const auto first = static_cast<Eigen::Index>(n - first_free) * kUnknowns;
      motions_[n].linear += change->segment<9>(first).reshaped(3, 3);
      motions_[n].shift += change->segment<3>(first + 9);
    }
    if (change->norm() < kSmallStep) break;
  }
  Equations equations(first_free);
  add_terms(constraints, equations);
  result.energy = equations.energy();
  result.error_after_m = mean_error_m(constraints);
  return result;
}

}  // namespace fusebench::baselines::elasticfusion::deformation
