// Gravity, sign and bias of the accelerometer, by ground truth where the recording never rests.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/trajectory/trajectory.hpp"
#include "datasets/inspection/checks.hpp"

namespace fusebench::inspection {

namespace {

constexpr std::int64_t kWindow_ns = 400'000'000;
constexpr std::int64_t kHalfStep_ns = 50'000'000;
constexpr std::size_t kMinWindows = 6;

/// R * mean(f) over a window, and how the velocity changed over it.
struct Window {
  Vector3d force_truth_mps2 = Vector3d::Zero();         ///< mean of R f
  Matrix3d rotation = Matrix3d::Zero();                 ///< mean of R
  Vector3d acceleration_truth_mps2 = Vector3d::Zero();  ///< of the IMU
};

/// Poses of the IMU in the truth's world, with the rotation and the time offset that the gyroscope gave.
class ImuPath {
 public:
  ImuPath(const recording::Recording& recording, const ImuAlignment& alignment)
      : recording_(recording),
        gap_ns_(truth_gap_ns(recording)),
        offset_ns_(std::llround(1e9 * alignment.time_offset_s)),
        rotation_camera_imu_(alignment.rotation_imu_camera.transpose()),
        imu_in_camera_m_(recording.rig.T_imu_camera.inverse().translation) {}

  struct Pose {
    Matrix3d rotation;
    Vector3d position_m;
  };
  /// At a stamp of the IMU.
  [[nodiscard]] std::optional<Pose> at(std::int64_t imu_ns) const {
    const auto pose = trajectory::interpolate_pose(recording_.ground_truth, imu_ns - offset_ns_, gap_ns_);
    if (!pose) return std::nullopt;
    return Pose{pose->rotation_matrix() * rotation_camera_imu_, *pose * imu_in_camera_m_};
  }
  /// Central difference over 0.1 s: shorter ones show the jitter of the truth.
  [[nodiscard]] std::optional<Vector3d> velocity(std::int64_t imu_ns) const {
    const auto before = at(imu_ns - kHalfStep_ns), after = at(imu_ns + kHalfStep_ns);
    if (!before || !after) return std::nullopt;
    return (after->position_m - before->position_m) / seconds_between(-kHalfStep_ns, kHalfStep_ns);
  }

