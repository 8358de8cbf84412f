// Gravity, sign and bias of the accelerometer, by ground truth where the recording never rests.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/force_windows.hpp"

namespace fusebench::inspection {

namespace {

constexpr std::size_t kMinWindows = 6;

struct AccelerometerFit {
  Vector3d gravity_mps2 = Vector3d::Zero();
  Vector3d bias_mps2 = Vector3d::Zero();
  double bias_sigma_mps2 = 0;  ///< of the worst axis
  double slope = 1;            ///< of the measured on the true acceleration
  double slope_sigma = 0;
};

/// mean(R A f) = slope * a - g + mean(R) b, for slope, g and b.
std::optional<AccelerometerFit> fit_windows(const std::vector<measures::ForceWindow>& windows,
                                            const Matrix3d& axes) {
  if (windows.size() < kMinWindows) return std::nullopt;
  const auto rows = static_cast<Eigen::Index>(3 * windows.size());
  Eigen::MatrixXd a(rows, 7);
  Eigen::VectorXd b(rows);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    a.block<3, 1>(row, 0) = windows[i].acceleration_mps2;
    a.block<3, 3>(row, 1) = -Matrix3d::Identity();
    a.block<3, 3>(row, 4) = windows[i].rotation;
    b.segment<3>(row) = windows[i].force(axes);
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
  const auto windows =
      measures::windows_by_truth(recording.imu, true_path(recording, out), out.imu->accelerometer_unit);
  const auto fit = fit_windows(windows, out.imu->accelerometer_axes.transpose());
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
  if (!out.imu || out.has("imu-time-unit") || out.has("imu-out-of-order") || out.imu->accelerometer_unit == 0)
    return;
  if (out.imu_alignment && out.imu_alignment->source == "ground truth" && !out.has("imu-unrelated") &&
      out.imu->gyroscope_unit != 0)
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
