// Every option of the estimator, declared once: name, default, range and one sentence (with its source).
// The file reader, --set, range checks, `fusebench config`, docs/configuration.md and the configuration hash
// all derive from the visit() of each struct (see options.hpp). A field without an option does not compile.
#pragma once

#include "core/config/options.hpp"

namespace fusebench::config {

/// What predicts the state between frames.
enum class Prior { imu, constant_velocity };
constexpr auto option_choices(Prior) {
  return choices<Prior>({{"imu", Prior::imu}, {"constant_velocity", Prior::constant_velocity}});
}

/// How a patch changes its shape between frames.
enum class Deformation { pixelwise, planar, rigid_square };
constexpr auto option_choices(Deformation) {
  return choices<Deformation>({{"pixelwise", Deformation::pixelwise},
                               {"planar", Deformation::planar},
                               {"rigid_square", Deformation::rigid_square}});
}

/// The terms of the estimator that an ablation switches.
struct TermsConfig {
  Prior prior = Prior::imu;
  Deformation deformation = Deformation::pixelwise;
  bool visibility_test = true;
  bool motion_compensation = true;
  bool relocalisation = true;
  double photometric_weight = 1.0;
  double geometric_weight = 1.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.choice("prior", self.prior, "what predicts the state: the IMU (Eqs. 11-14) or constant velocity");
    v.choice(
        "deformation", self.deformation,
        "shape change of patches: each pixel by its own depth (Eqs. 1-2), one plane a patch (Bloesch et al. "
        "2017), or a rigid square at one depth (the direct method)");
    v.flag("visibility_test", self.visibility_test,
           "drop pixels that are occluded in the current frame (the shrink effect, Sec. 2.1.1)");
    v.flag("motion_compensation", self.motion_compensation,
           "bring all rows of colour and depth to one instant by the estimated velocity (rolling shutter, "
           "depth delay; "
           "not in the paper)");
    v.flag(
        "relocalisation", self.relocalisation,
        "a lost tracker looks for the frame's place among the frames that it fused (ORB features and their "
        "3D points; Mur-Artal & Tardos 2017; not in the paper)");
    v.number("photometric_weight", self.photometric_weight, 0.0, 1e3,
             "factor on the information of the photometric residuals (Eq. 3); 0 switches the term off");
    v.number("geometric_weight", self.geometric_weight, 0.0, 1e3,
             "factor on the information of the point-to-plane residuals (Eq. 4); 0 switches the term off");
  }
};

/// Which depth measurements are trusted, and how far.
struct DepthConfig {
  double min_m = 0.3;
  double max_m = 5.0;
  double noise_floor_m = 0.0012;
  double noise_quadratic_per_m = 0.0019;
  double noise_offset_m = 0.4;
  double edge_jump = 0.03;
  double max_incidence_deg = 75.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("min_m", self.min_m, 0.0, 100.0, "depth below this is ignored (metres)");
    v.number("max_m", self.max_m, 0.01, 100.0, "depth above this is ignored (metres)");
    v.number(
        "noise_floor_m", self.noise_floor_m, 1e-5, 1.0,
        "a in the depth noise sigma(z) = a + b (z - c)^2 (metres; Nguyen et al. 2012 for structured light)");
    v.number("noise_quadratic_per_m", self.noise_quadratic_per_m, 0.0, 1.0, "b of the depth noise (1/m)");
    v.number("noise_offset_m", self.noise_offset_m, 0.0, 10.0, "c of the depth noise (metres)");
    v.number(
        "edge_jump", self.edge_jump, 0.001, 1.0,
        "a pixel whose 3x3 neighbourhood jumps by more than this share of its depth is an edge and not used");
    v.number("max_incidence_deg", self.max_incidence_deg, 10.0, 89.0,
             "surfaces seen more obliquely than this are not used (degrees between ray and normal)");
  }
};

/// Process noise of the priors. IMU densities come with the recording; here is what comes on top.
struct MotionConfig {
  double imu_noise_factor = 1.0;
  double acceleration_noise_mps2_sqrthz = 1.5;
  double angular_acceleration_noise_radps2_sqrthz = 3.0;
  double gravity_noise_rad_sqrthz = 1e-5;
  double drift_factor = 10.0;
  double exposure_s = 0.01;

