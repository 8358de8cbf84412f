#include "core/estimator/smoother/batch_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/estimator/prediction/imu_preintegration.hpp"
#include "core/estimator/smoother/batch_problem.hpp"
#include "core/estimator/smoother/block_scatter.hpp"
#include "core/estimator/smoother/selected_inverse.hpp"
#include "core/estimator/smoother/visual_scale.hpp"

namespace fusebench::smoother {

namespace {

Result<void> check_input(const BatchInput& input, const BatchOptions& options) {
  check(input.initial.size() == input.instants_ns.size(), "each frame has a state");
  check(
      std::ranges::adjacent_find(input.instants_ns, std::ranges::greater_equal{}) == input.instants_ns.end(),
      "frames come in the order of time");
  for (const RelativeCameraMotion& motion : input.visual) {
    check(motion.reference < input.instants_ns.size() && motion.frame < input.instants_ns.size() &&
              motion.reference != motion.frame,
          "a motion is between two frames of the recording");
  }
  struct Range {
    std::string_view name;
    double value;
    double low;
    double high;
  };
  for (const VisualTiming& timing : input.timing)
    check(timing.frame < input.instants_ns.size(), "a timing is of a frame of the recording");
  for (const Range& r :
       {Range{"rotation_prior_rad", options.rotation_prior_rad, 0, 10},
        Range{"translation_prior_m", options.translation_prior_m, 0, 100},
        Range{"time_offset_prior_s", options.time_offset_prior_s, 0, 10},
        Range{"gyroscope_scale_prior", options.gyroscope_scale_prior, 0, 1},
        Range{"accelerometer_scale_prior", options.accelerometer_scale_prior, 0, 1},
        Range{"timing_prior_s (least)", options.timing_prior_s.minCoeff(), 0, 10},
        Range{"timing_prior_s (most)", options.timing_prior_s.maxCoeff(), 0, 10},
        Range{"gyroscope_bias_sigma_radps", options.gyroscope_bias_sigma_radps, 1e-9, 10},
        Range{"accelerometer_bias_sigma_mps2", options.accelerometer_bias_sigma_mps2, 1e-9, 100},
        Range{"outlier_sigmas", options.outlier_sigmas, 0.1, 1e6}}) {
    if (!(r.value >= r.low && r.value <= r.high))
      return fail(ErrorCode::configuration,
                  fmt::format("{} = {} (allowed {} .. {})", r.name, r.value, r.low, r.high));
  }
  if (input.instants_ns.size() < 3 || input.visual.size() < 2) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format(
            "a batch estimate needs at least 3 frames and 2 motions between them; there are {} and {}",
            input.instants_ns.size(), input.visual.size()),
        "take more frames, or a run that tracks them");
  }
  return {};
}

BatchUnknowns initial_unknowns(const BatchInput& input) {
  BatchUnknowns x;
  for (const filter::FilterState& state : input.initial) {
    x.rotation_world_imu.push_back(state.T_world_imu.rotation);
    x.position_world_m.push_back(state.T_world_imu.translation);
    x.velocity_world_mps.push_back(state.velocity_world_mps);
    Vector6d bias;
    bias << state.gyroscope_bias_radps, state.accelerometer_bias_mps2;
    x.bias.push_back(bias);
  }
  x.gravity_direction_world = input.initial.back().gravity_direction_world;
  x.T_imu_camera = input.T_imu_camera;
  x.time_offset_s = input.time_offset_s;
  x.scales = input.scales;
  return x;
}

Result<std::vector<prediction::PreintegratedImu>> integrate(const BatchInput& input, const BatchUnknowns& x) {
  const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * x.time_offset_s));
  std::vector<prediction::PreintegratedImu> increments;
  for (std::size_t k = 0; k + 1 < input.instants_ns.size(); ++k) {
    auto imu = prediction::preintegrate(input.imu, input.instants_ns[k] + offset_ns,
                                        input.instants_ns[k + 1] + offset_ns, BatchProblem::errors_at(x, k),
                                        input.imu_noise);
    if (!imu) return tl::unexpected(imu.error());
    increments.push_back(*imu);
  }
  return increments;
}

