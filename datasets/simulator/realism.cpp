#include "datasets/simulator/realism.hpp"

#include <fmt/format.h>

#include "datasets/simulator/random/random_numbers.hpp"

namespace fusebench::simulator {

namespace {

constexpr std::uint64_t kDevice = 0xDE;  // key of an independent random stream

// Read-outs of a Kinect (Ringaby & Forssen, ICCV 2011). Its depth is captured 18 ms before its stamp, as
// measured on freiburg1_rpy (camera_presets.cpp). For other cameras, 6 ms are an assumption.
constexpr double kColorReadout_s = 0.0261;
constexpr double kDepthReadout_s = 0.0305;
constexpr double kKinectDepthDelay_s = -0.018;
constexpr double kOtherDepthDelay_s = 0.006;

// Stamps of a driver without a hardware clock: assumptions of the order of TUM RGB-D.
constexpr double kJitter_s = 0.001;
constexpr double kDroppedShare = 0.01;

// Errors without a calibration.
constexpr double kUntoldOffset_s = 0.005;
constexpr faults::CalibrationError kExtrinsicError{1.0, 1.0};
// Consumer IMUs without factory calibration (Tedaldi, Pretto & Menegatti, "A robust and easy to implement
// method for IMU calibration without external equipments", ICRA 2014: scale errors up to 2 %, axes off by up
// to a degree).
constexpr double kGainError = 0.02;
constexpr double kMisalignment_rad = radians(0.5);
constexpr double kGyroscopeRange_radps = radians(500.0);

/// Scale errors on the diagonal, axis misalignments off the diagonal, each uniform within its bound.
Matrix3d gain_of(random::RandomSequence& random) {
  Matrix3d gain;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      const double bound = row == column ? kGainError : kMisalignment_rad;
      gain(row, column) = (row == column ? 1.0 : 0.0) + random.uniform(-bound, bound);
    }
  }
  return gain;
}

// Noise on flat parts of still pairs of freiburg1_rpy and freiburg1_xyz, after the interpolation of colours:
// 2.1, 1.6 and 4.5 grey levels in red, green and blue at any brightness, 1.1 in grey; correlation of
// neighbours 0.56, of next but one 0.17, of diagonal ones 0.31. A tenth of the pixels is below 10 grey
// levels, 3 to 6 % are saturated.
sensors::ColorProcessing kinect_color() {
  sensors::ColorProcessing color;
  color.mosaic = true;
  color.shot_noise = {0.018, 0.012, 0.038};
  color.read_noise = 0.0012;
  color.smoothing = 0.15;
  color.contrast = 0.9;
  return color;
}

// Scale: published depth of freiburg1 is corrected by 3.5 %, which leaves about a percent (Sturm et al., IROS
// 2012). The residual of depth to planes of 9 x 9 pixels on freiburg1_rpy and _xyz is 0.055 px of disparity
// at all distances, 0.036 of it by the steps of 1/8 px. The smooth error is an assumption (Teichman, Miller
// and Thrun, RSS 2013, show 2 to 3 % at 3 m).
sensors::DepthErrors kinect_depth() {
  sensors::DepthErrors depth;
  depth.scale = 0.01;
  depth.smooth_px = 0.1;
  depth.pattern_px = 0.01;
  depth.lost_light = true;
  return depth;
}

}  // namespace

bool is_realistic(motion::MotionPreset preset) {
  return preset == motion::MotionPreset::realistic_scan || preset == motion::MotionPreset::realistic_turns ||
         preset == motion::MotionPreset::realistic_revisit;
}

void make_realistic(SimulationOptions& options) {
  SensorTiming& timing = options.rig.color.timing;
  timing.color_readout_s = kColorReadout_s;
  timing.depth_readout_s = kDepthReadout_s;
  const bool kinect = options.layout == layouts::RecordingLayout::tum;
  timing.depth_delay_s = kinect ? kKinectDepthDelay_s : kOtherDepthDelay_s;
  options.untold_shutters = true;
  options.stamps = {kJitter_s, kDroppedShare};
  options.auto_exposure.on = true;
  options.gain_drift = 0;  // replaced by the drift of the exposure control
  options.color_processing = kinect_color();
  if (options.depth_noise == sensors::DepthNoise::handa) options.depth_noise = sensors::DepthNoise::kinect;
  options.depth_errors = kinect_depth();
  options.depth_errors.border = !options.rig.depth;
  random::RandomSequence device(random::mix_key(options.seed, kDevice));
  options.imu.gyroscope_gain = gain_of(device);
  options.imu.accelerometer_gain = gain_of(device);
  options.imu.gyroscope_range_radps = kGyroscopeRange_radps;
  options.untold_time_offset_s = kUntoldOffset_s;
  options.calibration_error = kExtrinsicError;
  if (options.room == RoomKind::furnished && !motion::follows_route(options.preset))
    options.room = RoomKind::office;
}

std::string realism_text(const SimulationOptions& o) {
  std::string text;
  if (o.untold_shutters) {
    const SensorTiming& t = o.rig.color.timing;
    text += fmt::format(
        "\n[untold_shutters]  # calibration.toml says nothing of them\ncolor_readout_s = {}\n"
        "depth_readout_s = {}\ndepth_delay_s = {}\n",
        t.color_readout_s, t.depth_readout_s, t.depth_delay_s);
  }
  if (o.stamps.any()) {
    text += fmt::format("\n[stamps]\njitter_s = {}\ndropped_share = {}\n", o.stamps.jitter_s,
                        o.stamps.dropped_share);
  }
  if (const sensors::ExposureControl& e = o.auto_exposure; e.on) {
    text += fmt::format(
        "\n[auto_exposure]  # instead of exposure_s\nunit_exposure_s = {}\n"
        "target_grey = {}\nleast_s = {}\nmost_s = {}\nmost_gain = {}\nlag_frames = {}\n",
        e.unit_exposure_s, e.target_grey, e.least_s, e.most_s, e.most_gain, e.lag_frames);
  }
  if (const sensors::ColorProcessing& c = o.color_processing; c.mosaic) {
    text += fmt::format(
        "\n[color_processing]  # noise in light, instead of read_noise_grey and shot_noise\n"
        "shot_noise = [{}, {}, {}]\nread_noise = {}\nsmoothing = {}\ncontrast = {}\n",
        c.shot_noise[0], c.shot_noise[1], c.shot_noise[2], c.read_noise, c.smoothing, c.contrast);
  }
  if (const sensors::DepthErrors& d = o.depth_errors; d.any()) {
    text += fmt::format(
        "\n[depth_errors]\nscale = {}\nsmooth_px = {}\npattern_px = {}\nborder = {}\nlost_light = {}\n",
        d.scale, d.smooth_px, d.pattern_px, d.border, d.lost_light);
  }
  return text;
}

}  // namespace fusebench::simulator