  static constexpr void visit(auto& self, auto&& v) {
    v.number(
        "imu_noise_factor", self.imu_noise_factor, 0.01, 1000.0,
        "factor on the recording's IMU noise densities (>1 absorbs what they leave out, e.g. scale errors)");
    v.number(
        "acceleration_noise_mps2_sqrthz", self.acceleration_noise_mps2_sqrthz, 1e-3, 1e3,
        "constant-velocity prior: white acceleration (m/s^2/sqrt(Hz)); hand-held motion changes its velocity "
        "by about 0.3 m/s between frames at 30 Hz");
    v.number(
        "angular_acceleration_noise_radps2_sqrthz", self.angular_acceleration_noise_radps2_sqrthz, 1e-3, 1e3,
        "constant-velocity prior: white angular acceleration (rad/s^2/sqrt(Hz)); about 0.5 rad/s a frame");
    v.number("gravity_noise_rad_sqrthz", self.gravity_noise_rad_sqrthz, 0.0, 1.0,
             "random walk of the gravity direction against the map (rad/sqrt(Hz)), for the map's slow tilt");
    v.number(
        "drift_factor", self.drift_factor, 1.0, 100.0,
        "the model drifts this much more than independent errors of the frames would make it (standard "
        "deviations): consecutive frames see the same patches on the same model, so their errors are alike; "
        "only the reported uncertainty depends on it; chosen so that the NEES of simulated slow runs is near "
        "1 (1.1 to 1.3; 0.6 to 0.8 under fast motion)");
    v.number(
        "exposure_s", self.exposure_s, 0.0, 0.5,
        "exposure of a colour image, from which motion blur is predicted (seconds; no format records it, "
        "10 ms is usual indoors)");
  }
};

/// The first state.
struct InitialisationConfig {
  double window_s = 0.25;
  double rest_gyroscope_std_radps = 0.02;
  double rest_accelerometer_std_mps2 = 0.15;
  double rest_velocity_sigma_mps = 0.02;
  double moving_velocity_sigma_mps = 1.0;
  double moving_gravity_sigma_rad = 0.15;
  double angular_velocity_sigma_radps = 1.5;
  double gyroscope_bias_sigma_radps = 0.005;
  double accelerometer_bias_sigma_mps2 = 0.3;
  double imu_time_offset_sigma_s = 0.01;

  static constexpr void visit(auto& self, auto&& v) {
    v.number(
        "window_s", self.window_s, 0.02, 10.0,
        "IMU samples within this time around the first frame give gravity (and the gyroscope bias at rest)");
    v.number("rest_gyroscope_std_radps", self.rest_gyroscope_std_radps, 0.0, 10.0,
             "at rest if the gyroscope's standard deviation in the window is below this");
    v.number("rest_accelerometer_std_mps2", self.rest_accelerometer_std_mps2, 0.0, 100.0,
             "at rest if the accelerometer's standard deviation in the window is below this as well");
    v.number("rest_velocity_sigma_mps", self.rest_velocity_sigma_mps, 1e-4, 10.0, "velocity prior at rest");
    v.number("moving_velocity_sigma_mps", self.moving_velocity_sigma_mps, 1e-3, 10.0,
             "velocity prior in motion: zero with this standard deviation");
    v.number("moving_gravity_sigma_rad", self.moving_gravity_sigma_rad, 1e-3, 1.0,
             "gravity direction prior in motion, where the mean specific force contains acceleration");
    v.number("angular_velocity_sigma_radps", self.angular_velocity_sigma_radps, 1e-3, 100.0,
             "angular velocity prior without an IMU: zero with this standard deviation");
    v.number("gyroscope_bias_sigma_radps", self.gyroscope_bias_sigma_radps, 0.0, 1.0,
             "gyroscope bias prior (a ZR300's factory offsets are up to 0.004 rad/s); wider, slow drifts of "
             "the images pass "
             "for bias");
    v.number("accelerometer_bias_sigma_mps2", self.accelerometer_bias_sigma_mps2, 0.0, 5.0,
             "accelerometer bias prior (the raw axes of a ZR300 are off by up to 0.3 m/s^2)");
    v.number(
        "imu_time_offset_sigma_s", self.imu_time_offset_sigma_s, 0.0, 0.5,
        "prior of the offset between the clocks of IMU and camera (7 ms is typical of a ZR300); 0 trusts the "
        "stamps");
  }
};

/// Patches: where they are, how large, when they are honest.
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
  }
};

/// Photometric residuals (Eq. 3).
struct PhotometricConfig {
  double noise_grey = 8.0;
  double huber_sigmas = 1.345;
  double pixels_per_measurement = 300.0;
  double gain_sigma = 0.1;
  double offset_sigma_grey = 10.0;

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
  }
};

/// Point-to-plane residuals (Eq. 4).
struct GeometricConfig {
  double huber_sigmas = 0.7;
  double pixels_per_measurement = 300.0;
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
    v.number("model_noise_m", self.model_noise_m, 0.0, 1.0,
             "noise of the model's surface, added to the depth's");
    v.number("max_distance_m", self.max_distance_m, 0.001, 2.0,
             "points further from their plane are not associated (KinectFusion's gate)");
    v.number("max_normal_angle_deg", self.max_normal_angle_deg, 1.0, 90.0,
             "associations whose normals differ by more are dropped (KinectFusion's gate is 30 degrees)");
  }
};