/// Trace of J_rows (J^T J)^-1 J_rows^T: the number of unknowns that these rows determine.
double leverage(const SparseRowsd& jacobian, Eigen::Index begin, Eigen::Index end,
                const SelectedInverse& inverse) {
  using Row = SparseRowsd::InnerIterator;
  double sum = 0;
  for (Eigen::Index row = begin; row < end; ++row) {
    for (Row a(jacobian, row); a; ++a) {
      if (a.value() == 0.0) continue;
      sum += a.value() * a.value() * inverse.entry(a.col(), a.col());
      for (Row b(jacobian, row); b && b.col() < a.col(); ++b)
        if (b.value() != 0.0) sum += 2.0 * a.value() * b.value() * inverse.entry(a.col(), b.col());
    }
  }
  return sum;
}

/// J^T J. The last frame's pose and biases share no residual, but their covariance is required: explicit
/// zeros reserve the entries.
SparseMatrixd information_of(const BatchLinearisation& at) {
  SparseMatrixd information = at.jacobian.transpose() * at.jacobian;
  SparseMatrixd place(information.rows(), information.cols());
  std::vector<Eigen::Triplet<double>> zeros;
  const int begin = at.columns.rotation.back();
  for (int i = 0; i < kBatchStateSize; ++i)
    for (int j = 0; j < kBatchStateSize; ++j) zeros.emplace_back(begin + i, begin + j, 0.0);
  place.setFromTriplets(zeros.begin(), zeros.end());
  return information + place;
}

double squared(const std::vector<double>& residuals, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += residuals[i] * residuals[i];
  return sum;
}

class BatchSearch {
 public:
  BatchSearch(const BatchInput& input, const BatchOptions& options)
      : input_(input), options_(options), unknowns_(initial_unknowns(input)) {}

  Result<BatchEstimate> run();

 private:
  Result<void> round();
  void rescale(BatchProblem& problem, const BatchLinearisation& at, const SelectedInverse& inverse);
  void rescale_timing(const BatchLinearisation& at, const SelectedInverse& inverse);
  void describe_frames(const BatchLinearisation& at, const SelectedInverse& inverse);
  void describe_common(const BatchLinearisation& at, const SelectedInverse& inverse);

  const BatchInput& input_;
  const BatchOptions& options_;
  BatchUnknowns unknowns_;
  VisualScale scale_;
  VisualScale timing_scale_;
  std::vector<prediction::PreintegratedImu> increments_;
  BatchEstimate estimate_;
};

tl::unexpected<Error> search_failed() {
  return fail(ErrorCode::data_corrupt, "the batch estimate failed: the search found no finite optimum",
              "check the images and inertial samples with `fusebench inspect`");
}

Result<void> BatchSearch::round() {
  auto increments = integrate(input_, unknowns_);
  if (!increments) return tl::unexpected(increments.error());
  increments_ = std::move(*increments);
  BatchProblem problem(input_, options_, increments_, scale_.weighting(options_.outlier_sigmas),
                       timing_scale_.weighting(options_.outlier_sigmas), unknowns_);
  if (!problem.solve()) return search_failed();
  const BatchLinearisation at = problem.linearise();
  const auto inverse = SelectedInverse::of(information_of(at));
  if (!inverse) return search_failed();
  describe_frames(at, *inverse);
  describe_common(at, *inverse);
  rescale(problem, at, *inverse);
  rescale_timing(at, *inverse);
  return {};
}

