// Options: patches and their residuals.
#pragma once

#include "core/config/options.hpp"

namespace fusebench::config {

/// Where the depth and the normals of a patch's pixels come from.
enum class ReferenceSurface { model, frame, frame_ungated };
constexpr auto option_choices(ReferenceSurface) {
  return choices<ReferenceSurface>({{"model", ReferenceSurface::model},
                                    {"frame", ReferenceSurface::frame},
                                    {"frame_ungated", ReferenceSurface::frame_ungated}});
}

/// What happens to a patch that was tracked well.
enum class Refresh { each, keep };
constexpr auto option_choices(Refresh) {
  return choices<Refresh>({{"each", Refresh::each}, {"keep", Refresh::keep}});
}

/// When one of two pixels that land at one place is hidden by the other.
enum class ShrinkTest { depth_jump, any_collision };
constexpr auto option_choices(ShrinkTest) {
  return choices<ShrinkTest>(
      {{"depth_jump", ShrinkTest::depth_jump}, {"any_collision", ShrinkTest::any_collision}});
}

/// Patches: placement, size, and validity thresholds.
struct PatchConfig {
  int max_count = 100;
  int size_px = 10;
  int levels = 3;
  int fast_threshold = 7;
  int min_distance_px = 20;
  int min_valid_px = 30;
  double min_valid_fraction = 0.5;
  double max_mean_error = 30.0;
  double occlusion_distance_m = 0.1;
  ReferenceSurface reference_surface = ReferenceSurface::model;
  Refresh refresh = Refresh::each;
  ShrinkTest shrink_test = ShrinkTest::depth_jump;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("max_count", self.max_count, 1, 2000, "at most this many patches a frame (Sec. 3.1: 100)");
    v.number("size_px", self.size_px, 4, 64, "side of the square patch at each level (Sec. 3.1: 10)");
    v.number("levels", self.levels, 1, 6, "pyramid levels on which each patch is tracked");
    v.number("fast_threshold", self.fast_threshold, 1, 200,
             "FAST corner threshold (grey levels; Rosten & Drummond 2006); low, since the strongest corner "
             "of each "
             "cell is taken and blurred frames have only weak ones");
    v.number("min_distance_px", self.min_distance_px, 1, 500, "least distance between two patch centres");
    v.number("min_valid_px", self.min_valid_px, 1, 4096,
             "a patch with fewer usable pixels at level 0 is rejected (derived from 10x10 patches)");
    v.number("min_valid_fraction", self.min_valid_fraction, 0.0, 1.0,
             "a patch with a smaller share of usable pixels is rejected");
    v.number(
        "max_mean_error", self.max_mean_error, 1.0, 255.0,
        "a patch whose mean absolute error exceeds this is dropped after the update (grey levels, Sec. 2.3)");
    v.number("occlusion_distance_m", self.occlusion_distance_m, 0.001, 1.0,
             "a pixel whose predicted depth differs from the measured one by more is occluded, or is the "
             "surface that "
             "appeared behind it (twice as much while only coarse levels are in use); as wide as the "
             "association gate, "
             "since a tighter one drops every patch as soon as the pose has drifted by it");
    v.choice("reference_surface", self.reference_surface,
             "depth and normals of a patch: from the model (Sec. 2.3), from the frame that it is cut from "
             "(Sec. 2.1.1), or from that frame with no gate on its depth");
    v.choice("refresh", self.refresh,
             "a patch that was tracked well is cut again in each frame (Sec. 2.3), or is kept with the grey "
             "levels and the surface that it had until it is bad or the SE effect changes its shape; the "
             "error of an older frame's pose is then taken for that of the last one");
    v.choice("shrink_test", self.shrink_test,
             "of two pixels that land at one place the farther one is dropped if it is clearly farther, or "
             "always (Sec. 2.1.1 to the letter)");
  }
};

/// How the current image is read where a pixel lands.
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
        "this many residuals count as one measurement, since the pixels of a patch share their errors (blur, "
        "calibration, interpolation); 300 are all pixels of a 10x10 patch on three levels");
    v.number("gain_sigma", self.gain_sigma, 0.0, 10.0,
             "prior of the brightness gain of a patch around 1; 0 fixes it");
    v.number("offset_sigma_grey", self.offset_sigma_grey, 0.0, 255.0,
             "prior of the brightness offset of a patch around 0 (grey levels); 0 fixes it");
    v.choice("sampling", self.sampling,
             "the image is interpolated where a pixel lands, or read at the nearest whole pixel (Sec. 2.1.1 "
             "to the letter)");
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
             "this many residuals count as one measurement, since depth errors of neighbouring pixels have "
             "one cause; "
             "as for photometric residuals");
    v.number("common_error_share", self.common_error_share, 0.0, 10.0,
             "of the depth noise (standard deviations), what all measurements of a frame have in common: a "
             "fixed error of the depth sensor over its image, which the scatter between patches does not "
             "show; with an IMU the depth of one frame counts as at most 1 / share^2 measurements, 0: no "
             "limit");
    v.number("model_noise_m", self.model_noise_m, 0.0, 1.0,
             "noise of the model's surface, added to the depth's");
    v.number("max_distance_m", self.max_distance_m, 0.001, 2.0,
             "points further from their plane are not associated (KinectFusion's gate)");
    v.number("max_normal_angle_deg", self.max_normal_angle_deg, 1.0, 90.0,
             "associations whose normals differ by more are dropped (KinectFusion's gate is 30 degrees)");
  }
};

}  // namespace fusebench::config