/// The iterated extended Kalman filter (Eqs. 15-23).
struct IekfConfig {
  int max_iterations = 10;
  int coarse_iterations = 2;
  bool prior_in_every_iteration = true;
  double converged_rotation_rad = 1e-4;
  double converged_translation_m = 1e-4;
  double max_chi2_per_measurement = 9.0;
  double scatter_prior_freedom = 1.0;
  double scale_share = 0.2;
  int min_patches = 5;
  int max_lost_frames = 30;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("max_iterations", self.max_iterations, 1, 200, "iterations of one update; 1 is the plain EKF");
    v.number("coarse_iterations", self.coarse_iterations, 0, 100,
             "of these, at most this many on each coarser pyramid level before the finer ones join");
    v.flag("prior_in_every_iteration", self.prior_in_every_iteration,
           "each iteration weighs the distance to the prediction (the MAP estimate, Bell & Cathey 1993); "
           "false is "
           "Eq. 22 to the letter, which forgets it after the first one");
    v.number("converged_rotation_rad", self.converged_rotation_rad, 0.0, 1.0,
             "converged when the last step rotates less than this");
    v.number("converged_translation_m", self.converged_translation_m, 0.0, 1.0,
             "and translates less than this");
    v.number("max_chi2_per_measurement", self.max_chi2_per_measurement, 0.1, 1e6,
             "a patch whose mean squared whitened residual exceeds this is rejected");
    v.number(
        "scatter_prior_freedom", self.scatter_prior_freedom, 0.0, 1e9,
        "the variance of the residuals follows how patches disagree; this many degrees of freedom stand for "
        "the claim before (pixels_per_measurement and the noise), 1e9 for it alone");
    v.number(
        "scale_share", self.scale_share, 0.0, 1.0,
        "the noise of residuals follows what each tracked frame shows by this share (Huber's Proposal 2); 0 "
        "keeps photometric.noise_grey and the depth noise as they are");
    v.number("min_patches", self.min_patches, 1, 1000,
             "with fewer accepted patches the prediction is kept and the frame counts as lost");
    v.number(
        "max_lost_frames", self.max_lost_frames, 0, 100000,
        "more lost frames in a row end the run with status lost; an IMU bridges about a second, after which "
        "the place can only be found again by relocalisation");
  }
};

/// The model.
struct TsdfConfig {
  double voxel_m = 0.01;
  double truncation_m = 0.04;
  double truncation_sigmas = 3.0;
  double max_weight = 64.0;
  int max_blocks = 400000;
  double min_mesh_weight = 2.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("voxel_m", self.voxel_m, 0.001, 1.0, "side of a voxel (metres)");
    v.number("truncation_m", self.truncation_m, 0.002, 5.0,
             "the signed distance is kept within this band (metres); at least two voxels");
    v.number("truncation_sigmas", self.truncation_sigmas, 0.0, 20.0,
             "the band grows with depth to this many standard deviations of the depth noise");
    v.number("max_weight", self.max_weight, 1.0, 2048.0,
             "weights saturate here, so that the model can change");
    v.number("max_blocks", self.max_blocks, 1, 4194303,
             "memory limit: blocks of 8x8x8 voxels; when it is reached the run reports it");
    v.number("min_mesh_weight", self.min_mesh_weight, 0.0, 2048.0,
             "voxels seen less than this are not meshed");
  }
};

/// The whole effective configuration of a run.
struct Config {
  TermsConfig terms;
  DepthConfig depth;
  MotionConfig motion;
  InitialisationConfig initialisation;
  PatchConfig patches;
  PhotometricConfig photometric;
  GeometricConfig geometric;
  IekfConfig iekf;
  TsdfConfig tsdf;

  static constexpr void visit(auto& self, auto&& v) {
    v.group("terms", self.terms);
    v.group("depth", self.depth);
    v.group("motion", self.motion);
    v.group("initialisation", self.initialisation);
    v.group("patches", self.patches);
    v.group("photometric", self.photometric);
    v.group("geometric", self.geometric);
    v.group("iekf", self.iekf);
    v.group("tsdf", self.tsdf);
  }
};

static_assert(
    options_cover_all_fields<TermsConfig, DepthConfig, MotionConfig, InitialisationConfig, PatchConfig,
                             PhotometricConfig, GeometricConfig, IekfConfig, TsdfConfig, Config>(),
    "each field of a configuration struct needs its option in visit()");

}  // namespace fusebench::config
