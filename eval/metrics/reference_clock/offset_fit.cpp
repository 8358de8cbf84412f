#include "eval/metrics/reference_clock/offset_fit.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/upper_median.hpp"
#include "eval/metrics/reference_clock/correlated_variance.hpp"

namespace fusebench::reference_clock {

namespace {

constexpr std::int64_t kStep_ns = 20'000'000;
constexpr std::size_t kMostCompared = 400;
constexpr std::size_t kFewestCompared = 30;

/// Weights that bound the influence of jumps of the estimate to that of a motion three times the median.
std::vector<double> bounded_weights(std::span<const MotionPair> pairs, const MotionSigmas& sigmas) {
  constexpr double kLarge = 3;
  std::vector<double> sizes;
  for (const MotionPair& pair : pairs) {
    sizes.push_back(std::hypot(so3_log(pair.estimated.rotation).norm() / sigmas.rotation_rad,
                               pair.estimated.translation.norm() / sigmas.translation_m));
  }
  const double large = kLarge * upper_median(sizes);
  for (double& size : sizes) size = size <= large ? 1.0 : large / size;
  return sizes;
}

OffsetCandidate candidate_at(double offset_s, std::span<const MotionPair> pairs) {
  const MotionSigmas sigmas;
  OffsetCandidate candidate{offset_s, 0, rough_transform(pairs, bounded_weights(pairs, sigmas), sigmas)};
  for (const auto& [reference, estimated] : pairs) {
    const Vector6d residual = pose_minus(reference, candidate.transform(estimated));
    candidate.misfit += std::hypot(residual.head<3>().norm() / sigmas.rotation_rad,
                                   residual.tail<3>().norm() / sigmas.translation_m);
  }
  candidate.misfit /= static_cast<double>(pairs.size());
  return candidate;
}

constexpr int kIterations = 20;
constexpr int kTransformSteps = 2;
constexpr double kConverged_s = 1e-7;
constexpr double kLargestStep_s = 0.02;
constexpr double kLargestMove_s = 0.1;
/// Norms of three axes beyond this many standard deviations lose weight; 97 % are below.
constexpr double kHuberSigmas = 3;
/// Files of trajectories have four decimals: metres and radians.
constexpr double kDecimals = 1e-4;

/// A motion of both bodies at an offset.
struct Observation {
  const EstimatedMotion* estimated = nullptr;
  ReferenceMotion reference;
};

/// An observation at a transform of the bodies.
struct Residual {
  Vector6d value;       ///< reference minus estimate, in the tangent of pose_minus()
  Vector6d weight;      ///< of each component: Huber's weight / variance
  Vector6d instrument;  ///< rate of the estimated motion: that of the reference without its noise
  BodyJacobian jacobian;
};

std::vector<Observation> observed(double offset_s, const Trajectory& reference,
                                  std::span<const EstimatedMotion> motions) {
  const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * offset_s));
  std::vector<Observation> observations;
  observations.reserve(motions.size());
  for (const EstimatedMotion& each : motions) {
    const auto known =
        reference_motion_with_rate(reference, each.begin_ns + offset_ns, each.end_ns + offset_ns);
    if (known) observations.push_back({&each, *known});
  }
  return observations;
}

/// Standard deviation of an axis from norms of three: their median is 1.538 standard deviations.
double sigma_of(std::vector<double> norms) {
  constexpr double kMedianOfChi3 = 1.538;
  return std::max(kDecimals, upper_median(std::move(norms)) / kMedianOfChi3);
}

MotionSigmas sigmas_of(std::span<const Residual> residuals) {
  std::vector<double> rotations;
  std::vector<double> translations;
  for (const Residual& each : residuals) {
    rotations.push_back(each.value.head<3>().norm());
    translations.push_back(each.value.tail<3>().norm());
  }
  return {sigma_of(std::move(rotations)), sigma_of(std::move(translations))};
}

Vector3d weights_of(const Vector3d& residual, double sigma) {
  const double norm = residual.norm();
  const double huber = norm <= kHuberSigmas * sigma ? 1.0 : kHuberSigmas * sigma / norm;
  return Vector3d::Constant(huber / (sigma * sigma));
}

