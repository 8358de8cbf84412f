#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <filesystem>
#include <system_error>

#include "core/base/io/fingerprint.hpp"
#include "core/config/toml_document.hpp"
#include "datasets/simulator/realism.hpp"
#include "datasets/simulator/simulation.hpp"

namespace fusebench::simulator {

namespace {

/// Increase it when the same options give other bytes.
constexpr int kSimulatorVersion = 3;

std::string_view name_of(sensors::DepthNoise noise) {
  switch (noise) {
    case sensors::DepthNoise::none:
      return "none";
    case sensors::DepthNoise::handa:
      return "handa";
    case sensors::DepthNoise::kinect:
      return "kinect";
    case sensors::DepthNoise::zr300:
      break;
  }
  return "zr300";
}

std::string toml_text(std::string_view text) {
  return config::to_toml(config::OptionValue(std::string(text)));
}

std::string matrix_text(const Matrix3d& m) {
  return fmt::format("[{}, {}, {}, {}, {}, {}, {}, {}, {}]", m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1),
                     m(1, 2), m(2, 0), m(2, 1), m(2, 2));
}

std::string hand_text(const motion::MotionOptions& m) {
  if (m.tremor_rad == 0 && m.revisit_s == 0) return "";
  const motion::Pans& p = m.pans;
  return fmt::format(
      "tremor_rad = {}\ntremor_hz = [{}, {}]\npan_pause_s = [{}, {}]\npan_duration_s = [{}, {}]\n"
      "pan_rate = [{}, {}]\nmean_pitch_rad = {}\nrevisit_s = {}\n",
      m.tremor_rad, m.tremor_hz.low_hz, m.tremor_hz.high_hz, p.pause_s[0], p.pause_s[1], p.duration_s[0],
      p.duration_s[1], p.rate[0], p.rate[1], m.mean_pitch_rad, m.revisit_s);
}

std::string motion_text(const SimulationOptions& o) {
  if (!o.trajectory_file.empty()) {
    const motion::FileMotionOptions& f = o.file_motion;
    return fmt::format(
        "[trajectory]\nfile = {}\nspeed = {}\nfrom_rest = {}\nrest_s = {}\nstart_s = {}\nin_place = {}\n{}",
        toml_text(o.trajectory_file.filename().string()), f.speed, f.from_rest, f.rest_s, f.start_s,
        f.in_place, f.skip_s > 0 ? fmt::format("skip_s = {}\n", f.skip_s) : "");
  }
  const motion::MotionOptions& m = o.motion;
  return fmt::format(
      "[motion]\npreset = {}\npeak_speed_mps = {}\npeak_rate_radps = {}\nposition_hz = [{}, {}]\n"
      "rotation_hz = [{}, {}]\npan_share = {}\nshake_share = {}\nshake_hz = [{}, {}]\ntremor_m = {}\n"
      "from_rest = {}\nrest_s = {}\nstart_s = {}\n{}{}",
      toml_text(motion::to_string(o.preset)), m.peak_speed_mps, m.peak_rate_radps, m.position_hz.low_hz,
      m.position_hz.high_hz, m.rotation_hz.low_hz, m.rotation_hz.high_hz, m.pan_share, m.shake_share,
      m.shake_hz.low_hz, m.shake_hz.high_hz, m.tremor_m, m.from_rest, m.rest_s, m.start_s,
      // Conditional, so that other recordings keep their identity.
      m.sideways ? "sideways = true\n" : "", hand_text(m));
}

std::string sensors_text(const SimulationOptions& o) {
  const ImuNoise& n = o.imu.sensor.noise;
  return fmt::format(
      "[images]\nrate_hz = {}\nexposure_s = {}\nblur_samples = {}\ngain_drift = {}\nvignetting = {}\n"
      "read_noise_grey = {}\nshot_noise = {}\ndepth_noise = {}\n\n"
      "[imu_errors]  # measured = gain * true + bias + noise\nrate_hz = {}\nsensor = {}\n"
      "gyroscope_noise_radps_sqrthz = {}\naccelerometer_noise_mps2_sqrthz = {}\n"
      "gyroscope_bias_walk_radps2_sqrthz = {}\naccelerometer_bias_walk_mps3_sqrthz = {}\n"
      "initial_gyroscope_bias_radps = {}\ninitial_accelerometer_bias_mps2 = {}\n"
      "gyroscope_gain = {}\naccelerometer_gain = {}\n"
      "gyroscope_range_radps = {}\naccelerometer_range_mps2 = {}\ntime_offset_s = {}\n",
      o.rate_hz, o.exposure_s, o.blur_samples > 0 ? std::to_string(o.blur_samples) : "\"by motion\"",
      o.gain_drift, o.vignetting, o.read_noise_grey, o.shot_noise, toml_text(name_of(o.depth_noise)),
      o.imu_rate_hz, toml_text(o.imu.sensor.name), n.gyroscope_radps_sqrthz, n.accelerometer_mps2_sqrthz,
      n.gyroscope_bias_radps2_sqrthz, n.accelerometer_bias_mps3_sqrthz,
      o.imu.sensor.initial_gyroscope_bias_radps, o.imu.sensor.initial_accelerometer_bias_mps2,
      matrix_text(o.imu.gyroscope_gain), matrix_text(o.imu.accelerometer_gain), o.imu.gyroscope_range_radps,
      o.imu.accelerometer_range_mps2, o.imu.time_offset_s);
}

std::string scene_text(const SimulationOptions& o) {
  if (o.scene_file.empty()) {
    return fmt::format("[scene]\nkind = \"{} of the seed\"\n", to_string(o.room));
  }
  return fmt::format("[scene]\nkind = \"file\"\nfile = {}\ny_up = {}\nmetres_per_unit = {}\n",
                     toml_text(o.scene_file.filename().string()), o.scene.y_up, o.scene.metres_per_unit);
}

/// Empty without faults, so that recordings without faults keep their identity.
std::string faults_text(const SimulationOptions& o) {
  std::string text;
  if (!o.faults.empty()) {
    std::vector<std::string> list;
    for (const faults::SimulatedFault& fault : o.faults) list.push_back(toml_text(faults::to_string(fault)));
    text += fmt::format("\n[faults]  # seconds from the first frame\nlist = [{}]\n", fmt::join(list, ", "));
  }
  if (!o.calibration_error.is_zero() || o.untold_time_offset_s != 0) {
    text += fmt::format(
        "\n[untold]  # what calibration.toml is wrong about\nrotation_deg = {}\nshift_cm = {}\n"
        "time_offset_s = {}\n",
        o.calibration_error.rotation_deg, o.calibration_error.shift_cm, o.untold_time_offset_s);
  }
  return text;
}

/// All options except the calibration, which has a separate file.
std::string options_text(const SimulationOptions& o) {
  return fmt::format("simulator_version = {}\nlayout = {}\nseed = {}\nduration_s = {}\n\n{}\n{}\n{}{}{}",
                     kSimulatorVersion, toml_text(layouts::to_string(o.layout)), o.seed, o.duration_s,
                     scene_text(o), motion_text(o), sensors_text(o), faults_text(o), realism_text(o));
}

}  // namespace

