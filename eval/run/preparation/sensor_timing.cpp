#include "eval/run/preparation/sensor_timing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "eval/run/preparation/timing_pair.hpp"

namespace fusebench::preparation {

namespace {

constexpr std::size_t kMostPairs = 120;
constexpr std::size_t kFewestPairs = 20;
constexpr std::size_t kPairsOfBlock = 8;  // neighbours in time, whose errors may be common
constexpr std::size_t kMostSteps = 8;     // between the frames of a pair
constexpr double kMaxTurn_rad = radians(15);
constexpr double kMaxBaseline_m = 0.25;
constexpr double kDepth_m = 1.5;  // at which a translation counts as much as a rotation
constexpr int kMostRounds = 12;
// How far colour and depth lie apart, the same in all frames: as an error of the delay of depth it is this by
// the velocity of the image.
constexpr double kMisalignment_px = 0.15;
// Parts of one real recording differ by 3 ms (read-out of colour, delay of depth) to 6 ms (read-out of depth;
// root mean square): images have other errors that grow with the velocity.
constexpr double kUnexplained_s = 5e-3;
constexpr double kConverged_s = 1e-4;

struct FramePair {
  const MovingFrame* a = nullptr;
  const MovingFrame* b = nullptr;
  double change_radps = 0;  ///< of the velocity
};

double angular_size(const Vector6d& twist) {
  return std::hypot(twist.head<3>().norm(), twist.tail<3>().norm() / kDepth_m);
}

/// With the later frame whose velocity differs most, of those that see the same.
std::optional<FramePair> best_pair(const std::vector<MovingFrame>& frames, std::size_t a) {
  std::optional<FramePair> best;
  if (!frames[a].motion) return best;
  for (std::size_t b = a + 1; b < std::min(frames.size(), a + kMostSteps + 1); ++b) {
    if (!frames[b].motion) continue;
    const SE3 moved = frames[a].motion->T_world_camera.inverse() * frames[b].motion->T_world_camera;
    if (rotation_angle_rad(moved.rotation, Quaterniond::Identity()) > kMaxTurn_rad ||
        moved.translation.norm() > kMaxBaseline_m)
      continue;
    const double change_radps = angular_size(frames[b].motion->twist - frames[a].motion->twist);
    if (!best || change_radps > best->change_radps) best = FramePair{&frames[a], &frames[b], change_radps};
  }
  return best;
}

/// The best one of each part of the recording.
std::vector<FramePair> choose_pairs(std::span<const MovingFrames> windows) {
  std::vector<FramePair> pairs;
  for (const MovingFrames& window : windows) {
    const std::vector<MovingFrame>& frames = window.frames;
    std::vector<std::optional<FramePair>> best(std::min(kMostPairs / windows.size(), frames.size()));
    for (std::size_t a = 0; a < frames.size(); ++a) {
      const auto pair = best_pair(frames, a);
      auto& slot = best[a * best.size() / frames.size()];
      if (pair && (!slot || pair->change_radps > slot->change_radps)) slot = pair;
    }
    for (const auto& pair : best) {
      if (pair) pairs.push_back(*pair);
    }
  }
  return pairs;
}

/// The measurement of one round, around the timing that it started from.
struct Round {
  Vector3d step_s = Vector3d::Zero();
  Matrix3d covariance = Matrix3d::Zero();
  std::size_t pairs = 0;
};

Round measure_at(const std::vector<FramePair>& pairs, const PinholeCamera& camera, const Vector3d& timing_s,
                 double depth_delay_read_s, const Workers& workers) {
  const Vector3d beyond_s = timing_s - Vector3d(0, 0, depth_delay_read_s);
  using Quadratic = std::optional<TimingQuadratic>;
  const auto quadratics =
      workers.map_chunks<Quadratic>(pairs.size(), 1, [&](std::size_t i, std::size_t) -> Quadratic {
        return timing_of_pair(*pairs[i].a, *pairs[i].b, camera, beyond_s);
      });
  Matrix3d information = 1e-3 * Matrix3d::Identity();
  Vector3d gradient = Vector3d::Zero();
  std::vector<Vector3d> blocks((pairs.size() + kPairsOfBlock - 1) / kPairsOfBlock, Vector3d::Zero());
  Round round;
  for (std::size_t i = 0; i < quadratics.size(); ++i) {
    if (!quadratics[i]) continue;
    ++round.pairs;
    information += quadratics[i]->information;
    gradient += quadratics[i]->gradient;
    blocks[i / kPairsOfBlock] += quadratics[i]->gradient;
  }
  Matrix3d scatter = Matrix3d::Zero();
  for (const Vector3d& block : blocks) scatter += block * block.transpose();
  const auto count = static_cast<double>(blocks.size());
  scatter *= count / std::max(1.0, count - 1);
  const Matrix3d inverse = information.inverse();
  round.step_s = -inverse * gradient;
  // By the scatter of blocks (sandwich estimator): errors of pixels and of neighbouring pairs are not
  // independent.
  round.covariance = inverse * scatter * inverse;
  return round;
}

double rms_rate_radps(const std::vector<FramePair>& pairs) {
  double sum = 0;
  for (const FramePair& pair : pairs)
    sum += 0.5 * (std::pow(angular_size(pair.a->motion->twist), 2) +
                  std::pow(angular_size(pair.b->motion->twist), 2));
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

/// What the scatter of the pairs does not show. Colour and depth lie apart in all frames alike, and
/// velocities are differences of poses whose stamps jitter.
Vector3d common_sigma_s(const std::vector<FramePair>& pairs, double focal_length_px) {
  const double apart_s = kMisalignment_px / focal_length_px / rms_rate_radps(pairs);
  return {kUnexplained_s, std::hypot(kUnexplained_s, apart_s), std::hypot(kUnexplained_s, apart_s)};
}

/// The mean of two estimates, weighted by their information. What has a standard deviation of zero is held.
TimingEstimate combined(const TimingEstimate& prior, const Vector3d& measured_s,
                        const Matrix3d& measured_covariance) {
  TimingEstimate result = prior;
  const Matrix3d information = measured_covariance.inverse();
  Matrix3d prior_information = Matrix3d::Zero();
  constexpr double kHeld = 1e18;
  for (int i = 0; i < 3; ++i)
    prior_information(i, i) = prior.sigma_s[i] > 0 ? 1 / (prior.sigma_s[i] * prior.sigma_s[i]) : kHeld;
  const Matrix3d covariance = (information + prior_information).inverse();
  const Vector3d mean_s = covariance * (information * measured_s + prior_information * prior.value_s);
  for (int i = 0; i < 3; ++i) {
    if (!(prior.sigma_s[i] > 0)) continue;
    result.value_s[i] = mean_s[i];
    result.sigma_s[i] = std::sqrt(covariance(i, i));
  }
  return result;
}

}  // namespace

TimingEstimate timing_of(const SensorTiming& timing) {
  return {{timing.color_readout_s, timing.depth_readout_s, timing.depth_delay_s},
          {timing.color_readout_sigma_s, timing.depth_readout_sigma_s, timing.depth_delay_sigma_s}};
}

SensorTiming sensor_timing(const TimingEstimate& estimate) {
  return {estimate.value_s[0], estimate.value_s[1], estimate.value_s[2],
          estimate.sigma_s[0], estimate.sigma_s[1], estimate.sigma_s[2]};
}

void TimingResponse::take(const Vector3d& timing_s, const Vector3d& step_s, const Vector3d& least_change_s) {
  for (int i = 0; i < 3 && known_; ++i) {
    const double change_s = timing_s[i] - timing_s_[i];
    if (std::abs(change_s) > least_change_s[i])
      share_[i] = std::clamp((step_s_[i] - step_s[i]) / change_s, least_, 1.0);
  }
  known_ = true;
  timing_s_ = timing_s;
  step_s_ = step_s;
}

MeasuredTiming measure_timing(std::span<const MovingFrames> windows, const SensorTiming& prior_timing,
                              double focal_length_px, const Workers& workers) {
  const TimingEstimate prior = timing_of(prior_timing);
  const MeasuredTiming nothing{prior, 0};
  const std::vector<FramePair> pairs = choose_pairs(windows);
  if (pairs.size() < kFewestPairs) return nothing;
  const Vector3d common_s = common_sigma_s(pairs, focal_length_px);
  MeasuredTiming result = nothing;
  // Bilinear intensities and robust weights are no linear function of a displacement of several pixels.
  TimingResponse response(0.3);
  for (int k = 0; k < kMostRounds; ++k) {
    const Vector3d before_s = result.posterior.value_s;
    const Round round = measure_at(pairs, windows.front().camera, before_s, prior.value_s[2], workers);
    if (round.pairs < kFewestPairs) return nothing;
    Matrix3d covariance = round.covariance;
    covariance.diagonal() += common_s.cwiseProduct(common_s);
    response.take(before_s, round.step_s, Vector3d::Constant(kConverged_s));
    const Vector3d measured_s = before_s + round.step_s.cwiseQuotient(response.share());
    result = {combined(prior, measured_s, covariance), round.pairs};
    if (((result.posterior.value_s - before_s).array().abs() < kConverged_s).all()) break;
  }
  return result;
}

}  // namespace fusebench::preparation
