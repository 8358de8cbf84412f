#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/trajectory/trajectory.hpp"
#include "core/base/upper_median.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::synthetic_imu {

namespace {

// Quaternions in the order of the solver, (w, x, y, z).
template <class T>
using Q = std::array<T, 4>;
template <class T>
using V = std::array<T, 3>;

template <class T>
V<T> turn_between(const T* from, const T* to) {
  const Q<T> inverse{from[0], -from[1], -from[2], -from[3]};
  Q<T> relative;
  ceres::QuaternionProduct(inverse.data(), to, relative.data());
  V<T> turn;
  ceres::QuaternionToAngleAxis(relative.data(), turn.data());  // shorter rotation, for any sign
  return turn;
}

/// Measured minus spline orientation at one time, in units of the outlier threshold.
struct RotationResidual {
  CumulativeBasis basis;
  Q<double> measured;
  double weight;

  template <class T>
  bool operator()(const T* c0, const T* c1, const T* c2, const T* c3, T* residual) const {
    const std::array<const T*, 4> control{c0, c1, c2, c3};
    Q<T> rotation{c0[0], c0[1], c0[2], c0[3]};
    for (std::size_t j = 0; j < 3; ++j) {
      V<T> turn = turn_between(control[j], control[j + 1]);
      for (T& component : turn) component *= basis.weight[j];
      Q<T> factor;
      Q<T> product;
      ceres::AngleAxisToQuaternion(turn.data(), factor.data());
      ceres::QuaternionProduct(rotation.data(), factor.data(), product.data());
      rotation = product;
    }
    const Q<T> target{T(measured[0]), T(measured[1]), T(measured[2]), T(measured[3])};
    const V<T> error = turn_between(target.data(), rotation.data());
    for (std::size_t i = 0; i < 3; ++i) residual[i] = weight * error[i];
    return true;
  }
};

/// Integral of |x''|^2 over one segment, as two residuals per axis. x'' is linear there, from a to b, so the
/// integral is h ((a + b)^2 / 4 + (a - b)^2 / 12). a and b are second differences of control points; the
/// weight contains the other factors.
template <class T>
void integral_residuals(const T& a, const T& b, double weight, T* residual) {
  residual[0] = 0.5 * weight * (a + b);
  residual[1] = weight / std::sqrt(12.0) * (a - b);
}

struct RotationSmoothness {
  double weight;

  template <class T>
  bool operator()(const T* c0, const T* c1, const T* c2, const T* c3, T* residual) const {
    const V<T> first = turn_between(c0, c1);
    const V<T> second = turn_between(c1, c2);
    const V<T> third = turn_between(c2, c3);
    for (std::size_t i = 0; i < 3; ++i) {
      integral_residuals<T>(second[i] - first[i], third[i] - second[i], weight, residual + 2 * i);
    }
    return true;
  }
};

struct PositionResidual {
  CumulativeBasis basis;
  Vector3d measured;
  double weight;

  template <class T>
  bool operator()(const T* c0, const T* c1, const T* c2, const T* c3, T* residual) const {
    for (int i = 0; i < 3; ++i) {
      const T position = c0[i] + basis.weight[0] * (c1[i] - c0[i]) + basis.weight[1] * (c2[i] - c1[i]) +
                         basis.weight[2] * (c3[i] - c2[i]);
      residual[i] = weight * (position - measured[i]);
    }
    return true;
  }
};

struct PositionSmoothness {
  double weight;