Result<std::string> simulation_identity(const SimulationOptions& options) {
  io::Fingerprint fingerprint;
  fingerprint.add(options_text(options));
  fingerprint.add(calibration::to_toml(options.rig));
  for (const auto& file : {options.scene_file, options.trajectory_file}) {
    if (file.empty()) continue;
    constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 33;  // limit for hashing
    std::error_code ignored;
    if (const auto size = std::filesystem::file_size(file, ignored); !ignored && size > kMostBytes)
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: {} bytes are no scene and no path of a camera (allowed: up to {})",
                              file.string(), size, kMostBytes));
    if (const auto added = fingerprint.add_file(file); !added) return tl::unexpected(added.error());
  }
  return fingerprint.hex();
}

std::string simulation_text(const SimulationOptions& options, const std::string& identity,
                            const Vector3d& gravity_world_mps2) {
  const Vector3d& g = gravity_world_mps2;
  const std::string_view reflected =
      options.layout == layouts::RecordingLayout::icl
          ? "# livingRoom0.gt.freiburg is reflected as ICL-NUIM publishes it (left-handed, y up); the other "
            "two "
            "are in\n# the right-handed world with y down that the reader makes of it.\n"
          : "";
  return fmt::format(
      "# This recording was made by `fusebench simulate`: images, IMU and truth are simulated. Its sensors "
      "are\n"
      "# described in calibration.toml; state_groundtruth.csv (the IMU body, images' clock) and scene.ply "
      "are in\n"
      "# the world of the ground truth.\n{}identity = {}\ngravity_world_mps2 = [{}, {}, {}]\n{}",
      reflected, toml_text(identity), g.x(), g.y(), g.z(), options_text(options));
}

}  // namespace fusebench::simulator
