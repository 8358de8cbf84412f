#include "core/estimator/places/loops/pose_graph.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include <array>

#include "core/base/geometry.hpp"
#include "core/base/solvers.hpp"
#include "core/estimator/smoother/manifolds.hpp"
#include "core/estimator/smoother/residuals.hpp"

namespace fusebench::loops {

namespace {

using smoother::as_rotation;
using smoother::as_vector;
using smoother::rotation_vector;
using smoother::Vector3;

/// W with W^T W = covariance^-1; nothing if the covariance is singular.
std::optional<Matrix6d> whitening_of(const Matrix6d& covariance) {
  const Eigen::LLT<Matrix6d> llt(covariance);
  if (llt.info() != Eigen::Success || !covariance.allFinite()) return std::nullopt;
  const Matrix6d lower = llt.matrixL();
  return Matrix6d(lower.inverse());
}

struct EdgeResidual {
  SE3 T_a_b;
  Matrix6d whitening;

  template <class T>
  bool operator()(const T* rotation_a, const T* position_a, const T* rotation_b, const T* position_b,
                  T* residual) const {
    const Eigen::Quaternion<T> R_world_a = as_rotation(rotation_a);
    const Eigen::Quaternion<T> R_a_b = R_world_a.conjugate() * as_rotation(rotation_b);
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() = rotation_vector<T>(T_a_b.rotation.conjugate().cast<T>() * R_a_b);
    const Vector3<T> apart = as_vector(position_b) - as_vector(position_a);
    error.template tail<3>() = R_world_a.conjugate() * apart - T_a_b.translation.cast<T>();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> whitened(residual);
    whitened = whitening.cast<T>() * error;
    return true;
  }
};

struct GravityResidual {
  Vector3d gravity_camera;
  double sigma_rad;

  template <class T>
  bool operator()(const T* rotation, const T* gravity_world, T* residual) const {
    const Vector3<T> here = as_rotation(rotation) * gravity_camera.cast<T>();
    Eigen::Map<Vector3<T>> whitened(residual);
    whitened = here.cross(Vector3<T>(as_vector(gravity_world))) / T(sigma_rad);
    return true;
  }
};

/// Mean of the gravity directions of all places, rotated by their poses.
Vector3d gravity_world_of(const PoseGraph& graph) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < graph.T_world_camera.size(); ++i) {
    if (graph.gravity_camera[i]) sum += graph.T_world_camera[i].rotation * *graph.gravity_camera[i];
  }
  return sum.norm() > 0 ? sum.normalized() : Vector3d(Vector3d::UnitY());
}

/// The least-squares problem with its unknowns and residuals.
class GraphProblem {
 public:
  /// search() starts from the given poses and gravity and updates them. Both must outlive the object.
  GraphProblem(const PoseGraph& graph, std::vector<SE3>& poses, Vector3d& gravity_world)
      : graph_(graph), poses_(poses), gravity_world_(gravity_world), problem_(borrowing_losses()) {
    add_poses();
    add_gravity();
  }

  /// Errors: a covariance is singular.
  Result<void> add_edges() {
    for (const GraphEdge& edge : graph_.edges) {
      const auto whitening = whitening_of(edge.covariance);
      if (!whitening)
        return fail(ErrorCode::run_failed, fmt::format("the covariance of the edge from place {} to {} is "
                                                       "singular",
                                                       edge.a, edge.b));
      SE3& a = poses_[edge.a];
      SE3& b = poses_[edge.b];
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<EdgeResidual, 6, 4, 3, 4, 3>(
                                    new EdgeResidual{edge.T_a_b, *whitening}),
                                edge.robust ? &loop_loss_ : nullptr, a.rotation.coeffs().data(),
                                a.translation.data(), b.rotation.coeffs().data(), b.translation.data());
    }
    return {};
  }

  /// robust_sigmas: scale of the Cauchy loss of loops. Errors: the search failed.
  Result<void> search(double robust_sigmas) {
    loop_loss_.Reset(new ceres::CauchyLoss(robust_sigmas), ceres::TAKE_OWNERSHIP);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.num_threads = 1;
    options.max_num_iterations = 50;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    if (!summary.IsSolutionUsable())
      return fail(ErrorCode::run_failed, "the graph of places cannot be optimised: " + summary.message);
    for (SE3& pose : poses_) pose.rotation.normalize();
    return {};
  }

 private:
  static ceres::Problem::Options borrowing_losses() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  void add_poses() {
    for (SE3& pose : poses_) {
      problem_.AddParameterBlock(pose.rotation.coeffs().data(), 4, new smoother::RotationManifold);
      problem_.AddParameterBlock(pose.translation.data(), 3);
    }
    problem_.SetParameterBlockConstant(poses_.front().rotation.coeffs().data());
    problem_.SetParameterBlockConstant(poses_.front().translation.data());
  }

  void add_gravity() {
    problem_.AddParameterBlock(gravity_world_.data(), 3, new smoother::DirectionManifold);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (!graph_.gravity_camera[i]) continue;
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<GravityResidual, 3, 4, 3>(
                                    new GravityResidual{*graph_.gravity_camera[i], graph_.gravity_sigma_rad}),
                                nullptr, poses_[i].rotation.coeffs().data(), gravity_world_.data());
    }
  }

  const PoseGraph& graph_;
  std::vector<SE3>& poses_;
  Vector3d& gravity_world_;
  ceres::LossFunctionWrapper loop_loss_{nullptr, ceres::TAKE_OWNERSHIP};  ///< shared by all loops
  ceres::Problem problem_;
};

}  // namespace

double squared_residual(const GraphEdge& edge, const std::vector<SE3>& T_world_camera) {
  const SE3 T_a_b = T_world_camera[edge.a].inverse() * T_world_camera[edge.b];
  const Vector6d error = pose_minus(T_a_b, edge.T_a_b);
  return error.dot(edge.covariance.ldlt().solve(error));
}

Result<std::vector<SE3>> optimised_poses(const PoseGraph& graph) {
  // The path has drifted, so the residual of a correct loop can be many of its standard deviations. The loss
  // starts wide and is narrowed step by step (graduated non-convexity; Blake & Zisserman 1987).
  constexpr std::array<double, 4> kRobustSigmas = {64, 16, 4, 1};
  std::vector<SE3> poses = graph.T_world_camera;
  if (poses.size() < 2) return poses;
  Vector3d gravity_world = gravity_world_of(graph);
  GraphProblem problem(graph, poses, gravity_world);
  if (auto added = problem.add_edges(); !added) return tl::unexpected(added.error());
  for (const double sigmas : kRobustSigmas) {
    if (auto solved = problem.search(sigmas); !solved) return tl::unexpected(solved.error());
  }
  return poses;
}

}  // namespace fusebench::loops