double whitened_norm(const Vector6d& rate, const Vector6d& weight) {
  return std::sqrt(rate.dot(weight.cwiseProduct(rate)));
}

/// Shortens instruments that are longer than three times the reference's rate, and than the median of these:
/// the rates across a jump of the estimate.
void bound_instruments(std::span<const Observation> observations, std::vector<Residual>& residuals) {
  constexpr double kLargest = 3;
  std::vector<double> references;
  for (std::size_t k = 0; k < residuals.size(); ++k)
    references.push_back(whitened_norm(observations[k].reference.rate, residuals[k].weight));
  const double median = upper_median(references);
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const double limit = kLargest * std::max(median, references[k]);
    const double norm = whitened_norm(residuals[k].instrument, residuals[k].weight);
    if (norm > limit) residuals[k].instrument *= limit / norm;
  }
}

std::vector<Residual> residuals_of(std::span<const Observation> observations, const BodyTransform& transform,
                                   MotionSigmas& sigmas) {
  std::vector<Residual> residuals;
  residuals.reserve(observations.size());
  for (const Observation& each : observations) {
    const EstimatedMotion& estimated = *each.estimated;
    residuals.push_back(
        {pose_minus(each.reference.motion, transform(estimated.motion)), Vector6d::Zero(),
         pose_minus(transform(estimated.after), transform(estimated.before)) / estimated.span_s,
         transform.jacobian(estimated.motion)});
  }
  sigmas = sigmas_of(residuals);
  for (Residual& each : residuals) {
    each.weight << weights_of(each.value.head<3>(), sigmas.rotation_rad),
        weights_of(each.value.tail<3>(), sigmas.translation_m);
  }
  bound_instruments(observations, residuals);
  return residuals;
}

void step_transform(std::span<const Residual> residuals, BodyTransform& transform) {
  Matrix7d information = prior_information();
  Vector7d right = -prior_gradient(transform);
  for (const Residual& each : residuals) {
    const BodyJacobian weighted = each.weight.asDiagonal() * each.jacobian;
    information += each.jacobian.transpose() * weighted;
    right += weighted.transpose() * each.value;
  }
  transform.step(information.ldlt().solve(right));
}

/// The equation of the offset with the transform marginalised.
struct Equation {
  double score = 0;        ///< sum z^T W r
  double information = 0;  ///< its derivative, sum z^T W dA/dd
  double variance = 0;     ///< of the score
  double independent = 0;
};

/// By how much of the transform's columns the instruments are explained (the marginalisation).
Vector7d explained(std::span<const Residual> residuals) {
  Matrix7d information = prior_information();
  Vector7d coupling = Vector7d::Zero();
  for (const Residual& each : residuals) {
    const BodyJacobian weighted = each.weight.asDiagonal() * each.jacobian;
    information += each.jacobian.transpose() * weighted;
    coupling += weighted.transpose() * each.instrument;
  }
  return information.ldlt().solve(coupling);
}

Equation equation_of(std::span<const Observation> observations, std::span<const Residual> residuals) {
  // A motion is of two poses, and a rate the difference of two motions. Of two files with the same decimals
  // the rounded parts of the rates agree, without any motion.
  constexpr double kMotionVariance = 2 * kDecimals * kDecimals;
  constexpr double kSpan_s = 2e-9 * static_cast<double>(kRateStep_ns);
  constexpr double kRateVariance = 2 * kMotionVariance / (kSpan_s * kSpan_s);
  const Vector7d by_transform = explained(residuals);
  Equation equation;
  std::vector<StampedTerm> terms;
  double rounding = 0;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const Residual& each = residuals[k];
    const Vector6d instrument = each.weight.cwiseProduct(each.instrument - each.jacobian * by_transform);
    const double score = instrument.dot(each.value);
    const double rate = instrument.dot(each.instrument - each.jacobian * by_transform);
    terms.push_back({observations[k].estimated->begin_ns, score, rate});
    equation.score += score;
    equation.information +=
        instrument.dot(observations[k].reference.rate) - kRateVariance * each.weight.sum();
    rounding += kMotionVariance * instrument.squaredNorm();
  }
  equation.variance = correlated_variance(terms) + rounding;
  equation.independent = independent_terms(terms);
  return equation;
}

