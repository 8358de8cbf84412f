#include "datasets/synthetic_imu/synthetic_imu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace fusebench::synthetic_imu {

namespace {

/// Platform-independent normal numbers. The standard defines the bits of the engine but not the distribution,
/// so the Box-Muller transform is implemented here.
class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : engine_(seed) {}

  Vector3d vector(double sigma) {
    const double x = next();
    const double y = next();
    const double z = next();
    return sigma * Vector3d(x, y, z);
  }

 private:
  double next() {
    if (spare_) {
      const double value = *spare_;
      spare_.reset();
      return value;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));  // 1 - u is in (0, 1]
    const double angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    return radius * std::cos(angle);
  }
  double uniform() { return 0x1p-53 * static_cast<double>(engine_() >> 11); }

  std::mt19937_64 engine_;
  std::optional<double> spare_;
};

double combine(double a, double b) { return std::sqrt(a * a + b * b); }

/// All frames must be within the ground truth; the hint names the first run of frames that are.
Result<void> check_coverage(const recording::Recording& recording) {
  const Trajectory& truth = recording.ground_truth;
  const auto covered = [&](const recording::FrameEntry& frame) {
    return frame.timestamp_ns >= truth.front().timestamp_ns &&
           frame.timestamp_ns <= truth.back().timestamp_ns;
  };
  const auto begin = std::ranges::find_if(recording.frames, covered);
  const auto end = std::find_if_not(begin, recording.frames.end(), covered);
  const auto inside = std::distance(begin, end);
  if (inside == std::ssize(recording.frames)) return {};
  const auto first = std::distance(recording.frames.begin(), begin);
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("{}: the ground truth covers {} of {} frames, so no IMU can be made for the others",
                  recording.name, inside, recording.frames.size()),
      inside > 0 ? fmt::format("take --frames {}:{}", first, first + inside) : "run without --imu synthetic");
}

void warn_of_gaps(recording::Recording& recording) {
  constexpr std::int64_t kLongGap_ns = 100'000'000;
  std::size_t gaps = 0;
  std::int64_t longest_ns = 0;
  for (std::size_t i = 1; i < recording.ground_truth.size(); ++i) {
    const std::int64_t gap_ns =
        recording.ground_truth[i].timestamp_ns - recording.ground_truth[i - 1].timestamp_ns;
    if (gap_ns > kLongGap_ns) ++gaps;
    longest_ns = std::max(longest_ns, gap_ns);
  }
  if (gaps == 0) return;
  recording.warnings.push_back(fmt::format(
      "synthetic IMU: {} gaps of the ground truth longer than {} s (longest {} s) are bridged by the "
      "smoothest motion",
      gaps, seconds_between(0, kLongGap_ns), seconds_between(0, longest_ns)));
}

std::string note(const SyntheticImuOptions& options, const SplineFit& fit) {
  const ImuNoise& n = options.sensor.noise;
  return fmt::format(
      "made from ground truth: sensor {} (gyroscope {:g} rad/s/sqrt(Hz), accelerometer {:g} m/s^2/sqrt(Hz), "
      "bias walks "
      "{:g} and {:g}), {:g} Hz, seed {}; cubic B-spline with knots every {:g} ms, cutoff {:g} Hz, residual "
      "rms per axis "
      "{:.4f} deg and {:.3f} mm{}",
      options.sensor.name, n.gyroscope_radps_sqrthz, n.accelerometer_mps2_sqrthz,
      n.gyroscope_bias_radps2_sqrthz, n.accelerometer_bias_mps3_sqrthz, options.rate_hz, options.seed,
      1e3 * options.fit.knot_spacing_s, options.fit.cutoff_hz,
      fit.rotation_residual_rad * 180 / std::numbers::pi, 1e3 * fit.position_residual_m,
      fit.converged ? "" : " (fit not converged)");
}

}  // namespace

ImuSensor zr300_imu() { return {"ZR300", {1.10e-3, 0.02425, 5.0e-5, 6.3e-4}, 0.004, 0.05}; }

