// Axes of gyroscope and accelerometer, each on its own: which exchange of axes fits the turns of the camera,
// and which one fits gravity and the acceleration of the path.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/geometry.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/signed_permutations.hpp"

namespace fusebench::inspection {

namespace {

constexpr double kRotationWarning_rad = radians(2);
constexpr double kRotationError_rad = radians(5);
constexpr double kRotatedFar_rad = radians(30);
constexpr double kAxesKnown_rad = radians(3);  // largest uncertainty of a small rotation that is reported
constexpr double kRotationSigmas = 4;

std::string matrix_text(const Matrix3d& m) {
  return fmt::format("[{:.4f} {:.4f} {:.4f}; {:.4f} {:.4f} {:.4f}; {:.4f} {:.4f} {:.4f}]", m(0, 0), m(0, 1),
                     m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2));
}

std::size_t index_of(const Matrix3d& permutation) {
  const auto all = measures::signed_permutations();
  return static_cast<std::size_t>(std::ranges::find(all, permutation) - all.begin());
}

/// What the axes of a sensor hold, and how much better that fits: "swapped: its (x, y, z) hold (y, -x, z) of
/// ...".
std::string axes_text(const Matrix3d& axes, double ratio, bool is_unique) {
  return fmt::format(
      "{}: its (x, y, z) hold {} of the axes that T_imu_color describes (residuals {:.2f} times those of "
      "the "
      "axes as calibrated{})",
      axes.determinant() < 0 ? "swapped and mirrored" : "swapped", measures::permutation_text(axes), ratio,
      is_unique ? "" : "; other exchanges fit nearly as well");
}

/// What restores the calibrated axes: the columns of the file in the order in which they have to stand.
std::string columns_text(const Matrix3d& axes) { return measures::permutation_text(axes.transpose()); }

/// The images show the turns of a mirrored camera as those of a camera that is turned by half a revolution.
std::string images_hint(const ImuAlignment& a, const Matrix3d& calibrated) {
  if (a.source != "images") return "";
  const Matrix3d in_camera = calibrated.transpose() * a.axes * calibrated;
  const bool is_half_turn = in_camera.trace() < -0.9 && in_camera.diagonal().cwiseAbs().minCoeff() > 0.9;
  return is_half_turn ? "; or the images are mirrored or upside down" : "";
}

/// No rotation fits: the axes are left-handed.
void report_mirrored(const ImuAlignment& a, Inspection& out) {
  const bool is_named = !a.axes.isIdentity();
  out.add(
      "imu-axes-swapped", Severity::error,
      "the axes of the IMU are " +
          (is_named ? axes_text(a.axes, a.axes_ratio, a.axes_unique)
                    : fmt::format("mirrored: only a reflection fits the turns of the {}", a.source)),
      (is_named ? fmt::format("write the columns (x, y, z) of the IMU's file as {}: ", columns_text(a.axes))
                : std::string("exchange the columns of the IMU's file, or negate one: ")) +
          "no rotation repairs a mirrored sensor");
}

void report_swapped(const ImuAlignment& a, const Matrix3d& calibrated, Inspection& out) {
  if (a.axes.determinant() < 0) {
    report_mirrored(a, out);
    return;
  }
  const Matrix3d rotation =
      a.rotation_sigma_rad < kAxesKnown_rad ? a.rotation_imu_camera : a.axes * calibrated;
  out.add("imu-axes-swapped", Severity::error,
          "the axes of the IMU are " + axes_text(a.axes, a.axes_ratio, a.axes_unique),
          fmt::format("write the columns (x, y, z) of the IMU's file as {}, or set the rotation of "
                      "T_imu_color in [imu] of calibration.toml to {}{}",
                      columns_text(a.axes), matrix_text(rotation), images_hint(a, calibrated)));
}

void report_sensor(std::string_view sensor, const Matrix3d& axes, double ratio, bool is_unique,
                   std::string_view other, Inspection& out) {
  out.add(fmt::format("{}-axes", sensor), Severity::error,
          fmt::format("the axes of the {} are {}; those of the {} are not", sensor,
                      axes_text(axes, ratio, is_unique), other),
          fmt::format("write the columns (x, y, z) of the {} in the IMU's file as {}", sensor,
                      columns_text(axes)));
}

/// A rotation that is no exchange of axes.
void report_rotation(const ImuAlignment& a, Inspection& out) {
  if (!a.rotation_error_rad) {
    report_mirrored(a, out);
    return;
  }
  const double error_rad = *a.rotation_error_rad;
  const bool is_far = error_rad >= kRotatedFar_rad;
  const bool is_known = is_far || a.rotation_sigma_rad < kAxesKnown_rad;
  if (error_rad < kRotationWarning_rad || error_rad < kRotationSigmas * a.rotation_sigma_rad || !is_known)
    return;
  out.add(is_far ? "imu-axes-swapped" : "extrinsic-rotated",
          error_rad >= kRotationError_rad ? Severity::error : Severity::warning,
          fmt::format("the rotation of T_imu_color is {:.1f} deg (+- {:.1f}) from the one that fits the "
                      "turns of the {} best",
                      kDegreesPerRadian * error_rad, kDegreesPerRadian * a.rotation_sigma_rad, a.source),
          fmt::format("the best rotation for T_imu_color in [imu] of calibration.toml is {}",
                      matrix_text(a.rotation_imu_camera)));
}

/// The accelerometer's axes against those in which the turns are known: of the ground truth, or of the
/// gyroscope when its own exchange of axes is corrected. Nothing where neither is observable.
std::optional<measures::AxesChoice> accelerometer_axes(const recording::Recording& recording,
                                                       const Matrix3d& gyroscope_axes,
                                                       const Inspection& out) {
  const ImuMeasurement& imu = *out.imu;
  if (imu.accelerometer_unit == 0) return std::nullopt;
  std::size_t given = index_of(gyroscope_axes);
  if (truth_is_usable(out)) {
    const auto windows =
        measures::windows_by_truth(recording.imu, true_path(recording, out), imu.accelerometer_unit);
    if (auto choice = measures::choose_accelerometer_axes(windows, given, true)) return choice;
  }
  if (imu.gyroscope_unit != 1) return std::nullopt;
  if (given >= measures::kProperPermutations) given = index_of(-gyroscope_axes);
  const auto windows =
      measures::windows_by_gyroscope(recording.imu, imu.gyroscope_bias_radps.value_or(Vector3d::Zero()),
                                     gyroscope_axes, imu.accelerometer_unit);
  return measures::choose_accelerometer_axes(windows, given, false);
}

}  // namespace

