// The IMU against the camera's turns: clock, unit, bias, and what they show of its axes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/geometry.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/signed_permutations.hpp"
#include "datasets/inspection/measures/turn_alignment.hpp"

namespace fusebench::inspection {

namespace {

constexpr double kMinExplained = 0.5;       // less than half of the variance: not the same motion
constexpr double kOffsetWarning_s = 0.004;  // an eighth of a frame
constexpr double kOffsetError_s = 0.010;
constexpr double kSwapTolerance_rad = radians(20);
constexpr double kMaxSwapTolerance_rad = radians(40);  // the nearest other permutation is 60 degrees off
constexpr double kKnown_rad = radians(3);              // largest uncertainty of a rotation that is reported
constexpr double kSigmas = 4;

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

/// A unit that a gyroscope's values may be in.
struct GyroscopeUnit {
  double per_radps;  ///< its values of 1 rad/s
  std::string_view text;
};
constexpr std::array<GyroscopeUnit, 5> kGyroscopeUnits = {
    GyroscopeUnit{kDegreesPerRadian, "its values are in degrees per second"},
    GyroscopeUnit{1 / kDegreesPerRadian, "its values were converted from degrees twice"},
    GyroscopeUnit{1000, "its values are in milliradians per second"},
    GyroscopeUnit{1000 * kDegreesPerRadian, "its values are in thousandths of a degree per second"},
    GyroscopeUnit{60 / (2 * std::numbers::pi), "its values are in revolutions per minute"}};
constexpr double kUnitScale = 1.25;  // how far a scale may be from 1 in the right unit
constexpr double kNoUnitScale = 2;   // beyond it, the unit is wrong whichever it is

bool is_near_one(double scale, double factor) { return scale < factor && scale > 1 / factor; }

void report_scale(const ImuAlignment& a, Inspection& out) {
  if (is_near_one(a.scale, 1.05)) return;
  const bool no_unit = !is_near_one(a.scale, kNoUnitScale);
  if (no_unit) out.imu->gyroscope_unit = 0;
  const bool by_images = a.source == "images";
  out.add(no_unit ? "gyroscope-unit" : "gyroscope-scale",
          std::abs(a.scale - 1) > 0.2 ? Severity::error : Severity::warning,
          no_unit
              ? fmt::format("the gyroscope turns {:.3g} times as far as the {}: its values are not in rad/s",
                            a.scale, a.source)
              : fmt::format("the gyroscope turns {:.3f} times as far as the {}", a.scale,
                            by_images ? "images: its scale, or the focal length, is off" : "ground truth"),
          by_images ? "check fx_px and fy_px of the calibration, then the gyroscope's unit"
                    : "check the gyroscope's unit");
}

void report_gyroscope_unit(const GyroscopeUnit& unit, Inspection& out) {
  out.imu->gyroscope_unit = 1 / unit.per_radps;
  out.add("gyroscope-unit", Severity::error,
          fmt::format("the gyroscope turns {:.4g} times as far as the camera: {}", unit.per_radps, unit.text),
          fmt::format("multiply them by {:.6g}", 1 / unit.per_radps));
}

void report_bias(Inspection& out) {
  const double bias = out.imu->gyroscope_bias_radps->norm();
  if (bias < 0.1 || out.imu->gyroscope_unit != 1) return;
  out.add("gyroscope-bias", Severity::warning,
          fmt::format("the gyroscope's bias is {:.3f} rad/s ({:.1f} deg/s), by the {}", bias,
                      kDegreesPerRadian * bias, out.imu->bias_source),
          "start from rest, or widen the prior of the bias");
}

/// The signed permutation of the calibrated axes that the turns show, and how well it does.
void choose_gyroscope_axes(const measures::TurnAlignment& fit, const Matrix3d& calibrated, ImuAlignment& a) {
  const auto all = measures::signed_permutations();
  const bool mirrored = fit.rotation_imu_camera.determinant() < 0;
  const auto candidates =
      mirrored ? all.subspan(measures::kProperPermutations) : all.first(measures::kProperPermutations);
  std::vector<double> costs;
  for (const Matrix3d& axes : candidates) costs.push_back(fit.cost_of(axes * calibrated));
  measures::AxesChoice choice = measures::choose_axes(costs, 0, fit.freedom);
  if (mirrored) {
    // That the axes are mirrored is known from the fit; the question is which of them.
    const auto best = std::ranges::min_element(costs);
    choice.index = static_cast<std::size_t>(best - costs.begin());
    choice.ratio = std::sqrt(*best / std::max(1e-300, fit.cost_of(calibrated)));
    choice.is_clear = fit.rotation_sigma_rad < kKnown_rad;
    choice.is_unique = choice.is_clear;
  }
  const Matrix3d& axes = candidates[choice.index];
  const double trace = (axes * calibrated).cwiseProduct(fit.rotation_imu_camera).sum();
  const double distance_rad = std::acos(std::clamp((std::abs(trace) - 1) / 2, -1.0, 1.0));
  const double tolerance_rad =
      std::min(kMaxSwapTolerance_rad, kSwapTolerance_rad + 2 * fit.rotation_sigma_rad);
  if (!choice.is_clear || distance_rad > tolerance_rad || costs[choice.index] > kMinExplained * fit.imu_rad2)
    return;
  a.axes = axes;
  a.axes_ratio = choice.ratio;
  a.axes_unique = choice.is_unique;
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
  choose_gyroscope_axes(fit, rig.T_imu_camera.rotation_matrix(), a);
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

/// The samples in rad/s.
std::vector<ImuSample> in_unit(std::vector<ImuSample> samples, const GyroscopeUnit& unit) {
  for (ImuSample& sample : samples) sample.angular_velocity_radps /= unit.per_radps;
  return samples;
}

/// Turns of the camera, and how those of the gyroscope fit them: in rad/s, or in the other unit that fits
/// best.
struct ComparedTurns {
  measures::CameraTurns turns;
  std::optional<measures::TurnAlignment> fit;
  std::optional<GyroscopeUnit> unit;  ///< nothing: rad/s

  ComparedTurns(measures::CameraTurns camera, const std::vector<ImuSample>& samples)
      : turns(std::move(camera)), fit(measures::align_turns(turns, measures::GyroscopeIntegral(samples))) {
    if (!fit || (related() && is_near_one(fit->scale, kUnitScale))) return;
    // Turns of more than half a revolution, as those of degrees that are read as radians, are ambiguous: the
    // scale of such a fit is not that of the units.
    for (const GyroscopeUnit& other : kGyroscopeUnits) {
      const auto refit = measures::align_turns(turns, measures::GyroscopeIntegral(in_unit(samples, other)));
      if (!refit || !is_related(*refit) || !is_near_one(refit->scale, kUnitScale)) continue;
      if (unit ? refit->explained <= fit->explained : refit->explained < fit->explained - 0.05) continue;
      fit = refit;
      unit = other;
    }
  }

  [[nodiscard]] static bool is_related(const measures::TurnAlignment& fit) {
    return fit.offset_found && fit.explained >= kMinExplained;
  }
  [[nodiscard]] bool related() const { return fit && is_related(*fit); }
};

/// With the ground truth, if there is one without errors. If the gyroscope disagrees with the ground truth,
/// the images decide which of the two is wrong.
ComparedTurns compare_turns(const recording::Recording& recording, const Workers& workers,
                            const InspectOptions& options, Inspection& out) {
  const auto by_images = [&] {
    return ComparedTurns(measures::turns_from_images(recording, workers, options.turn_samples),
                         recording.imu);
  };
  if (!truth_is_usable(out)) return by_images();
  ComparedTurns by_truth(measures::turns_from_truth(recording), recording.imu);
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

bool truth_is_usable(const Inspection& out) {
  return out.truth && out.truth->coverage > 0 &&
         std::ranges::none_of(out.findings, [](const Finding& finding) {
           return finding.severity == Severity::error && finding.code.starts_with("truth-");
         });
}

std::optional<ImuAlignment> align_imu_with_images(const recording::Recording& recording,
                                                  const Workers& workers) {
  if (recording.imu.empty() || recording.frames.size() < 2) return std::nullopt;
  const ComparedTurns compared(measures::turns_from_images(recording, workers, InspectOptions{}.turn_samples),
                               recording.imu);
  if (!compared.related() || compared.unit) return std::nullopt;
  return measured_alignment(*compared.fit, compared.turns, recording.rig);
}

void check_imu_alignment(const recording::Recording& recording, const Workers& workers,
                         const InspectOptions& options, Inspection& out) {
  if (!out.imu || out.has("imu-out-of-order") || out.has("imu-duplicate-stamp") || !times_are_plausible(out))
    return;
  const ComparedTurns compared = compare_turns(recording, workers, options, out);
  if (!compared.fit) {
    out.add("imu-alignment-untested", Severity::note,
            "the camera rotates too little, or too few rotations are measured, to compare the IMU with it");
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
  if (!out.imu->gyroscope_bias_radps && !compared.unit) {
    out.imu->gyroscope_bias_radps = a.gyroscope_bias_radps;
    out.imu->bias_source = a.source;
  }
  report_offset(a, out);
  if (compared.unit) {
    report_gyroscope_unit(*compared.unit, out);
  } else {
    report_scale(a, out);
  }
  if (out.imu->gyroscope_bias_radps) report_bias(out);
}

}  // namespace fusebench::inspection
