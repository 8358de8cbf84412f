#include "core/baselines/bundlefusion/pose_adjustment.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/base/sparse_matrix.hpp"
#include "core/baselines/bundlefusion/residuals.hpp"

namespace fusebench::baselines::bundlefusion {

namespace {

constexpr double kMaxDenseAngle_rad = radians(30);
constexpr double kMinDenseShare = 1.0 / 6.0;  // 800 of 80x60 cells
constexpr double kMaxLogMatches = 9;  // limit of ln n: the weight of n dense matches is 1 / min(ln n, 9)

using Solver = Eigen::SimplicialLDLT<SparseMatrixd, Eigen::Lower, Eigen::AMDOrdering<SparseIndex>>;

/// Two frames and their matches; nullptr if only depth is compared.
struct Term {
  std::size_t a = 0;
  std::size_t b = 0;
  const RigidMatches* rigid = nullptr;
};

/// Part of two poses in the normal equations.
struct PairEquations {
  Matrix6d aa = Matrix6d::Zero();
  Matrix6d ab = Matrix6d::Zero();
  Matrix6d bb = Matrix6d::Zero();
  Vector6d descent_a = Vector6d::Zero();
  Vector6d descent_b = Vector6d::Zero();
};

void add_points(const SE3& T_world_a, const SE3& T_world_b, const RigidMatches& rigid, double weight,
                PairEquations& equations) {
  for (const PointPair& points : rigid.points) {
    const PointResidual r = point_residual(T_world_a, T_world_b, points);
    equations.aa += weight * r.by_pose_a.transpose() * r.by_pose_a;
    equations.ab += weight * r.by_pose_a.transpose() * r.by_pose_b;
    equations.bb += weight * r.by_pose_b.transpose() * r.by_pose_b;
    equations.descent_a -= weight * r.by_pose_a.transpose() * r.value_m;
    equations.descent_b -= weight * r.by_pose_b.transpose() * r.value_m;
  }
}

void add_planes(const SE3& T_world_a, const SE3& T_world_b, const DepthCloud& a, const DepthCloud& b,
                const AdjustmentWeights& weights, PairEquations& equations) {
  if (rotation_angle_rad(T_world_a.rotation, T_world_b.rotation) >= kMaxDenseAngle_rad) return;
  const PlaneSums sums = plane_sums(a, b, T_world_a.inverse() * T_world_b, weights.dense_far_m);
  const auto matches = static_cast<double>(sums.matches);
  if (matches < kMinDenseShare * static_cast<double>(b.points.data.size())) return;
  const double weight = weights.dense / std::min(std::log(matches), kMaxLogMatches);
  const RelativeMotion motion = relative_motion(T_world_a, T_world_b);
  const Matrix6d information = weight * sums.information;
  const Vector6d descent = weight * sums.descent;
  equations.aa += motion.by_pose_a.transpose() * information * motion.by_pose_a;
  equations.ab += motion.by_pose_a.transpose() * information * motion.by_pose_b;
  equations.bb += motion.by_pose_b.transpose() * information * motion.by_pose_b;
  equations.descent_a += motion.by_pose_a.transpose() * descent;
  equations.descent_b += motion.by_pose_b.transpose() * descent;
}

/// A Gauss-Newton problem: its terms and the index of each pose among the unknowns.
class Adjustment {
 public:
  Adjustment(const Poses& poses, const AdjustmentTerms& terms) : terms_(terms), block_(poses.size(), -1) {
    int block = -1;  // -1: the first pose, which is fixed
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (poses[k]) block_[k] = block++;
    }
    blocks_ = std::max(0, block);
    for (const FramePair& pair : terms.pairs) {
      if (poses[pair.a] && poses[pair.b]) list_.push_back({pair.a, pair.b, &pair.rigid});
    }
    if (terms.weights.dense > 0) add_dense_terms(poses);
  }

  /// False if the equations are singular.
  bool step(Poses& poses, const Workers& workers) const {
    if (blocks_ == 0) return true;
    const auto parts = workers.map_chunks<PairEquations>(
        list_.size(), 1, [&](std::size_t i, std::size_t) { return equations_of(list_[i], poses); });
    std::vector<Eigen::Triplet<double, SparseIndex>> entries;
    Eigen::VectorXd descent = Eigen::VectorXd::Zero(6 * blocks_);
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const int a = block_[list_[i].a];
      const int b = block_[list_[i].b];
      add_block(a, a, parts[i].aa, entries);
      add_block(b, b, parts[i].bb, entries);
      add_block(a, b, parts[i].ab, entries);
      add_block(b, a, parts[i].ab.transpose(), entries);
      if (a >= 0) descent.segment<6>(6 * a) += parts[i].descent_a;
      if (b >= 0) descent.segment<6>(6 * b) += parts[i].descent_b;
    }
    SparseMatrixd information(6 * blocks_, 6 * blocks_);
    information.setFromTriplets(entries.begin(), entries.end());
    const Solver solver(information);
    if (solver.info() != Eigen::Success) return false;
    const Eigen::VectorXd tangent = solver.solve(descent);
    if (!tangent.allFinite()) return false;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (block_[k] >= 0) poses[k] = pose_plus(*poses[k], tangent.segment<6>(6 * block_[k]));
    }
    return true;
  }

 private:
  void add_dense_terms(const Poses& poses) {
    for (std::size_t b = 0; b < poses.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        if (poses[a] && poses[b]) list_.push_back({a, b, nullptr});
      }
    }
  }

  [[nodiscard]] PairEquations equations_of(const Term& term, const Poses& poses) const {
    PairEquations equations;
    const SE3& T_world_a = *poses[term.a];
    const SE3& T_world_b = *poses[term.b];
    if (term.rigid != nullptr) {
      add_points(T_world_a, T_world_b, *term.rigid, terms_.weights.sparse, equations);
    } else {
      add_planes(T_world_a, T_world_b, *terms_.clouds[term.a], *terms_.clouds[term.b], terms_.weights,
                 equations);
    }
    return equations;
  }

  /// Skips blocks of the first pose (-1).
  static void add_block(int row, int column, const Matrix6d& block,
                        std::vector<Eigen::Triplet<double, SparseIndex>>& entries) {
    if (row < 0 || column < 0) return;
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 6; ++i) entries.emplace_back(6 * row + i, 6 * column + j, block(i, j));
    }
  }

  const AdjustmentTerms& terms_;
  std::vector<int> block_;  ///< of each pose; -1: fixed or none
  int blocks_ = 0;
  std::vector<Term> list_;
};

}  // namespace

bool adjust_poses(Poses& T_world_camera, const AdjustmentTerms& terms, int steps, const Workers& workers) {
  const Adjustment adjustment(T_world_camera, terms);
  Poses adjusted = T_world_camera;
  for (int step = 0; step < steps; ++step) {
    if (!adjustment.step(adjusted, workers)) return false;
  }
  T_world_camera = std::move(adjusted);
  return true;
}

}  // namespace fusebench::baselines::bundlefusion
