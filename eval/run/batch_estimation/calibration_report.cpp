#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "eval/run/batch_estimation/calibration.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::batch_estimation {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = radians(1.0);

Json json_of(const Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json json_of(const SE3& T) {
  const Matrix3d R = T.rotation_matrix();
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rows.push_back(R(row, column));
    rows.push_back(T.translation[row]);
  }
  return rows;
}

Json json_of(const Known<Vector3d>& known) {
  return {{"value", json_of(known.value)}, {"sigma", json_of(known.sigma)}};
}

/// One line: three posterior values in a unit with their standard deviations, and the prior, the values that
/// the recording had before.
std::string line(std::string_view name, const Vector3d& posterior, const Vector3d& sigma,
                 const Vector3d& prior, std::string_view unit) {
  return fmt::format(
      "{:<28}{:>10.3f} {:>10.3f} {:>10.3f} {:<4} sigma {:.3f} {:.3f} {:.3f}; prior {:.3f} {:.3f} {:.3f}\n",
      name, posterior.x(), posterior.y(), posterior.z(), unit, sigma.x(), sigma.y(), sigma.z(), prior.x(),
      prior.y(), prior.z());
}

std::string known_line(std::string_view name, const Known<Vector3d>& known, double unit,
                       std::string_view unit_name) {
  return fmt::format("{:<28}{:>10.3f} {:>10.3f} {:>10.3f} {:<4} sigma {:.3f} {:.3f} {:.3f}\n", name,
                     known.value.x() / unit, known.value.y() / unit, known.value.z() / unit, unit_name,
                     known.sigma.x() / unit, known.sigma.y() / unit, known.sigma.z() / unit);
}

std::string undetermined_line(const Undetermined& u) {
  double unit = 1e-3;
  std::string_view unit_name = u.parameter == "translation" ? "mm" : "ms";
  if (u.parameter == "rotation") {
    unit = kDegree;
    unit_name = "deg";
  } else if (u.parameter.ends_with("_scale")) {
    unit = 0.01;
    unit_name = "%";
  }
  const std::string along =
      u.direction.isZero()
          ? std::string()
          : fmt::format(" {} ({:.2f}, {:.2f}, {:.2f})", u.parameter == "rotation" ? "about" : "along",
                        u.direction.x(), u.direction.y(), u.direction.z());
  return fmt::format("not determined by this motion: {}{} (sigma {:.3g} {})\n", u.parameter, along,
                     u.sigma / unit, unit_name);
}

/// A constant of the image sensors, before and after.
struct TimingRow {
  std::string_view key;
  std::string_view name;
  double value_s = 0;
  double sigma_s = 0;
  double before_s = 0;
  double before_sigma_s = 0;
};

std::array<TimingRow, 3> timing_rows(const CameraImuCalibration& c) {
  const SensorTiming& now = c.timing;
  const SensorTiming& before = c.timing_before;
  return {TimingRow{"color_readout", "read-out of colour", now.color_readout_s, now.color_readout_sigma_s,
                    before.color_readout_s, before.color_readout_sigma_s},
          TimingRow{"depth_readout", "read-out of depth", now.depth_readout_s, now.depth_readout_sigma_s,
                    before.depth_readout_s, before.depth_readout_sigma_s},
          TimingRow{"depth_delay", "depth after colour", now.depth_delay_s, now.depth_delay_sigma_s,
                    before.depth_delay_s, before.depth_delay_sigma_s}};
}

std::string sensor_lines(const CameraImuCalibration& c) {
  std::string text;
  for (const TimingRow& row : timing_rows(c)) {
    text += fmt::format("{:<28}{:>10.3f} ms   ", row.name, 1e3 * row.value_s);
    text += row.before_sigma_s > 0
                ? fmt::format("sigma {:.3f}; prior {:.3f}, sigma {:.3f}\n", 1e3 * row.sigma_s,
                              1e3 * row.before_s, 1e3 * row.before_sigma_s)
                : std::string("held: exact by the calibration\n");
    if (row.key.ends_with("readout") && row.value_s < 0)
      text += fmt::format("{:<28}0 in the calibration, since no read-out is below 0 ({:.1f} sigmas away)\n",
                          "", -row.value_s / row.sigma_s);
  }
  const auto scale = [&](std::string_view name, const Known<Vector3d>& known) {
    text += known.sigma.isZero() ? fmt::format("{:<28}held\n", name) : known_line(name, known, 1.0, "");
  };
  scale("gyroscope scale", c.gyroscope_scale);
  scale("accelerometer scale", c.accelerometer_scale);
  return text;
}

Json json_of_timing(const CameraImuCalibration& c) {
  Json timing = Json::object();
  for (const TimingRow& row : timing_rows(c)) {
    timing[std::string(row.key)] = {{"value_s", row.value_s},
                                    {"sigma_s", row.sigma_s},
                                    {"before_s", row.before_s},
                                    {"before_sigma_s", row.before_sigma_s}};
  }
  return timing;
}

}  // namespace

