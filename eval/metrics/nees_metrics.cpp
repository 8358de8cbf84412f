#include "eval/metrics/nees_metrics.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/types.hpp"

namespace fusebench::metrics {

namespace {

constexpr std::int64_t kMaxGap_ns = 100'000'000;

// Of the correlation matrix, so that units do not matter. Below this, a direction is known exactly for all
// that double precision says of it.
constexpr double kSmallestEigenvalue = 1e-10;

/// The same state seen from another world.
filter::FilterState moved(filter::FilterState state, const SE3& T_to_from) {
  state.T_world_imu = T_to_from * state.T_world_imu;
  state.velocity_world_mps = T_to_from.rotation * state.velocity_world_mps;
  return state;
}

/// Regularised lower incomplete gamma function P(a, x): its series below a + 1, and Lentz's continued
/// fraction of 1 - P above (Press et al., Numerical Recipes, 6.2).
double lower_gamma(double a, double x) {
  if (x <= 0) return 0;
  const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  constexpr int kMostTerms = 100'000;
  constexpr double kEpsilon = 1e-15;
  if (x < a + 1) {
    double term = 1 / a;
    double sum = term;
    for (int n = 1; n < kMostTerms && term > kEpsilon * sum; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return front * sum;
  }
  constexpr double kTiny = 1e-300;
  double b = x + 1 - a;
  double c = 1 / kTiny;
  double d = 1 / b;
  double fraction = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1 / d;
    fraction *= d * c;
    if (std::abs(d * c - 1) < kEpsilon) break;
  }
  return 1 - front * fraction;
}

}  // namespace

std::optional<filter::FilterState> interpolate_state(std::span<const filter::StampedState> states,
                                                     std::int64_t timestamp_ns) {
  const auto after = std::ranges::lower_bound(states, timestamp_ns, {}, &filter::StampedState::timestamp_ns);
  if (after == states.end()) return std::nullopt;
  if (after->timestamp_ns == timestamp_ns) return after->state;
  if (after == states.begin()) return std::nullopt;
  const auto base = after - 1;
  const auto close = [](const filter::StampedState& a, const filter::StampedState& b) {
    return b.timestamp_ns - a.timestamp_ns <= kMaxGap_ns;
  };
  if (!close(*base, *after)) return std::nullopt;
  const auto begin = base != states.begin() && close(*(base - 1), *base) ? base - 1 : base;
  const auto end = after + 1 != states.end() && close(*after, *(after + 1)) ? after + 2 : after + 1;

  // Lagrange's polynomial through the differences from the state just before, whose own is zero.
  filter::StateVector step = filter::StateVector::Zero();
  for (auto node = begin; node != end; ++node) {
    if (node == base) continue;
    double weight = 1;
    for (auto other = begin; other != end; ++other) {
      if (other == node) continue;
      weight *= seconds_between(other->timestamp_ns, timestamp_ns) /
                seconds_between(other->timestamp_ns, node->timestamp_ns);
    }
    step += weight * filter::minus(node->state, base->state);
  }
  return filter::plus(base->state, step);
}

std::optional<double> normalised_error_squared(const filter::StateVector& error,
                                               const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                               const StatePart& part) {
  const Eigen::MatrixXd block = covariance.block(part.offset, part.offset, part.dof, part.dof);
  const Eigen::VectorXd sigma = block.diagonal().cwiseSqrt();
  if (!block.allFinite() || !(sigma.minCoeff() > 0)) return std::nullopt;
  const Eigen::VectorXd scale = sigma.cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * block * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  if (!(eigen.eigenvalues().minCoeff() > kSmallestEigenvalue)) return std::nullopt;
  const Eigen::VectorXd scaled = scale.cwiseProduct(error.segment(part.offset, part.dof));
  const double squared = scaled.dot(correlation.ldlt().solve(scaled));
  return std::isfinite(squared) ? std::optional(squared) : std::nullopt;
}

std::vector<filter::StampedState> states_of_camera(std::span<const filter::StampedState> states,
                                                   const SE3& T_imu_camera) {
  std::vector<filter::StampedState> moved(states.begin(), states.end());
  for (filter::StampedState& at : moved) at.state.T_world_imu = at.state.T_world_imu * T_imu_camera;
  for (std::size_t i = 0; i < moved.size() && moved.size() > 1; ++i) {
    const filter::StampedState& before = moved[i > 0 ? i - 1 : 0];
    const filter::StampedState& after = moved[std::min(i + 1, moved.size() - 1)];
    moved[i].state.velocity_world_mps =
        (after.state.T_world_imu.translation - before.state.T_world_imu.translation) /
        seconds_between(before.timestamp_ns, after.timestamp_ns);
  }
  return moved;
}

Result<ConsistencyResult> consistency(std::span<const filter::StampedState> truth,
                                      std::span<const filter::StampedEstimate> estimates,
                                      const SE3& T_imu_camera) {
  if (estimates.empty()) return fail(ErrorCode::data_corrupt, "there are no estimates");
  const auto first = interpolate_state(truth, estimates.front().timestamp_ns);
  if (!first) {
    return fail(
        ErrorCode::data_corrupt,
        "no true states lie around the first frame within 0.1 s, so the ground truth cannot be moved into "
        "the world of the estimate");
  }
  const SE3 T_world_truth = (first->T_world_imu * T_imu_camera).inverse();
  ConsistencyResult result;
  for (std::size_t i = 0; i < kStateParts.size(); ++i) result[i].part = kStateParts[i];
  for (const filter::StampedEstimate& at : estimates.subspan(1)) {
    const auto true_state = interpolate_state(truth, at.timestamp_ns);
    if (!true_state) continue;
    const filter::StateVector error = filter::minus(moved(*true_state, T_world_truth), at.mean);
    for (NeesResult& part : result) {
      ++part.possible;
      const auto squared = normalised_error_squared(error, at.covariance, part.part);
      if (!squared) continue;
      part.nees_per_dof.push_back(*squared / part.part.dof);
      part.at_ns.push_back(at.timestamp_ns);
    }
  }
  if (result[0].possible == 0) {
    return fail(ErrorCode::data_corrupt, "no frame after the first has true states around it within 0.1 s");
  }
  for (NeesResult& part : result) {
    part.stats = statistics(part.nees_per_dof);
    if (!part.nees_per_dof.empty()) part.last = part.nees_per_dof.back();
  }
  return result;
}

double chi_square_quantile(double probability, double dof) {
  check(probability > 0 && probability < 1 && dof >= 1, "a quantile has a probability and a distribution");
  const auto below = [&](double x) { return lower_gamma(dof / 2, x / 2) < probability; };
  double low = 0;
  double high = dof;
  while (below(high)) high *= 2;
  while (high - low > 1e-13 * high) {
    const double middle = 0.5 * (low + high);
    (below(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

NeesBounds nees_bounds_95(std::size_t runs, int dof) {
  const double all = static_cast<double>(runs) * dof;
  return {chi_square_quantile(0.025, all) / all, chi_square_quantile(0.975, all) / all};
}

}  // namespace fusebench::metrics
