// The IMU against the camera's turns: clock, axes, unit, bias.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/geometry.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/turn_alignment.hpp"

namespace fusebench::inspection {

namespace {

constexpr double kMinExplained = 0.5;       // less than half of the variance: not the same motion
constexpr double kOffsetWarning_s = 0.004;  // an eighth of a frame
constexpr double kOffsetError_s = 0.010;
constexpr double kRotationWarning_rad = radians(2);
constexpr double kRotationError_rad = radians(5);
constexpr double kSwapTolerance_rad = radians(20);
constexpr double kKnown_rad = radians(3);  // largest uncertainty of a rotation that is reported
constexpr double kSigmas = 4;

struct SignedPermutation {
  Matrix3d matrix = Matrix3d::Identity();
  double distance_rad = 0;  ///< of the given matrix from it
};

/// The nearest of the 24 that have the determinant of the given orthogonal matrix.
SignedPermutation nearest_permutation(const Matrix3d& given) {
  SignedPermutation best;
  double best_trace = -4;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d candidate = Matrix3d::Zero();
      for (int row = 0; row < 3; ++row)
        candidate(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1) == 0 ? 1 : -1;
      if (candidate.determinant() * given.determinant() < 0) continue;
      const double trace = (candidate.transpose() * given).trace();
      if (trace > best_trace) {
        best_trace = trace;
        best.matrix = candidate;
      }
    }
  } while (std::ranges::next_permutation(order).found);
  best.distance_rad = std::acos(std::clamp((best_trace - 1) / 2, -1.0, 1.0));
  return best;
}

/// "(y, -x, z)": what the measured axes hold in terms of the calibrated ones.
std::string permutation_text(const Matrix3d& permutation) {
  constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
  std::string text = "(";
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double value = permutation(row, column);
      if (value == 0) continue;
      text += fmt::format("{}{}{}", row == 0 ? "" : ", ", value < 0 ? "-" : "",
                          kNames[static_cast<std::size_t>(column)]);
    }
  }
  return text + ")";
}

std::string matrix_text(const Matrix3d& m) {
  return fmt::format("[{:.4f} {:.4f} {:.4f}; {:.4f} {:.4f} {:.4f}; {:.4f} {:.4f} {:.4f}]", m(0, 0), m(0, 1),
                     m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2));
}

void report_offset(const ImuAlignment& a, Inspection& out) {
  const double offset_s = std::abs(a.time_offset_s);
  if (offset_s < kOffsetWarning_s || offset_s < kSigmas * a.time_offset_sigma_s) return;
  out.add(
      "imu-time-offset", offset_s >= kOffsetError_s ? Severity::error : Severity::warning,
      fmt::format("the IMU's stamps are {:.1f} ms (+- {:.1f}) {} than those of the {} for the same instant",
                  1e3 * offset_s, 1e3 * a.time_offset_sigma_s, a.time_offset_s > 0 ? "later" : "earlier",
                  a.source),
      fmt::format("add {:+.4f} to time_offset_s in [imu] of calibration.toml", a.time_offset_s));
}

/// No rotation fits: the axes are exchanged or negated so that they are left-handed.
void report_mirrored(const ImuAlignment& a, const SignedPermutation& nearest, Inspection& out) {
  const std::string hold =
      nearest.distance_rad < kSwapTolerance_rad && a.rotation_sigma_rad < kKnown_rad
          ? fmt::format("swapped and mirrored: its (x, y, z) hold {} of the axes that T_imu_camera describes",
                        permutation_text(nearest.matrix))
          : fmt::format("mirrored: only a reflection fits the turns of the {}", a.source);
  out.add("imu-axes-swapped", Severity::error, "the axes of the IMU are " + hold,
          "exchange the columns of the IMU's file, or negate one: no rotation repairs a mirrored sensor");
}