/// Updates the scale from the residuals of this round.
void BatchSearch::rescale(BatchProblem& problem, const BatchLinearisation& at,
                          const SelectedInverse& inverse) {
  const std::size_t visual_rows = 6 * input_.visual.size();
  const std::size_t inertial_rows = 9 * increments_.size();
  std::vector<std::optional<Vector6d>> residual_of_frame(input_.instants_ns.size());
  const double per_sigma = std::sqrt(scale_.product());
  std::size_t outliers = 0;
  for (std::size_t m = 0; m < input_.visual.size(); ++m) {
    const double* weighted = &at.residuals[6 * m];
    const Vector6d residual = problem.visual_residual(m) * std::sqrt(scale_.correlation);
    if (residual.norm() > options_.outlier_sigmas) ++outliers;
    residual_of_frame[input_.visual[m].frame] = Eigen::Map<const Vector6d>(weighted) * per_sigma;
    estimate_.frames[input_.visual[m].frame].visual_residual = residual.norm() / std::sqrt(6.0);
  }
  const auto rows = static_cast<Eigen::Index>(visual_rows);
  const auto last = static_cast<Eigen::Index>(visual_rows + inertial_rows);
  const double visual_redundancy =
      std::max(1.0, static_cast<double>(visual_rows) - leverage(at.jacobian, 0, rows, inverse));
  const double inertial_redundancy =
      std::max(1.0, static_cast<double>(inertial_rows) - leverage(at.jacobian, rows, last, inverse));
  estimate_.outliers = outliers;
  estimate_.variance_factor = scale_.variance;
  estimate_.correlation_factor = scale_.correlation;
  estimate_.inertial_variance_factor =
      squared(at.residuals, visual_rows, visual_rows + inertial_rows) / inertial_redundancy;
  scale_.variance =
      std::clamp(scale_.product() * squared(at.residuals, 0, visual_rows) / visual_redundancy, 1e-6, 1e6);
  scale_.correlation = correlation_factor(residual_of_frame);
}

/// Updates the scale of the timing residuals. A scale with too few residuals is unchanged.
void BatchSearch::rescale_timing(const BatchLinearisation& at, const SelectedInverse& inverse) {
  constexpr double kLeastRedundancy = 10;
  const std::size_t begin = 6 * input_.visual.size() + 9 * increments_.size();
  const std::size_t end = begin + 3 * input_.timing.size();
  std::vector<std::optional<Vector6d>> residual_of_frame(input_.instants_ns.size());
  const double per_sigma = std::sqrt(timing_scale_.product());
  double rank = 0;
  for (std::size_t m = 0; m < input_.timing.size(); ++m) {
    const VisualTiming& timing = input_.timing[m];
    rank += timing.rank;
    if (timing.rank == 0) continue;
    Vector6d residual = Vector6d::Zero();
    residual.head<3>() = Eigen::Map<const Vector3d>(&at.residuals[begin + 3 * m]) * per_sigma;
    residual_of_frame[timing.frame] = residual;
  }
  estimate_.timing_variance_factor = timing_scale_.variance;
  estimate_.timing_correlation_factor = timing_scale_.correlation;
  const double redundancy =
      rank - leverage(at.jacobian, static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end), inverse);
  if (redundancy < kLeastRedundancy) return;
  timing_scale_.variance =
      std::clamp(timing_scale_.product() * squared(at.residuals, begin, end) / redundancy, 1e-6, 1e6);
  timing_scale_.correlation = correlation_factor(residual_of_frame);
}

void BatchSearch::describe_frames(const BatchLinearisation& at, const SelectedInverse& inverse) {
  const BatchUnknowns& x = unknowns_;
  estimate_.frames.assign(x.position_world_m.size(), {});
  for (std::size_t k = 0; k < estimate_.frames.size(); ++k) {
    BatchFrame& frame = estimate_.frames[k];
    frame.state = input_.initial[k];
    frame.state.T_world_imu = {x.rotation_world_imu[k], x.position_world_m[k]};
    frame.state.velocity_world_mps = x.velocity_world_mps[k];
    frame.state.gyroscope_bias_radps = x.bias[k].head<3>();
    frame.state.accelerometer_bias_mps2 = x.bias[k].tail<3>();
    frame.state.gravity_direction_world = x.gravity_direction_world;
    frame.state.imu_time_offset_s = x.time_offset_s;
    if (k > 0) frame.state.angular_velocity_imu_radps = increments_[k - 1].angular_velocity_end_radps;
    // Pose, velocity and biases of a frame are adjacent columns; the first frame has no pose.
    const bool fixed = at.columns.rotation[k] < 0;
    const int begin = fixed ? at.columns.velocity[k] : at.columns.rotation[k];
    const int size = fixed ? kBatchStateSize - filter::kPoseSize : kBatchStateSize;
    frame.covariance.bottomRightCorner(size, size) = inverse.block(begin, begin, size, size);
  }
}