std::string to_text(const CameraImuCalibration& c, const recording::Recording& recording) {
  const Vector6d sigma = c.extrinsic_covariance.diagonal().cwiseSqrt();
  const Vector3d turn = so3_log(c.T_imu_camera.rotation);
  std::string text = fmt::format("{}: {} of {} frames tracked, {} rounds, {}\n", recording.name, c.tracked,
                                 c.frames, c.rounds.size(), c.converged ? "converged" : "still moving");
  if (recording.imu_source == recording::ImuSource::synthetic)
    text += "synthetic IMU: made from the ground truth; this says nothing about any sensor\n";
  text += line("rotation imu from camera", turn / kDegree, sigma.head<3>() / kDegree,
               so3_log(c.T_imu_camera_before.rotation) / kDegree, "deg");
  text += line("camera in the imu's axes", 1e3 * c.T_imu_camera.translation, 1e3 * sigma.tail<3>(),
               1e3 * c.T_imu_camera_before.translation, "mm");
  text += fmt::format("{:<28}{:>10.3f} ms   sigma {:.3f}; prior {:.3f}\n", "imu clock minus images'",
                      1e3 * c.time_offset_s, 1e3 * c.time_offset_sigma_s, 1e3 * c.time_offset_before_s);
  text += sensor_lines(c);
  text += known_line("gyroscope bias", c.gyroscope_bias_radps, 1e-3, "mrad/s");
  text += known_line("accelerometer bias", c.accelerometer_bias_mps2, 1e-3, "mm/s2");
  text += fmt::format("{:<28}{:>10.4f} {:>10.4f} {:>10.4f}      sigma {:.3f} deg\n",
                      "gravity in the first camera", c.gravity_direction_camera.x(),
                      c.gravity_direction_camera.y(), c.gravity_direction_camera.z(),
                      c.gravity_sigma_rad / kDegree);
  text += fmt::format(
      "scale: image residuals have {:.4f} times the variance that the filter claims, times {:.2f} for their\n"
      "correlation over frames (both are part of the sigma values above); inertial residuals {:.2f} times "
      "the noise of "
      "the\ncalibration; {} outliers\n",
      c.variance_factor, c.correlation_factor, c.inertial_variance_factor, c.outliers);
  text += fmt::format("timing within frames: {:.4f} times the claimed variance, times {:.2f}\n",
                      c.timing_variance_factor, c.timing_correlation_factor);
  for (const Undetermined& u : c.undetermined) text += undetermined_line(u);
  return text;
}

std::string to_json(const CameraImuCalibration& c, const recording::Recording& recording) {
  const Vector6d sigma = c.extrinsic_covariance.diagonal().cwiseSqrt();
  const double change_s = c.time_offset_s - c.time_offset_before_s;
  const Vector3d moved = c.T_imu_camera.translation - c.T_imu_camera_before.translation;
  Json rounds = Json::array();
  for (const CalibrationRound& round : c.rounds) {
    rounds.push_back({{"imu_noise_factor", round.imu_noise_factor},
                      {"T_imu_color", json_of(round.T_imu_camera)},
                      {"time_offset_s", round.time_offset_s},
                      {"timing_s", json_of(round.timing_s)}});
  }
  Json undetermined = Json::array();
  for (const Undetermined& u : c.undetermined)
    undetermined.push_back(
        {{"parameter", u.parameter}, {"direction", json_of(u.direction)}, {"sigma", u.sigma}});
  Json covariance = Json::array();
  for (int i = 0; i < 36; ++i) covariance.push_back(c.extrinsic_covariance(i / 6, i % 6));
  const Json document = {
      {"recording", recording.name},
      {"imu", recording::to_string(recording.imu_source)},
      {"frames", c.frames},
      {"tracked", c.tracked},
      {"converged", c.converged},
      {"T_imu_color", json_of(c.T_imu_camera)},
      {"T_imu_color_before", json_of(c.T_imu_camera_before)},
      {"rotation",
       {{"change_rad", json_of(c.rotation_change_rad)},
        {"sigma_rad", json_of(Vector3d(sigma.head<3>()))},
        {"change_sigmas", json_of(Vector3d(c.rotation_change_rad.cwiseQuotient(sigma.head<3>())))}}},
      {"translation",
       {{"change_m", json_of(moved)},
        {"sigma_m", json_of(Vector3d(sigma.tail<3>()))},
        {"change_sigmas", json_of(Vector3d(moved.cwiseQuotient(sigma.tail<3>())))}}},
      {"extrinsic_covariance", covariance},
      {"time_offset",
       {{"value_s", c.time_offset_s},
        {"sigma_s", c.time_offset_sigma_s},
        {"before_s", c.time_offset_before_s},
        {"change_sigmas", change_s / c.time_offset_sigma_s}}},
      {"timing", json_of_timing(c)},
      {"gyroscope_scale", json_of(c.gyroscope_scale)},
      {"accelerometer_scale", json_of(c.accelerometer_scale)},
      {"gyroscope_bias_radps", json_of(c.gyroscope_bias_radps)},
      {"accelerometer_bias_mps2", json_of(c.accelerometer_bias_mps2)},
      {"gravity",
       {{"direction_camera", json_of(c.gravity_direction_camera)}, {"sigma_rad", c.gravity_sigma_rad}}},
      {"variance_factor", c.variance_factor},
      {"correlation_factor", c.correlation_factor},
      {"timing_variance_factor", c.timing_variance_factor},
      {"timing_correlation_factor", c.timing_correlation_factor},
      {"inertial_variance_factor", c.inertial_variance_factor},
      {"outliers", c.outliers},
      {"rounds", rounds},
      {"undetermined", undetermined}};
  return text::json_text(document) + "\n";
}

}  // namespace fusebench::batch_estimation
