// Simulates a whole recording: scene, motion, sensors, and a folder in the format of a published dataset.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/simulator/faults/calibration_error.hpp"
#include "datasets/simulator/faults/fault.hpp"
#include "datasets/simulator/layouts/layout.hpp"
#include "datasets/simulator/motion/motion.hpp"
#include "datasets/simulator/motion/motion_file.hpp"
#include "datasets/simulator/room_kind.hpp"
#include "datasets/simulator/scene/scene_file.hpp"
#include "datasets/simulator/sensors/auto_exposure.hpp"
#include "datasets/simulator/sensors/frame_timing.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "datasets/simulator/sensors/imu_sensor.hpp"

namespace fusebench::simulator {

/// All options of a recording; simulation_defaults() sets the defaults.
struct SimulationOptions {
  layouts::RecordingLayout layout = layouts::RecordingLayout::zr300;
  std::uint64_t seed = 1;  ///< of the motion and of all noise
  double duration_s = 10;  ///< 0: length of the trajectory file
  double rate_hz = 30;     ///< of the images

  std::filesystem::path scene_file;  ///< PLY or OBJ; empty: the room of the seed
  RoomKind room = RoomKind::furnished;
  scene::SceneFileOptions scene;  ///< axes and unit of scene_file

  motion::MotionPreset preset = motion::MotionPreset::slow;  ///< origin of the defaults of `motion`
  motion::MotionOptions motion;
  std::filesystem::path trajectory_file;  ///< replaces `motion`; empty: none
  motion::FileMotionOptions file_motion;

  calibration::RigCalibration
      rig;  ///< true calibration: cameras with read-out times, extrinsics, IMU densities
  double exposure_s = 0.008;
  int blur_samples = 0;      ///< as ColorSensor::blur_samples
  double gain_drift = 0.03;  ///< and the next three: see ColorSensor
  double vignetting = 0.15;
  double read_noise_grey = 1.0;
  double shot_noise = 0.01;  ///< that of a pixel with a capacity of 10000 electrons
  sensors::DepthNoise depth_noise = sensors::DepthNoise::zr300;
  double imu_rate_hz = 200;
  sensors::ImuErrors imu;

  std::vector<faults::SimulatedFault> faults;  ///< of the images
  faults::CalibrationError calibration_error;  ///< error of calibration.toml
  double untold_time_offset_s = 0;  ///< added to imu.time_offset_s, but not written to calibration.toml

  // Additional effects of realistic sensors (realism.hpp); off by default.
  bool untold_shutters = false;  ///< calibration.toml has neither read-outs nor depth delay
  sensors::StampErrors stamps;
  sensors::ExposureControl auto_exposure;  ///< replaces exposure_s and gain_drift
  sensors::ColorProcessing color_processing;
  sensors::DepthErrors depth_errors;
};

/// Sensors and effects of a layout with the motion of a preset. On: motion blur, image noise, depth noise of
/// the layout's sensor, IMU noise and biases. Off: rolling shutters, IMU scale errors, time offsets. Errors:
/// configuration (an image size out of range).
[[nodiscard]] Result<SimulationOptions> simulation_defaults(layouts::RecordingLayout layout,
                                                            motion::MotionPreset preset,
                                                            const images::ImageSize& size = {640, 480});

/// Switches off the noise of images, depth and IMU, the IMU biases, gain drift and vignetting; keeps motion
/// blur.
void remove_noise(SimulationOptions& options);

/// Identity of the recording: hash of the options and of the content of the files they name, 32 hexadecimal
/// digits. Errors: data_missing.
[[nodiscard]] Result<std::string> simulation_identity(const SimulationOptions& options);

/// Text of simulation.toml: all options, the identity, and gravity in the world of the files.
[[nodiscard]] std::string simulation_text(const SimulationOptions& options, const std::string& identity,
                                          const Vector3d& gravity_world_mps2);

struct SimulationReport {
  std::string identity;
  bool reused = false;  ///< the folder existed; nothing was written, and the rest is empty
  std::size_t frames = 0;
  std::size_t imu_samples = 0;
  motion::PeakSpeeds peaks;      ///< of the colour camera, first to last frame
  double trajectory_shrunk = 1;  ///< and the next member: see FileMotion
  double trajectory_turned_rad = 0;
  std::vector<std::string> warnings;
};

/// Callbacks for progress and cancellation.
struct SimulationControl {
  std::function<void(std::size_t done, std::size_t total)>
      progress;                             ///< called by one thread at a time; may be empty
  const std::atomic<bool>* stop = nullptr;  ///< request to stop early, with an error
};

/// Checks the options before any file is read or written. Error configuration.
[[nodiscard]] Result<void> check_simulation(const SimulationOptions& options);

/// Writes a recording atomically. Deterministic for any number of threads. An existing folder is reused if
/// its simulation.toml has the same identity, otherwise it is an error. Errors: configuration (an option out
/// of range), data_missing and data_corrupt (scene or trajectory file), io, run_failed (stopped).
[[nodiscard]] Result<SimulationReport> simulate(const SimulationOptions& options,
                                                const std::filesystem::path& folder, const Workers& workers,
                                                const SimulationControl& control = {});

}  // namespace fusebench::simulator