/// Whether the axes are as calibrated.
void report_rotation(const ImuAlignment& a, const Matrix3d& calibrated, Inspection& out) {
  const Matrix3d measured_calibrated = a.rotation_imu_camera * calibrated.transpose();
  const SignedPermutation nearest = nearest_permutation(measured_calibrated);
  if (!a.rotation_error_rad) {
    report_mirrored(a, nearest, out);
    return;
  }
  const bool identity = nearest.matrix.isIdentity();
  const bool known = a.rotation_sigma_rad < kKnown_rad;
  if (!identity && nearest.distance_rad < kSwapTolerance_rad && known) {
    out.add(
        "imu-axes-swapped", Severity::error,
        fmt::format("the axes of the IMU are swapped: its (x, y, z) hold {} of the axes that T_imu_camera "
                    "describes",
                    permutation_text(nearest.matrix)),
        fmt::format("exchange the columns of the IMU's file, or set the rotation of T_imu_color in [imu] of "
                    "calibration.toml to {}",
                    matrix_text(a.rotation_imu_camera)));
    return;
  }
  const double error_rad = *a.rotation_error_rad;
  if (error_rad < kRotationWarning_rad || error_rad < kSigmas * a.rotation_sigma_rad || !known) return;
  out.add("extrinsic-rotated", error_rad >= kRotationError_rad ? Severity::error : Severity::warning,
          fmt::format("the rotation of T_imu_camera is {:.1f} deg (+- {:.1f}) from the one that fits the "
                      "turns of the {} best",
                      kDegreesPerRadian * error_rad, kDegreesPerRadian * a.rotation_sigma_rad, a.source),
          fmt::format("the best rotation for T_imu_color in [imu] of calibration.toml is {}",
                      matrix_text(a.rotation_imu_camera)));
}

/// A factor of the gyroscope by which its values would be in degrees, or 1.
double unit_of(double scale) {
  const double magnitude = std::abs(scale);
  if (magnitude > 0.8 * kDegreesPerRadian && magnitude < 1.25 * kDegreesPerRadian) return kDegreesPerRadian;
  if (magnitude > 0.8 / kDegreesPerRadian && magnitude < 1.25 / kDegreesPerRadian)
    return 1 / kDegreesPerRadian;
  return 1;
}

void report_scale(const ImuAlignment& a, Inspection& out) {
  const double unit = unit_of(a.scale);
  if (unit != 1) {
    out.add("gyroscope-unit", Severity::error,
            fmt::format("the gyroscope turns {:.4g} times as far as the camera: its values {}", a.scale,
                        unit > 1 ? "are in degrees per second" : "were converted from degrees twice"),
            fmt::format("multiply them by {:.6g}", 1 / unit));
    return;
  }
  if (std::abs(a.scale - 1) < 0.05) return;
  out.add(
      "gyroscope-scale", std::abs(a.scale - 1) > 0.2 ? Severity::error : Severity::warning,
      fmt::format("the gyroscope turns {:.3f} times as far as the {}", a.scale,
                  a.source == "images" ? "images: its scale, or the focal length, is off" : "ground truth"),
      a.source == "images" ? "check fx_px and fy_px of the calibration, then the gyroscope's unit"
                           : "check the gyroscope's unit");
}

void report_bias(const ImuAlignment& a, Inspection& out) {
  const double bias = out.imu->gyroscope_bias_radps->norm();
  if (bias < 0.1 || unit_of(a.scale) != 1) return;
  out.add("gyroscope-bias", Severity::warning,
          fmt::format("the gyroscope's bias is {:.3f} rad/s ({:.1f} deg/s), by the {}", bias,
                      kDegreesPerRadian * bias, out.imu->bias_source),
          "start from rest, or widen the prior of the bias");
}

ImuAlignment measured_alignment(const measures::TurnAlignment& fit, const measures::CameraTurns& turns,
                                const SensorRig& rig) {
  ImuAlignment a;
  a.source = turns.source;
  a.intervals = fit.intervals;
  a.time_offset_s = fit.time_offset_s;
  a.time_offset_sigma_s = fit.time_offset_sigma_s;
  a.rotation_imu_camera = fit.rotation_imu_camera;
  a.rotation_sigma_rad = fit.rotation_sigma_rad;
  a.scale = fit.scale;
  a.gyroscope_bias_radps = fit.bias_radps;
  a.residual_radps = fit.residual_radps;
  a.explained = fit.explained;
  if (fit.rotation_imu_camera.determinant() < 0) return a;
  const Matrix3d difference = fit.rotation_imu_camera * rig.T_imu_camera.rotation_matrix().transpose();
  a.rotation_error_rad = std::acos(std::clamp((difference.trace() - 1) / 2, -1.0, 1.0));
  return a;
}

std::vector<TurnRate> rates_of(const measures::CameraTurns& turns, std::int64_t origin_ns) {
  std::vector<TurnRate> rates;
  for (const measures::CameraTurn& turn : turns.turns) {
    rates.push_back(
        {0.5 * (seconds_between(origin_ns, turn.begin_ns) + seconds_between(origin_ns, turn.end_ns)),
         turn.turn_rad.norm() / seconds_between(turn.begin_ns, turn.end_ns)});
  }
  return rates;
}

