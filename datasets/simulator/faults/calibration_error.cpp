#include "datasets/simulator/faults/calibration_error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>

#include "datasets/simulator/random/random_numbers.hpp"

namespace fusebench::simulator::faults {

namespace {

constexpr std::uint64_t kCalibrationError = 0xCE;  // key of an independent random stream

constexpr double kMax_deg = 45;
constexpr double kMax_cm = 50;

/// Uniform on the unit sphere.
Vector3d direction(random::RandomSequence& random) {
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

}  // namespace

Result<CalibrationError> parse_calibration_error(std::string_view text) {
  CalibrationError error;
  const char* const end = text.data() + text.size();
  const auto rotation = std::from_chars(text.data(), end, error.rotation_deg);
  const bool colon = rotation.ec == std::errc{} && rotation.ptr != end && *rotation.ptr == ':';
  const auto shift = colon ? std::from_chars(rotation.ptr + 1, end, error.shift_cm) : rotation;
  if (colon && shift.ec == std::errc{} && shift.ptr == end) return error;
  return fail(ErrorCode::usage, fmt::format("calibration error {} (allowed: DEGREES:CENTIMETRES)", text),
              "e.g. --calibration-error 1:2");
}

Result<void> check_calibration_error(const CalibrationError& error) {
  if (!(error.rotation_deg >= 0 && error.rotation_deg <= kMax_deg)) {
    return fail(
        ErrorCode::configuration,
        fmt::format("calibration error's rotation_deg = {} (allowed 0 .. {})", error.rotation_deg, kMax_deg));
  }
  if (!(error.shift_cm >= 0 && error.shift_cm <= kMax_cm)) {
    return fail(ErrorCode::configuration,
                fmt::format("calibration error's shift_cm = {} (allowed 0 .. {})", error.shift_cm, kMax_cm));
  }
  return {};
}

SE3 miscalibrated(const SE3& T_imu_camera, const CalibrationError& error, std::uint64_t seed) {
  if (error.is_zero()) return T_imu_camera;
  random::RandomSequence random(random::mix_key(seed, kCalibrationError));
  const Vector3d axis = direction(random);
  const Vector3d towards = direction(random);
  return {T_imu_camera.rotation * so3_exp(radians(error.rotation_deg) * axis),
          T_imu_camera.translation + 0.01 * error.shift_cm * towards};
}

}  // namespace fusebench::simulator::faults