 private:
  const recording::Recording& recording_;
  std::int64_t gap_ns_;
  std::int64_t offset_ns_;
  Matrix3d rotation_camera_imu_;
  Vector3d imu_in_camera_m_;
};

std::vector<Window> windows_of(const recording::Recording& recording, const ImuPath& path) {
  std::vector<Window> windows;
  const auto& samples = recording.imu;
  std::size_t i = 0;
  while (i < samples.size()) {
    const std::int64_t begin_ns = samples[i].timestamp_ns;
    Window window;
    int count = 0;
    bool whole = true;
    for (; i < samples.size() && samples[i].timestamp_ns < begin_ns + kWindow_ns; ++i) {
      const auto pose = path.at(samples[i].timestamp_ns);
      whole = whole && pose;
      if (!pose) continue;
      window.rotation += pose->rotation;
      window.force_truth_mps2 += pose->rotation * samples[i].specific_force_mps2;
      ++count;
    }
    const auto begin_velocity = path.velocity(begin_ns), end_velocity = path.velocity(begin_ns + kWindow_ns);
    if (!whole || count < 10 || !begin_velocity || !end_velocity) continue;
    window.rotation /= count;
    window.force_truth_mps2 /= count;
    window.acceleration_truth_mps2 = (*end_velocity - *begin_velocity) / seconds_between(0, kWindow_ns);
    windows.push_back(window);
  }
  return windows;
}

struct AccelerometerFit {
  Vector3d gravity_mps2 = Vector3d::Zero();
  Vector3d bias_mps2 = Vector3d::Zero();
  double bias_sigma_mps2 = 0;  ///< of the worst axis
  double slope = 1;            ///< of the measured on the true acceleration
  double slope_sigma = 0;
};

/// mean(R f) = slope * a - g + mean(R) b, for slope, g and b.
std::optional<AccelerometerFit> fit_windows(const std::vector<Window>& windows) {
  if (windows.size() < kMinWindows) return std::nullopt;
  const auto rows = static_cast<Eigen::Index>(3 * windows.size());
  Eigen::MatrixXd a(rows, 7);
  Eigen::VectorXd b(rows);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    a.block<3, 1>(row, 0) = windows[i].acceleration_truth_mps2;
    a.block<3, 3>(row, 1) = -Matrix3d::Identity();
    a.block<3, 3>(row, 4) = windows[i].rotation;
    b.segment<3>(row) = windows[i].force_truth_mps2;
  }
  const Eigen::MatrixXd normal = a.transpose() * a;
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  const Eigen::VectorXd x = solver.solve(a.transpose() * b);
  const double variance = (b - a * x).squaredNorm() / static_cast<double>(rows - 7);
  const Eigen::MatrixXd covariance = variance * solver.solve(Eigen::MatrixXd::Identity(7, 7));
  AccelerometerFit fit;
  fit.slope = x[0];
  fit.slope_sigma = std::sqrt(std::max(0.0, covariance(0, 0)));
  fit.gravity_mps2 = x.segment<3>(1);
  fit.bias_mps2 = x.segment<3>(4);
  fit.bias_sigma_mps2 = std::sqrt(std::max(0.0, covariance.diagonal().segment<3>(4).maxCoeff()));
  return fit;
}

void fit_to_truth(const recording::Recording& recording, Inspection& out) {
  const auto fit = fit_windows(windows_of(recording, ImuPath(recording, *out.imu_alignment)));
  if (!fit || !fit->gravity_mps2.allFinite() || !fit->bias_mps2.allFinite()) return;
  ImuMeasurement& imu = *out.imu;
  // Gravity and bias are separated by rotation; where the recording rotates too little, neither is reported.
  if (fit->bias_sigma_mps2 < 0.15) {
    imu.accelerometer_bias_mps2 = fit->bias_mps2;
    if (!imu.gravity_mps2) {
      imu.gravity_mps2 = fit->gravity_mps2.norm();
      imu.gravity_source = "ground truth";
    }
  }
  if (fit->slope < -0.5 && fit->slope_sigma < 0.15) {
    out.add("accelerometer-sign", Severity::error,
            fmt::format("the accelerometer reads {:.2f} times (+- {:.2f}) the acceleration of the ground "
                        "truth: its sign is wrong",
                        fit->slope, fit->slope_sigma),
            "negate the accelerometer's values: it must read +9.81 m/s^2 upwards at rest");
  }
}

}  // namespace

void check_accelerometer(const recording::Recording& recording, Inspection& out) {
  if (!out.imu || out.has("imu-time-unit") || out.has("imu-out-of-order") || out.has("accelerometer-unit") ||
      out.has("accelerometer-without-gravity"))
    return;
  if (out.imu_alignment && out.imu_alignment->source == "ground truth" && !out.has("imu-unrelated") &&
      !out.has("gyroscope-unit"))
    fit_to_truth(recording, out);
  const ImuMeasurement& imu = *out.imu;
  if (imu.accelerometer_bias_mps2 && imu.accelerometer_bias_mps2->norm() > 1) {
    const Vector3d& bias = *imu.accelerometer_bias_mps2;
    out.add("accelerometer-bias", Severity::warning,
            fmt::format("the accelerometer's bias is {:.2f} m/s^2 ({:.2f}, {:.2f}, {:.2f})", bias.norm(),
                        bias.x(), bias.y(), bias.z()),
            "widen the prior of the bias, or correct the samples");
  }
  if (!imu.gravity_mps2 || std::abs(*imu.gravity_mps2 - kGravity_mps2) < 0.5) return;
  out.add("gravity-magnitude",
          std::abs(*imu.gravity_mps2 - kGravity_mps2) > 2 ? Severity::error : Severity::warning,
          fmt::format("gravity is {:.2f} m/s^2 ({}), not 9.81", *imu.gravity_mps2, imu.gravity_source),
          "the accelerometer has a scale error or a bias; see its calibration");
}

}  // namespace fusebench::inspection