std::vector<ImuSample> ideal_imu(const PoseSpline& spline, std::int64_t start_ns, std::int64_t end_ns,
                                 double rate_hz, const Vector3d& gravity_world_mps2) {
  const std::int64_t period_ns = std::llround(1e9 / rate_hz);
  std::vector<ImuSample> samples;
  // Up to the first sample at or after the end, so that samples enclose it.
  for (std::int64_t time_ns = start_ns; time_ns < end_ns + period_ns; time_ns += period_ns) {
    const Kinematics k = spline.evaluate(time_ns);
    samples.push_back(
        {time_ns, k.angular_velocity_body_radps,
         k.T_world_body.rotation.conjugate() * (k.acceleration_world_mps2 - gravity_world_mps2)});
  }
  return samples;
}

std::vector<ImuBias> add_imu_noise(std::vector<ImuSample>& samples, const ImuSensor& sensor, double rate_hz,
                                   std::uint64_t seed) {
  NormalNumbers normal(seed);
  const double per_sample = std::sqrt(rate_hz);      // sigma of a sample = density * sqrt(rate)
  const double per_step = 1.0 / std::sqrt(rate_hz);  // sigma of a step = density of the walk / sqrt(rate)
  ImuBias bias;
  bias.gyroscope_radps = normal.vector(sensor.initial_gyroscope_bias_radps);
  bias.accelerometer_mps2 = normal.vector(sensor.initial_accelerometer_bias_mps2);
  std::vector<ImuBias> biases;
  biases.reserve(samples.size());
  for (ImuSample& sample : samples) {
    sample.angular_velocity_radps +=
        bias.gyroscope_radps + normal.vector(sensor.noise.gyroscope_radps_sqrthz * per_sample);
    sample.specific_force_mps2 +=
        bias.accelerometer_mps2 + normal.vector(sensor.noise.accelerometer_mps2_sqrthz * per_sample);
    biases.push_back(bias);
    bias.gyroscope_radps += normal.vector(sensor.noise.gyroscope_bias_radps2_sqrthz * per_step);
    bias.accelerometer_mps2 += normal.vector(sensor.noise.accelerometer_bias_mps3_sqrthz * per_step);
  }
  return biases;
}

ImuNoise truth_noise(const SplineFit& fit, const SyntheticImuOptions& options) {
  constexpr double kHorizonS = 1.0;
  ImuNoise noise;
  noise.gyroscope_radps_sqrthz = std::numbers::sqrt2 * fit.rotation_residual_rad / std::sqrt(kHorizonS);
  noise.accelerometer_mps2_sqrthz = options.truth_acceleration_mps2_sqrthz;
  return noise;
}

Result<void> add_synthetic_imu(recording::Recording& recording, const SyntheticImuOptions& options) {
  if (!(options.rate_hz >= 10 && options.rate_hz <= 10000)) {
    return fail(ErrorCode::configuration, fmt::format("rate_hz = {} (allowed 10 .. 10000)", options.rate_hz));
  }
  if (recording.ground_truth.empty()) {
    return fail(ErrorCode::data_missing,
                fmt::format("{}: has no ground truth to make a synthetic IMU from", recording.name),
                "choose a variant that needs no IMU, as --variant no-imu");
  }
  if (const auto covered = check_coverage(recording); !covered) return covered;
  const Result<SplineFit> fit = fit_pose_spline(recording.ground_truth, options.fit);
  if (!fit)
    return fail(fit.error().code, fmt::format("{}: {}", recording.name, fit.error().message),
                fit.error().hint);

  recording.imu =
      ideal_imu(fit->spline, recording.ground_truth.front().timestamp_ns,
                recording.ground_truth.back().timestamp_ns, options.rate_hz, options.gravity_world_mps2);
  add_imu_noise(recording.imu, options.sensor, options.rate_hz, options.seed);
  recording.imu_source = recording::ImuSource::synthetic;
  recording.imu_note = note(options, *fit);
  recording.rig.T_imu_camera = {Quaterniond::Identity(), recording::ground_truth_offset_m(recording)};
  const ImuNoise uncertainty = truth_noise(*fit, options);
  recording.rig.imu_axes_are_exact = true;
  ImuNoise& noise = recording.rig.imu_noise;
  noise = options.sensor.noise;
  noise.gyroscope_radps_sqrthz = combine(noise.gyroscope_radps_sqrthz, uncertainty.gyroscope_radps_sqrthz);
  noise.accelerometer_mps2_sqrthz =
      combine(noise.accelerometer_mps2_sqrthz, uncertainty.accelerometer_mps2_sqrthz);
  warn_of_gaps(recording);
  return {};
}

}  // namespace fusebench::synthetic_imu