void BatchSearch::describe_common(const BatchLinearisation& at, const SelectedInverse& inverse) {
  estimate_.T_imu_camera = unknowns_.T_imu_camera;
  estimate_.time_offset_s = unknowns_.time_offset_s;
  estimate_.scales = unknowns_.scales;
  estimate_.timing_s = unknowns_.timing_s;
  estimate_.gravity_direction_world = unknowns_.gravity_direction_world;
  struct Part {
    int column;
    int size;
    int place;
  };
  const BatchColumns& columns = at.columns;
  const std::array<Part, 9> parts = {Part{columns.gravity, 2, kCommonGravity},
                                     Part{columns.imu_camera_rotation, 3, kCommonRotation},
                                     Part{columns.imu_camera_translation, 3, kCommonTranslation},
                                     Part{columns.time_offset, 1, kCommonTimeOffset},
                                     Part{columns.gyroscope_scale, 3, kCommonGyroscopeScale},
                                     Part{columns.accelerometer_scale, 3, kCommonAccelerometerScale},
                                     Part{columns.timing[0], 1, kCommonTiming},
                                     Part{columns.timing[1], 1, kCommonTiming + 1},
                                     Part{columns.timing[2], 1, kCommonTiming + 2}};
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(columns.count, kBatchCommonSize);
  for (const Part& part : parts) {
    if (part.column >= 0) unit.block(part.column, part.place, part.size, part.size).setIdentity();
  }
  const Eigen::MatrixXd to_common = inverse.columns(unit);
  const Eigen::MatrixXd covariance = unit.transpose() * to_common;
  estimate_.common_covariance =
      enlarged_by_scatter(0.5 * (covariance + covariance.transpose()), at, to_common, blocks_in_time(input_));
}

Result<BatchEstimate> BatchSearch::run() {
  constexpr double kSteadyOffsetS = 1e-6;
  constexpr double kSteadyBias = 1e-4;  // rad/s and m/s^2: changes are of second order in the increments
  constexpr double kSteadyScale = 0.02;
  while (estimate_.rounds < options_.max_rounds && !estimate_.converged) {
    const BatchUnknowns before = unknowns_;
    const double scale_before = scale_.product();
    const double timing_scale_before = timing_scale_.product();
    if (auto done = round(); !done) return tl::unexpected(done.error());
    ++estimate_.rounds;
    double bias_change = 0;
    for (std::size_t k = 0; k < before.bias.size(); ++k)
      bias_change = std::max(bias_change, (unknowns_.bias[k] - before.bias[k]).cwiseAbs().maxCoeff());
    estimate_.converged = std::abs(unknowns_.time_offset_s - before.time_offset_s) < kSteadyOffsetS &&
                          bias_change < kSteadyBias &&
                          std::abs(scale_.product() / scale_before - 1) < kSteadyScale &&
                          std::abs(timing_scale_.product() / timing_scale_before - 1) < kSteadyScale;
  }
  return estimate_;
}

}  // namespace

Result<BatchEstimate> estimate_batch(const BatchInput& input, const BatchOptions& options) {
  if (auto valid = check_input(input, options); !valid) return tl::unexpected(valid.error());
  return BatchSearch(input, options).run();
}

}  // namespace fusebench::smoother