measures::TruePath true_path(const recording::Recording& recording, const Inspection& out) {
  Matrix3d rotation_imu_camera = recording.rig.T_imu_camera.rotation_matrix();
  double offset_s = 0;
  if (const auto& a = out.imu_alignment) {
    offset_s = a->time_offset_s;
    const Matrix3d measured = a->axes.transpose() * a->rotation_imu_camera;
    if (a->rotation_sigma_rad < kAxesKnown_rad && measured.determinant() > 0) rotation_imu_camera = measured;
  }
  return {recording.ground_truth, truth_gap_ns(recording), offset_s, rotation_imu_camera.transpose(),
          recording.rig.T_imu_camera.inverse().translation};
}

void check_imu_axes(const recording::Recording& recording, Inspection& out) {
  if (!out.imu || out.has("imu-out-of-order") || out.has("imu-duplicate-stamp") || out.has("imu-unrelated") ||
      !times_are_plausible(out))
    return;
  const auto& a = out.imu_alignment;
  // Mirrored images show other turns, and say nothing of the IMU.
  if (a && a->source == "images" && out.has("color-mirrored")) return;
  const Matrix3d calibrated = recording.rig.T_imu_camera.rotation_matrix();
  const Matrix3d gyroscope = a ? a->axes : Matrix3d::Identity();
  const bool is_swapped = !gyroscope.isIdentity();
  const bool is_mirrored = a && !a->rotation_error_rad && !is_swapped;
  out.imu->accelerometer_axes = gyroscope;
  const auto choice = is_mirrored ? std::nullopt : accelerometer_axes(recording, gyroscope, out);
  const Matrix3d accelerometer =
      choice && choice->is_clear ? measures::signed_permutations()[choice->index] : gyroscope;
  // A wrong sign is not one of the axes.
  const bool is_apart = accelerometer != gyroscope && accelerometer != -gyroscope;
  if (is_apart) {
    out.imu->accelerometer_axes = accelerometer;
    if (is_swapped)
      report_sensor("gyroscope", gyroscope, a->axes_ratio, a->axes_unique, "accelerometer", out);
    if (!accelerometer.isIdentity())
      report_sensor("accelerometer", accelerometer, choice->ratio, choice->is_unique, "gyroscope", out);
  } else if (is_swapped) {
    report_swapped(*a, calibrated, out);
  } else if (a) {
    report_rotation(*a, out);
  }
}

}  // namespace fusebench::inspection
