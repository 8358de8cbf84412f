// Options: residuals of patches and their weights.
#pragma once

#include "core/config/groups/option_choices.hpp"

namespace fusebench::config {

/// Sampling of the current image at a warped pixel.
enum class Sampling { bicubic, whole_pixel };
constexpr auto option_choices(Sampling) {
  return choices<Sampling>({{"bicubic", Sampling::bicubic}, {"whole_pixel", Sampling::whole_pixel}});
}

/// Photometric residuals (Eq. 3).
struct PhotometricConfig {
  double noise_grey = 8.0;
  double huber_sigmas = 1.345;
  double pixels_per_measurement = 300.0;
  double gain_sigma = 0.1;
  double offset_sigma_grey = 10.0;
  Sampling sampling = Sampling::bicubic;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("noise_grey", self.noise_grey, 0.1, 255.0,
             "standard deviation of an intensity residual (grey levels): sensor noise, blur and resampling");
    v.number(
        "huber_sigmas", self.huber_sigmas, 0.1, 1e6,
        "residuals beyond this many standard deviations lose weight (Huber 1964; 1.345 = 95 % efficiency)");
    v.number(
        "pixels_per_measurement", self.pixels_per_measurement, 1.0, 1000.0,
        "number of residuals that count as one measurement, because the pixels of a patch share their errors "
        "(blur, calibration, interpolation); 300 are all pixels of a 10x10 patch on three levels");
    v.number("gain_sigma", self.gain_sigma, 0.0, 10.0,
             "prior of the brightness gain of a patch around 1; 0 fixes it");
    v.number("offset_sigma_grey", self.offset_sigma_grey, 0.0, 255.0,
             "prior of the brightness offset of a patch around 0 (grey levels); 0 fixes it");
    v.choice("sampling", self.sampling,
             "intensity of a warped pixel: interpolated, or read at the nearest whole pixel (Sec. 2.1.1 as "
             "printed)");
  }
};

/// Point-to-plane residuals (Eq. 4).
struct GeometricConfig {
  double huber_sigmas = 0.7;
  double pixels_per_measurement = 300.0;
  double common_error_share = 0.1;
  double model_noise_m = 0.002;
  double max_distance_m = 0.1;
  double max_normal_angle_deg = 30.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("huber_sigmas", self.huber_sigmas, 0.1, 1e6,
             "residuals beyond this many standard deviations lose weight; low, close to the L1 norm of Eq. "
             "4, since "
             "depth has structured outliers");
    v.number("pixels_per_measurement", self.pixels_per_measurement, 1.0, 1000.0,
             "number of residuals that count as one measurement, because depth errors of neighbouring pixels "
             "are correlated; as for photometric residuals");
    v.number("common_error_share", self.common_error_share, 0.0, 10.0,
             "share of the depth noise (standard deviations) that all measurements of a frame have in "
             "common: a fixed pattern of the sensor, which the scatter between patches does not show. With "
             "an IMU, the depth of one frame counts as at most 1 / share^2 measurements; 0: no limit");
    v.number("model_noise_m", self.model_noise_m, 0.0, 1.0,
             "noise of the model's surface, added to the depth's");
    v.number("max_distance_m", self.max_distance_m, 0.001, 2.0,
             "points further from their plane are not associated (KinectFusion's gate)");
    v.number("max_normal_angle_deg", self.max_normal_angle_deg, 1.0, 90.0,
             "associations whose normals differ by more are dropped (KinectFusion's gate is 30 degrees)");
  }
};

}  // namespace fusebench::config
