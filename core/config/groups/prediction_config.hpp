// Options: the initial state and the prediction of the following ones.
#pragma once

namespace fusebench::config {

/// Process noise of the priors, in addition to the IMU noise densities of the recording.
struct MotionConfig {
  double imu_noise_factor = 1.0;
  double speed_mps = 0.2;
  /// Time constant of the linear velocity (seconds): a lost camera is expected to stop. Fitted to the errors
  /// of dead reckoning over 0.1 to 10 s on the same recordings.
  static constexpr double speed_time_s = 1.5;
  double rate_radps = 0.4;
  /// Time constant of the angular velocity (seconds).
  static constexpr double rate_time_s = 0.4;
  /// Time constant with which the standard deviations follow the velocities of the recording (seconds):
  /// recordings differ by a factor of five.
  static constexpr double scale_time_s = 20.0;
  double acceleration_noise_mps2_sqrthz = 1.5;
  double angular_acceleration_noise_radps2_sqrthz = 3.0;
  /// Random walk of the gravity direction against the map (rad/sqrt(Hz)), for the map's slow tilt.
  static constexpr double gravity_noise_rad_sqrthz = 1e-5;
  double drift_factor = 10.0;
  double exposure_s = 0.01;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("imu_noise_factor", self.imu_noise_factor, 0.01, 1000.0,
             "factor on the IMU noise densities of the recording; more than 1 covers unmodelled errors, e.g. "
             "of the scale");
    v.number(
        "speed_mps", self.speed_mps, 1e-3, 100.0,
        "dead reckoning without an IMU: standard deviation of the linear velocity per axis at the start of a "
        "recording (m/s); root mean square of seven hand-held recordings (0.06 to 0.28)");
    v.number("rate_radps", self.rate_radps, 1e-3, 100.0,
             "dead reckoning without an IMU: standard deviation of the angular velocity per axis at the "
             "start of a recording (rad/s; 0.15 to 0.74 in the same recordings)");
    v.number("acceleration_noise_mps2_sqrthz", self.acceleration_noise_mps2_sqrthz, 1e-3, 1e3,
             "prior of an update without an IMU: white acceleration (m/s^2/sqrt(Hz)), 0.3 m/s between frames "
             "at 30 Hz; larger than for hand-held cameras, so that the images determine sudden motions");
    v.number("angular_acceleration_noise_radps2_sqrthz", self.angular_acceleration_noise_radps2_sqrthz, 1e-3,
             1e3,
             "prior of an update without an IMU: white angular acceleration (rad/s^2/sqrt(Hz)), 0.5 rad/s "
             "between frames");
    v.number("drift_factor", self.drift_factor, 1.0, 100.0,
             "factor on the drift of the model relative to independent errors of the frames (standard "
             "deviations): consecutive frames share patches and model, so their errors are correlated. "
             "Changes only the reported uncertainty; the NEES of simulated runs is 1.1 to 1.3 (slow) and 0.6 "
             "to 0.8 (fast)");
    v.number(
        "exposure_s", self.exposure_s, 0.0, 0.5,
        "exposure of a colour image, from which motion blur is predicted (seconds; no format records it, "
        "10 ms is usual indoors)");
  }
};