/// The equation at the fit's offset, with the transform that fits best there.
Equation equation_at(OffsetFit& fit, const Trajectory& reference, std::span<const EstimatedMotion> motions) {
  const std::vector<Observation> observations = observed(fit.offset_s, reference, motions);
  fit.motions = observations.size();
  if (observations.empty()) return {};
  std::vector<Residual> residuals = residuals_of(observations, fit.transform, fit.sigmas);
  for (int step = 0; step < kTransformSteps; ++step) {
    step_transform(residuals, fit.transform);
    residuals = residuals_of(observations, fit.transform, fit.sigmas);
  }
  return equation_of(observations, residuals);
}

}  // namespace

std::vector<OffsetCandidate> offset_profile(const Trajectory& reference,
                                            std::span<const EstimatedMotion> motions) {
  const std::size_t stride = std::max<std::size_t>(1, (motions.size() + kMostCompared - 1) / kMostCompared);
  const auto steps = static_cast<std::int64_t>(std::llround(1e9 * kLargestOffset_s)) / kStep_ns;
  std::vector<OffsetCandidate> profile;
  std::vector<MotionPair> pairs;
  for (std::int64_t step = -steps; step <= steps; ++step) {
    const std::int64_t offset_ns = step * kStep_ns;
    pairs.clear();
    std::size_t compared = 0;
    for (std::size_t k = 0; k < motions.size(); k += stride, ++compared) {
      const EstimatedMotion& each = motions[k];
      const auto known = reference_motion(reference, each.begin_ns + offset_ns, each.end_ns + offset_ns);
      if (known) pairs.push_back({*known, each.motion});
    }
    if (pairs.size() < kFewestCompared || 2 * pairs.size() < compared) continue;
    profile.push_back(candidate_at(1e-9 * static_cast<double>(offset_ns), pairs));
  }
  return profile;
}

const OffsetCandidate& best_of(std::span<const OffsetCandidate> profile) {
  return *std::ranges::min_element(profile, {}, &OffsetCandidate::misfit);
}

std::optional<OffsetCandidate> ambiguous_candidate(const OffsetCandidate& best,
                                                   std::span<const OffsetCandidate> profile,
                                                   double duration_s) {
  constexpr double kApart_s = 0.1;
  constexpr double kSameMinimum_s = 1e-6;  // stamps are multiples of 20 ms
  constexpr double kRounding = 0.01;       // 0.1 mm and 0.1 mrad
  const double limit = (1 + 1.5 / std::sqrt(duration_s)) * (best.misfit + kRounding) - kRounding;
  std::optional<OffsetCandidate> ambiguous;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const double misfit = profile[i].misfit;
    const bool local = (i == 0 || misfit <= profile[i - 1].misfit) &&
                       (i + 1 == profile.size() || misfit <= profile[i + 1].misfit);
    const bool apart = std::abs(profile[i].offset_s - best.offset_s) > kApart_s - kSameMinimum_s;
    if (local && apart && misfit < (ambiguous ? ambiguous->misfit : limit)) ambiguous = profile[i];
  }
  return ambiguous;
}

OffsetFit fitted_from(const OffsetCandidate& start, const Trajectory& reference,
                      std::span<const EstimatedMotion> motions) {
  OffsetFit fit;
  fit.offset_s = start.offset_s;
  fit.transform = start.transform;
  fit.sigma_s = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Equation equation = equation_at(fit, reference, motions);
    fit.independent = equation.independent;
    if (!(equation.information > 0)) return fit;
    const double step_s = std::clamp(-equation.score / equation.information, -kLargestStep_s, kLargestStep_s);
    fit.offset_s += step_s;
    if (std::abs(fit.offset_s - start.offset_s) > kLargestMove_s) return fit;
    if (std::abs(step_s) > kConverged_s) continue;
    fit.sigma_s = std::sqrt(equation.variance) / equation.information;
    return fit;
  }
  return fit;
}

}  // namespace fusebench::reference_clock