  template <class T>
  bool operator()(const T* c0, const T* c1, const T* c2, const T* c3, T* residual) const {
    for (int i = 0; i < 3; ++i) {
      integral_residuals<T>(c2[i] - 2.0 * c1[i] + c0[i], c3[i] - 2.0 * c2[i] + c1[i], weight,
                            residual + 2 * i);
    }
    return true;
  }
};

Result<void> check_options(const SplineFitOptions& options) {
  struct Range {
    std::string_view name;
    double value;
    double low;
    double high;
  };
  for (const Range& r : {Range{"knot_spacing_s", options.knot_spacing_s, 0.001, 1.0},
                         Range{"cutoff_hz", options.cutoff_hz, 0.1, 1000.0},
                         Range{"outlier_rotation_rad", options.outlier_rotation_rad, 1e-6, 10.0},
                         Range{"outlier_position_m", options.outlier_position_m, 1e-6, 10.0}}) {
    if (!(r.value >= r.low && r.value <= r.high)) {
      return fail(ErrorCode::configuration,
                  fmt::format("{} = {} (allowed {} .. {})", r.name, r.value, r.low, r.high));
    }
  }
  return {};
}

double median_spacing_s(const Trajectory& truth) {
  std::vector<std::int64_t> spacing;
  for (std::size_t i = 1; i < truth.size(); ++i)
    spacing.push_back(truth[i].timestamp_ns - truth[i - 1].timestamp_ns);
  return seconds_between(0, upper_median(std::move(spacing)));
}

/// Weight of a second difference of control points whose sum of squares is the integral of the
/// regularisation. At a knot x'' = (c0 - 2 c1 + c2) / spacing^2, and the integral is the sum over knots times
/// the spacing.
double smoothness_weight(const SplineFitOptions& options, double truth_spacing_s) {
  const double omega = 2 * std::numbers::pi * options.cutoff_hz;
  const double h = options.knot_spacing_s;
  return std::sqrt(h / truth_spacing_s) / (omega * omega * h * h);
}

PoseSpline initial_spline(const Trajectory& truth, const SplineFitOptions& options) {
  const std::int64_t first_ns = truth.front().timestamp_ns;
  const std::int64_t last_ns = truth.back().timestamp_ns;
  PoseSpline spline(first_ns, last_ns, std::llround(1e9 * options.knot_spacing_s));
  for (std::size_t i = 0; i < spline.position_world_m.size(); ++i) {
    const std::int64_t time_ns = std::clamp(spline.control_time_ns(i), first_ns, last_ns);
    const SE3 pose = *trajectory::interpolate_pose(truth, time_ns, last_ns - first_ns);
    spline.position_world_m[i] = pose.translation;
    spline.rotation_world_body[i] = pose.rotation;
  }
  return spline;
}

bool solve(ceres::Problem& problem) {
  ceres::Solver::Options options;
  options.num_threads = 1;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Eigen's factorisation, since a BLAS selects kernels, and so the last bits, by the processor.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-8;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.termination_type == ceres::CONVERGENCE;
}

bool fit_rotation(const Trajectory& truth, const SplineFitOptions& options, double smoothness,
                  PoseSpline& spline) {
  std::vector<Q<double>> control;
  for (const Quaterniond& q : spline.rotation_world_body) control.push_back({q.w(), q.x(), q.y(), q.z()});
  ceres::Problem problem;
  for (Q<double>& c : control) problem.AddParameterBlock(c.data(), 4, new ceres::QuaternionManifold);
  const double weight = 1.0 / options.outlier_rotation_rad;
  for (const StampedPose& pose : truth) {
    const SplinePlace at = spline.place(pose.timestamp_ns);
    const Quaterniond& q = pose.T_world_camera.rotation;
    Q<double>* c = &control[at.segment];
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<RotationResidual, 3, 4, 4, 4, 4>(
                                 new RotationResidual{at.basis, {q.w(), q.x(), q.y(), q.z()}, weight}),
                             new ceres::HuberLoss(1.0), c[0].data(), c[1].data(), c[2].data(), c[3].data());
  }
  for (std::size_t i = 0; i + 3 < control.size(); ++i) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<RotationSmoothness, 6, 4, 4, 4, 4>(
                                 new RotationSmoothness{weight * smoothness}),
                             nullptr, control[i].data(), control[i + 1].data(), control[i + 2].data(),
                             control[i + 3].data());
  }
  const bool converged = solve(problem);
  for (std::size_t i = 0; i < control.size(); ++i) {
    const Q<double>& c = control[i];
    spline.rotation_world_body[i] = Quaterniond(c[0], c[1], c[2], c[3]).normalized();
  }
  return converged;
}

bool fit_position(const Trajectory& truth, const SplineFitOptions& options, double smoothness,
                  PoseSpline& spline) {
  // The origin of the world may be far away; differences of large numbers would lose digits.
  const Vector3d origin = truth.front().T_world_camera.translation;
  std::vector<Vector3d>& control = spline.position_world_m;
  for (Vector3d& c : control) c -= origin;
  ceres::Problem problem;
  const double weight = 1.0 / options.outlier_position_m;
  for (const StampedPose& pose : truth) {
    const SplinePlace at = spline.place(pose.timestamp_ns);
    Vector3d* c = &control[at.segment];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PositionResidual, 3, 3, 3, 3, 3>(
            new PositionResidual{at.basis, pose.T_world_camera.translation - origin, weight}),
        new ceres::HuberLoss(1.0), c[0].data(), c[1].data(), c[2].data(), c[3].data());
  }
  for (std::size_t i = 0; i + 3 < control.size(); ++i) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PositionSmoothness, 6, 3, 3, 3, 3>(
                                 new PositionSmoothness{weight * smoothness}),
                             nullptr, control[i].data(), control[i + 1].data(), control[i + 2].data(),
                             control[i + 3].data());
  }
  const bool converged = solve(problem);
  for (Vector3d& c : control) c += origin;
  return converged;
}

void measure_residuals(const Trajectory& truth, SplineFit& fit) {
  double rotation = 0;
  double position = 0;
  for (const StampedPose& pose : truth) {
    const SE3 fitted = fit.spline.evaluate(pose.timestamp_ns).T_world_body;
    rotation += so3_log(fitted.rotation.conjugate() * pose.T_world_camera.rotation).squaredNorm();
    position += (fitted.translation - pose.T_world_camera.translation).squaredNorm();
  }
  const double axes = 3.0 * static_cast<double>(truth.size());
  fit.rotation_residual_rad = std::sqrt(rotation / axes);
  fit.position_residual_m = std::sqrt(position / axes);
}

}  // namespace

Result<SplineFit> fit_pose_spline(const Trajectory& truth, const SplineFitOptions& options) {
  if (const auto valid = check_options(options); !valid) return tl::unexpected(valid.error());
  if (truth.size() < 4) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("a trajectory of {} poses is too short for a spline", truth.size()),
                "at least 4 poses are needed");
  }
  const double smoothness = smoothness_weight(options, median_spacing_s(truth));
  SplineFit fit{initial_spline(truth, options)};
  const bool rotation_converged = fit_rotation(truth, options, smoothness, fit.spline);
  const bool position_converged = fit_position(truth, options, smoothness, fit.spline);
  fit.converged = rotation_converged && position_converged;
  measure_residuals(truth, fit);
  if (!std::isfinite(fit.rotation_residual_rad) || !std::isfinite(fit.position_residual_m)) {
    return fail(ErrorCode::data_corrupt, "the spline fit to the ground truth failed",
                "check the poses for jumps");
  }
  return fit;
}

}  // namespace fusebench::synthetic_imu
