#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::calibration {

namespace {

std::string matrix_text(const SE3& T) {
  const Matrix3d R = T.rotation_matrix();
  std::vector<double> m;
  for (int row = 0; row < 3; ++row) m.insert(m.end(), {R(row, 0), R(row, 1), R(row, 2), T.translation[row]});
  return fmt::format("[{}]", fmt::join(m, ", "));
}

std::string pinhole_text(const PinholeCamera& p) {
  std::string text;
  if (p.width_px > 0) text += fmt::format("width_px = {}\nheight_px = {}\n", p.width_px, p.height_px);
  return text +
         fmt::format("fx_px = {}\nfy_px = {}\ncx_px = {}\ncy_px = {}\n", p.fx_px, p.fy_px, p.cx_px, p.cy_px);
}

/// What is said without an uncertainty is exact; what is not known is not said.
std::string timing_text(std::string_view name, double value_s, double sigma_s) {
  const auto [unknown_s, unknown_sigma_s] = name == "delay"
                                                ? std::pair{0.0, kUnknownDelaySigma_s}
                                                : std::pair{kUnknownReadout_s, kUnknownReadoutSigma_s};
  if (value_s == unknown_s && sigma_s == unknown_sigma_s) return "";
  const std::string text = fmt::format("{}_s = {}\n", name, value_s);
  return sigma_s > 0 ? text + fmt::format("{}_sigma_s = {}\n", name, sigma_s) : text;
}

/// Nothing of scales that leave everything as it is.
std::string scale_text(std::string_view name, const Vector3d& scale) {
  if (scale == Vector3d::Ones()) return {};
  return fmt::format("{} = [{}, {}, {}]\n", name, scale.x(), scale.y(), scale.z());
}

}  // namespace

std::string to_toml(const RigCalibration& calibration) {
  const BrownConrady& d = calibration.color.distortion;
  const SensorTiming& timing = calibration.color.timing;
  std::string text = fmt::format("calibration_source = {}\n\n[color]\n{}",
                                 config::to_toml(config::OptionValue(calibration.source)),
                                 pinhole_text(calibration.color.pinhole));
  text += fmt::format("distortion = [{}, {}, {}, {}, {}]\n{}", d.k1, d.k2, d.p1, d.p2, d.k3,
                      timing_text("readout", timing.color_readout_s, timing.color_readout_sigma_s));
  if (const Vector3d& offset_m = calibration.color.ground_truth_offset_m; !offset_m.isZero(0))
    text += fmt::format("ground_truth_offset_m = [{}, {}, {}]\n", offset_m.x(), offset_m.y(), offset_m.z());
  text += "\n[depth]\n";
  if (calibration.depth_units_per_metre)
    text += fmt::format("units_per_metre = {}\n", *calibration.depth_units_per_metre);
  if (calibration.depth) {
    text += pinhole_text(calibration.depth->pinhole) +
            fmt::format("T_color_depth = {}\n", matrix_text(calibration.depth->T_color_depth));
  }
  text += timing_text("readout", timing.depth_readout_s, timing.depth_readout_sigma_s) +
          timing_text("delay", timing.depth_delay_s, timing.depth_delay_sigma_s);
  if (!calibration.imu) return text;
  const ImuCalibration& imu = *calibration.imu;
  const ImuNoise& noise = imu.noise;
  return text +
         fmt::format(
             "\n[imu]\nT_imu_color = {}\ngyroscope_noise_radps_sqrthz = {}\n"
             "accelerometer_noise_mps2_sqrthz = {}\ngyroscope_bias_walk_radps2_sqrthz = {}\n"
             "accelerometer_bias_walk_mps3_sqrthz = {}\ntime_offset_s = {}\n",
             matrix_text(imu.T_imu_camera), noise.gyroscope_radps_sqrthz, noise.accelerometer_mps2_sqrthz,
             noise.gyroscope_bias_radps2_sqrthz, noise.accelerometer_bias_mps3_sqrthz, imu.time_offset_s) +
         scale_text("gyroscope_scale", imu.gyroscope_scale) +
         scale_text("accelerometer_scale", imu.accelerometer_scale);
}

}  // namespace fusebench::calibration
