#include "datasets/simulator/motion/motion_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulator/random/random_numbers.hpp"

namespace fusebench::simulator::motion {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kSines =
    4;  // sufficient for an irregular motion; with more, speeds approach a normal distribution

// Hand-held cameras rotate mostly about the vertical.
constexpr std::array<double, 3> kAngleWeight = {1.0, 0.35, 0.2};
// Shaking has no preferred axis.
constexpr std::array<double, 3> kShakePositionWeight = {0.8, 0.8, 1.0};
constexpr std::array<double, 3> kShakeAngleWeight = {1.0, 1.0, 0.6};

constexpr double kShakeBursts_hz = 0.35;
constexpr std::uint64_t kPurpose =
    0x6D6F74696F6EULL;  // key of a random stream independent of rooms and images

// Random streams: three axes each, three values for each sine.
enum Stream : std::uint64_t {
  position = 0,
  angle = 10,
  shake_position = 20,
  shake_angle = 30,
  tremor = 40,
  angle_tremor = 45
};
enum SingleStream : std::uint64_t { pan_pause = 50, pan_duration, pan_angle, shake_phase, mean_yaw };

}  // namespace

HandPath::HandPath(const MotionOptions& options, std::uint64_t seed, const Vector3d& stretch, double length_s,
                   const std::array<double, 3>& position_weight)
    : options_(options) {
  const auto random = [seed](std::uint64_t stream, std::uint64_t index, double low, double high) {
    return low + (high - low) * random::unit_interval(random::mix_key(
                                    random::mix_key(random::mix_key(seed, kPurpose), stream), index));
  };
  // All sines have the same share of the velocity, so no frequency dominates.
  const auto sines = [&](std::uint64_t stream, const FrequencyBand& band, double weight, double period_s) {
    Sines result;
    const double ratio = band.high_hz / band.low_hz;
    for (std::size_t i = 0; i < kSines; ++i) {
      // One frequency in each quarter of the band (logarithmic).
      const double within = (static_cast<double>(i) + random(stream, 2 * i, 0, 1)) / kSines;
      double rate_radps = kTurn * band.low_hz * std::pow(ratio, within);
      if (period_s > 0)
        rate_radps = kTurn / period_s * std::max(1.0, std::round(rate_radps * period_s / kTurn));
      result.push_back({weight / (std::sqrt(static_cast<double>(kSines)) * rate_radps), rate_radps,
                        random(stream, 2 * i + 1, 0, kTurn)});
    }
    return result;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double factor = stretch[static_cast<Eigen::Index>(axis)];
    const FrequencyBand stretched{factor * options.position_hz.low_hz, factor * options.position_hz.high_hz};
    position_[axis] = sines(Stream::position + axis, stretched, position_weight[axis], options.revisit_s);
    angles_[axis] = sines(Stream::angle + axis, options.rotation_hz, kAngleWeight[axis], options.revisit_s);
    shake_position_[axis] =
        sines(Stream::shake_position + axis, options.shake_hz, kShakePositionWeight[axis], 0);
    shake_angles_[axis] = sines(Stream::shake_angle + axis, options.shake_hz, kShakeAngleWeight[axis], 0);
    const double tremor_weight = kTurn * options.tremor_hz.low_hz;
    tremor_[axis] = sines(Stream::tremor + axis, options.tremor_hz, tremor_weight, 0);
    angle_tremor_[axis] = sines(Stream::angle_tremor + axis, options.tremor_hz, tremor_weight, 0);
  }
  shake_phase_rad_ = random(SingleStream::shake_phase, 0, 0, kTurn);
  mean_yaw_rad_ = random(SingleStream::mean_yaw, 0, 0, kTurn);

  const Pans& pans = options.pans;
  double time_s = 0;
  double yaw = 0;
  for (std::uint64_t i = 0; time_s < length_s && options.pan_share > 0; ++i) {
    Pan next;
    next.begin_s = time_s + random(SingleStream::pan_pause, i, pans.pause_s[0], pans.pause_s[1]);
    next.duration_s = random(SingleStream::pan_duration, i, pans.duration_s[0], pans.duration_s[1]);
    // The peak angular velocity is 15/8 of the mean.
    const double size =
        random(SingleStream::pan_angle, i, pans.rate[0], pans.rate[1]) * next.duration_s * 8 / 15;
    // Pans return towards the middle, so they do not add up.
    next.angle = yaw > 0 ? -size : size;
    yaw += next.angle;
    time_s = next.begin_s + next.duration_s;
    pans_.push_back(next);
  }
}

double HandPath::sum(const Sines& sines, double path_s) {
  double value = 0;
  for (const Sine& sine : sines)
    value += sine.amplitude * std::sin(sine.rate_radps * path_s + sine.phase_rad);
  return value;
}

double HandPath::pan(double path_s) const {
  double value = 0;
  for (const Pan& pan : pans_) {
    const double u = std::clamp((path_s - pan.begin_s) / pan.duration_s, 0.0, 1.0);
    value += pan.angle * u * u * u * (10 + u * (6 * u - 15));
  }
  return value;
}

double HandPath::shaking(double path_s) const {
  return options_.shake_share * (0.6 + 0.4 * std::sin(kTurn * kShakeBursts_hz * path_s + shake_phase_rad_));
}

Vector3d HandPath::position(double path_s) const {
  Vector3d value;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    value[static_cast<Eigen::Index>(axis)] = (1 - options_.shake_share) * sum(position_[axis], path_s) +
                                             shaking(path_s) * sum(shake_position_[axis], path_s);
  }
  return value;
}

Vector3d HandPath::angles(double path_s) const {
  Vector3d value;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    value[static_cast<Eigen::Index>(axis)] =
        (1 - options_.shake_share) * (1 - options_.pan_share) * sum(angles_[axis], path_s) +
        shaking(path_s) * sum(shake_angles_[axis], path_s);
  }
  value[0] += (1 - options_.shake_share) * options_.pan_share * pan(path_s);
  return value;
}

Vector3d HandPath::angle_tremor(double path_s) const {
  return {sum(angle_tremor_[0], path_s), sum(angle_tremor_[1], path_s), sum(angle_tremor_[2], path_s)};
}

Vector3d HandPath::tremor(double path_s) const {
  return {sum(tremor_[0], path_s), sum(tremor_[1], path_s), sum(tremor_[2], path_s)};
}

}  // namespace fusebench::simulator::motion