/// The first state.
struct InitialisationConfig {
  double window_s = 0.25;
  /// The camera is at rest if the standard deviation of the gyroscope in the window is below this (rad/s),
  /// and
  static constexpr double rest_gyroscope_std_radps = 0.02;
  /// if the standard deviation of the accelerometer is below this (m/s^2).
  static constexpr double rest_accelerometer_std_mps2 = 0.15;
  /// Standard deviation of the velocity at rest (m/s).
  static constexpr double rest_velocity_sigma_mps = 0.02;
  double moving_velocity_sigma_mps = 1.0;
  /// Standard deviation of the direction of gravity in motion (rad): the mean specific force contains
  /// acceleration.
  static constexpr double moving_gravity_sigma_rad = 0.15;
  double angular_velocity_sigma_radps = 1.5;
  double gyroscope_bias_sigma_radps = 0.005;
  double accelerometer_bias_sigma_mps2 = 0.3;
  double imu_time_offset_sigma_s = 0.01;
  int false_start_frames = 5;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("window_s", self.window_s, 0.02, 10.0,
             "gravity (and at rest the gyroscope bias) is initialised from IMU samples within this time "
             "around the first frame");
    v.number("moving_velocity_sigma_mps", self.moving_velocity_sigma_mps, 1e-3, 10.0,
             "velocity prior in motion: zero with this standard deviation");
    v.number("angular_velocity_sigma_radps", self.angular_velocity_sigma_radps, 1e-3, 100.0,
             "angular velocity prior without an IMU: zero with this standard deviation");
    v.number("gyroscope_bias_sigma_radps", self.gyroscope_bias_sigma_radps, 0.0, 1.0,
             "gyroscope bias prior (a ZR300's factory offsets are up to 0.004 rad/s); with a wider one, slow "
             "drifts of the images are estimated as bias");
    v.number("accelerometer_bias_sigma_mps2", self.accelerometer_bias_sigma_mps2, 0.0, 5.0,
             "accelerometer bias prior (the raw axes of a ZR300 are off by up to 0.3 m/s^2)");
    v.number("imu_time_offset_sigma_s", self.imu_time_offset_sigma_s, 0.0, 0.1,
             "prior of the offset between the clocks of IMU and camera (7 ms is typical of a ZR300); 0 uses "
             "the stamps unchanged; for offsets of tenths of a second, run `fusebench calibrate` and store "
             "the result in calibration.toml");
    v.number("false_start_frames", self.false_start_frames, 1, 1000,
             "while fewer frames than this are tracked, the run restarts at a later frame after this many "
             "lost frames with usable images; a few, so that relocalisation is tried first");
  }
};

/// The sensor constants that are estimated together with the motion.
struct SelfCalibrationConfig {
  bool color_readout = true;
  bool depth_readout = true;
  bool depth_delay = true;
  double imu_rotation_sigma_rad = 0.01;
  double gyroscope_scale_sigma = 0.01;
  double accelerometer_scale_sigma = 0.01;
  /// The constants of the sensors and the offset of the IMU clock are not estimated before the camera has
  /// turned by this angle in all (rad). Their uncertainty counts from the first frame on.
  static constexpr double turn_before_rad = 0.02;
  double timing_walk = 0.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.flag("color_readout", self.color_readout,
           "estimates the read-out time of colour with the calibration's value and uncertainty "
           "(readout_sigma_s) as prior; false keeps it constant");
    v.flag("depth_readout", self.depth_readout, "the same for depth");
    v.flag("depth_delay", self.depth_delay,
           "estimates the delay of depth relative to colour with the calibration's value and uncertainty "
           "(delay_sigma_s) as prior; false keeps it constant");
    v.number(
        "imu_rotation_sigma_rad", self.imu_rotation_sigma_rad, 0.0, 0.5,
        "prior of the error of the IMU's rotation in the calibration, per axis (rad); 0 keeps it constant");
    v.number("gyroscope_scale_sigma", self.gyroscope_scale_sigma, 0.0, 0.2,
             "prior of the scale errors of the gyroscope's axes (1 to 3 % in data sheets of consumer IMUs); "
             "0 keeps them constant");
    v.number("accelerometer_scale_sigma", self.accelerometer_scale_sigma, 0.0, 0.2,
             "the same for the accelerometer");
    v.number(
        "timing_walk", self.timing_walk, 0.0, 10.0,
        "random walk of the read-outs, the delay of depth and the offset of the IMU's clock, in standard "
        "deviations of their priors (1/sqrt(s)); 0: constants, as in a recording of minutes by one device");
  }
};

}  // namespace fusebench::config
