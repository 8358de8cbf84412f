// Does a filter know how wrong it is? Normalised estimation error squared (NEES) against true states
// (Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, 5.4.2).
//
// How it is judged: errors of a run's frames are correlated over the whole run, so that a run is one sample,
// whatever its length. The mean over its frames is averaged over N independent runs and held against the 95 %
// bounds of N * dof degrees of freedom. These are exact for one instant of each run; a mean over time
// scatters no more than that, so that for it they are rather too wide, and small faults may pass unnoticed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/estimator/filter/stamped_state.hpp"
#include "eval/metrics/statistics.hpp"

namespace fusebench::metrics {

/// A part of the error state (core/estimator/filter/filter_state.hpp) with a NEES of its own.
struct StatePart {
  std::string_view name;
  int offset = 0;
  int dof = 0;
};
inline constexpr std::array<StatePart, 6> kStateParts = {
    {{"orientation", filter::kRotation, 3},
     {"position", filter::kPosition, 3},
     {"velocity", filter::kVelocity, 3},
     {"gyroscope_bias", filter::kGyroscopeBias, 3},
     {"accelerometer_bias", filter::kAccelerometerBias, 3},
     {"pose", filter::kRotation, 6}}};

/// The state between two stamps, by a cubic through four of them in the tangent space (fewer at the ends).
/// Nothing before the first and after the last state, or between two that are more than 0.1 s apart.
[[nodiscard]] std::optional<filter::FilterState> interpolate_state(
    std::span<const filter::StampedState> states, std::int64_t timestamp_ns);

/// True states of the camera in place of the IMU's, for estimators whose body is the camera: pose, and the
/// velocity of its centre, by central differences of its positions (at the ends one-sided). Biases are kept.
[[nodiscard]] std::vector<filter::StampedState> states_of_camera(std::span<const filter::StampedState> states,
                                                                 const SE3& T_imu_camera);

/// e^T P^-1 e of one part; nothing where its covariance is singular (of what is known by definition, such as
/// the pose of the first frame) or is not finite. covariance: of the whole state, or of where it begins.
[[nodiscard]] std::optional<double> normalised_error_squared(
    const filter::StateVector& error, const Eigen::Ref<const Eigen::MatrixXd>& covariance,
    const StatePart& part);

/// Of one part in one run. All numbers are NEES / dof: 1 is what a consistent filter has on average, more is
/// overconfident, less underconfident.
struct NeesResult {
  StatePart part;
  std::vector<double> nees_per_dof;  ///< in order of time
  std::vector<std::int64_t> at_ns;   ///< of each
  std::size_t possible = 0;          ///< estimates with a truth around them
  Statistics stats;                  ///< of nees_per_dof; count is the number of frames
  double last = std::numeric_limits<double>::quiet_NaN();
};
using ConsistencyResult = std::array<NeesResult, kStateParts.size()>;

/// The world of the estimates is the camera at the first of them, whose true pose moves the ground truth
/// there; nothing is fitted. The error is truth (-) estimate in the tangent space at the estimate. A part
/// whose covariance is singular in all frames has count 0. Errors data_corrupt: no estimates, or no truth
/// around the first one or any later one.
[[nodiscard]] Result<ConsistencyResult> consistency(std::span<const filter::StampedState> truth,
                                                    std::span<const filter::StampedEstimate> estimates,
                                                    const SE3& T_imu_camera);

/// x with P(chi-square of `dof` degrees of freedom <= x) = probability, to 1e-12 of x. dof >= 1, probability
/// in (0, 1).
[[nodiscard]] double chi_square_quantile(double probability, double dof);

/// Within which the average of NEES / dof over independent runs lies with probability 0.95 if the filter is
/// consistent: at one instant of each, that sum is chi-square distributed with runs * dof degrees of freedom.
struct NeesBounds {
  double lower = 0;
  double upper = 0;
};
[[nodiscard]] NeesBounds nees_bounds_95(std::size_t runs, int dof);

}  // namespace fusebench::metrics