/// Whether the poses, by what was found so far, are those of the camera at their stamps.
bool truth_is_usable(const Inspection& out) {
  return out.truth && out.truth->coverage > 0 &&
         std::ranges::none_of(out.findings, [](const Finding& finding) {
           return finding.severity == Severity::error && finding.code.starts_with("truth-");
         });
}

/// Turns of the camera, and how those of the gyroscope fit them.
struct ComparedTurns {
  measures::CameraTurns turns;
  std::optional<measures::TurnAlignment> fit;

  ComparedTurns(measures::CameraTurns camera, const measures::GyroscopeIntegral& gyroscope)
      : turns(std::move(camera)), fit(measures::align_turns(turns, gyroscope)) {}

  [[nodiscard]] bool related() const { return fit && fit->offset_found && fit->explained >= kMinExplained; }
};

/// With the truth, if there is one without errors. If the gyroscope disagrees with the truth, the images
/// decide which of the two is wrong.
ComparedTurns compare_turns(const recording::Recording& recording, const Workers& workers,
                            const InspectOptions& options, Inspection& out) {
  const measures::GyroscopeIntegral gyroscope(recording.imu);
  const auto by_images = [&] {
    return ComparedTurns(measures::turns_from_images(recording, workers, options.turn_samples), gyroscope);
  };
  if (!truth_is_usable(out)) return by_images();
  ComparedTurns by_truth(measures::turns_from_truth(recording), gyroscope);
  if (!by_truth.fit || by_truth.related()) return by_truth;
  ComparedTurns other = by_images();
  if (!other.related()) return by_truth;
  out.add("truth-inconsistent", Severity::error,
          "the ground truth does not turn as the images and the IMU do, which agree with each other",
          "check that the ground truth is that of the colour camera, of this recording and of its clock");
  return other;
}

void report_unrelated(const ComparedTurns& compared, Inspection& out) {
  const std::string why =
      compared.fit->offset_found
          ? fmt::format("the turns of the {} explain {:.0f} % of the gyroscope's", compared.turns.source,
                        100 * std::max(0.0, compared.fit->explained))
          : fmt::format("no time offset within +-0.5 s fits it best to the turns of the {}",
                        compared.turns.source);
  out.add("imu-unrelated", Severity::error, "the IMU does not turn as the camera does: " + why,
          "check that the IMU's file is of this recording, its clock (offsets up to 0.5 s are searched), and "
          "the order of its columns (angular velocity first)");
}

}  // namespace

std::optional<ImuAlignment> align_imu_with_images(const recording::Recording& recording,
                                                  const Workers& workers) {
  if (recording.imu.empty() || recording.frames.size() < 2) return std::nullopt;
  const ComparedTurns compared(measures::turns_from_images(recording, workers, InspectOptions{}.turn_samples),
                               measures::GyroscopeIntegral(recording.imu));
  if (!compared.related()) return std::nullopt;
  return measured_alignment(*compared.fit, compared.turns, recording.rig);
}

void check_imu_alignment(const recording::Recording& recording, const Workers& workers,
                         const InspectOptions& options, Inspection& out) {
  if (!out.imu || out.has("imu-out-of-order") || out.has("imu-duplicate-stamp") || !times_are_plausible(out))
    return;
  const ComparedTurns compared = compare_turns(recording, workers, options, out);
  if (!compared.fit) {
    out.add("imu-alignment-untested", Severity::note,
            "the camera turns too little, or too few turns are known, to compare the IMU with it");
    return;
  }
  if (compared.fit->offset_found) {
    out.imu_alignment = measured_alignment(*compared.fit, compared.turns, recording.rig);
    out.imu_alignment->rates = rates_of(compared.turns, recording.frames.front().timestamp_ns);
  }
  if (!compared.related()) {
    report_unrelated(compared, out);
    return;
  }
  const ImuAlignment& a = *out.imu_alignment;
  if (!out.imu->gyroscope_bias_radps) {
    out.imu->gyroscope_bias_radps = a.gyroscope_bias_radps;
    out.imu->bias_source = a.source;
  }
  report_offset(a, out);
  report_rotation(a, recording.rig.T_imu_camera.rotation_matrix(), out);
  report_scale(a, out);
  report_bias(a, out);
}

}  // namespace fusebench::inspection
