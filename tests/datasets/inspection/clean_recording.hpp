// A recording in memory without a fault: the textured room, a smooth hand-held-like motion, exact truth and
// an IMU with a little noise. Tests plant one fault each.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "datasets/inspection/inspection.hpp"
#include "datasets/synthetic_imu/synthetic_imu.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench::testing {

/// A camera that sways about the room's middle and turns about all axes, with its derivatives taken
/// numerically.
struct SwayingMotion {
  [[nodiscard]] static SE3 T_world_camera(double t) {
    const Vector3d position(0.16 * std::sin(2.1 * t), 0.10 * std::sin(2.9 * t + 1.0),
                            0.14 * std::sin(1.7 * t + 0.4));
    const Vector3d turn(0.14 * std::sin(3.1 * t), 0.20 * std::sin(2.3 * t + 0.7),
                        0.16 * std::sin(3.7 * t + 2.0));
    return {so3_exp({0, turn.y(), 0}) * so3_exp({turn.x(), 0, 0}) * so3_exp({0, 0, turn.z()}), position};
  }
};

/// Samples of an ideal IMU whose pose is motion * T_camera_imu; gravity is along +y of the room.
inline std::vector<ImuSample> ideal_samples(const SE3& T_imu_camera, double begin_s, double end_s,
                                            double rate_hz) {
  const SE3 T_camera_imu = T_imu_camera.inverse();
  const auto pose = [&](double t) { return SwayingMotion::T_world_camera(t) * T_camera_imu; };
  constexpr double kStep_s = 1e-3;
  std::vector<ImuSample> samples;
  for (int i = 0; begin_s + i / rate_hz <= end_s; ++i) {
    const double t = begin_s + i / rate_hz;
    const SE3 before = pose(t - kStep_s), now = pose(t), after = pose(t + kStep_s);
    const Vector3d rate = so3_log(before.rotation.conjugate() * after.rotation) / (2 * kStep_s);
    const Vector3d acceleration =
        (after.translation - 2 * now.translation + before.translation) / (kStep_s * kStep_s);
    samples.push_back({static_cast<std::int64_t>(std::llround(1e9 * t)), rate,
                       now.rotation.conjugate() * (acceleration - Vector3d(0, kGravity_mps2, 0))});
  }
  return samples;
}

/// Frames that were rendered, for all copies of a recording: an inspection asks for each several times, and
/// rendering one takes longer than looking at it.
struct RenderedFrames {
  std::mutex mutex;
  std::vector<std::optional<RgbdFrame>> frames;
};

struct CleanOptions {
  int frames = 90;
  PinholeCamera camera{160, 120, 120.0, 120.0, 79.5, 59.5};
  bool truth = true;
  bool imu = true;
  double depth_factor = 1;  ///< what depths are multiplied with: a wrong scale
};

/// 30 Hz images from 10 s on, truth at 100 Hz, IMU at 200 Hz with the noise of a ZR300, both 0.5 s longer.
inline recording::Recording clean_recording(const CleanOptions& options = {}) {
  recording::Recording recording;
  recording.name = "clean";
  recording.format = "memory";
  recording.rig.camera = options.camera;
  recording.rig.T_imu_camera = {so3_exp({0.02, -0.03, 0.015}), {0.09, 0.003, 0.002}};
  const double begin_s = 10;
  const double end_s = begin_s + options.frames / 30.0;
  for (int k = 0; k < options.frames; ++k) {
    const std::int64_t time_ns = std::llround(1e9 * (begin_s + k / 30.0));
    recording.frames.push_back({time_ns, time_ns, time_ns, time_ns, {}, {}});
  }
  if (options.truth) {
    for (int i = 0; i < 100 * (options.frames / 30.0 + 1); ++i) {
      const double t = begin_s - 0.5 + 0.01 * i;
      recording.ground_truth.push_back(
          {static_cast<std::int64_t>(std::llround(1e9 * t)), SwayingMotion::T_world_camera(t)});
    }
  }
  if (options.imu) {
    const synthetic_imu::ImuSensor sensor = synthetic_imu::zr300_imu();
    recording.imu_source = recording::ImuSource::recorded;
    recording.rig.imu_noise = sensor.noise;
    recording.imu = ideal_samples(recording.rig.T_imu_camera, begin_s - 0.5, end_s + 0.5, 200);
    synthetic_imu::add_imu_noise(recording.imu, sensor, 200, 7);
  }
  const auto rendered = std::make_shared<RenderedFrames>();
  rendered->frames.resize(recording.frames.size());
  recording.load_frame = [camera = options.camera, factor = options.depth_factor, frames = recording.frames,
                          rendered](std::size_t k) -> Result<RgbdFrame> {
    {
      const std::scoped_lock lock(rendered->mutex);
      if (rendered->frames.at(k)) return *rendered->frames[k];
    }
    const TexturedRoom room;
    RgbdFrame frame =
        room.render(camera, SwayingMotion::T_world_camera(1e-9 * static_cast<double>(frames[k].capture_ns)),
                    frames[k].timestamp_ns);
    for (float& z_m : frame.depth_m.data) z_m = static_cast<float>(z_m * factor);
    const std::scoped_lock lock(rendered->mutex);
    rendered->frames[k] = frame;
    return frame;
  };
  return recording;
}

inline inspection::Inspection inspected(const recording::Recording& recording, int threads = 2) {
  const Workers workers(threads);
  return inspection::inspect(recording, workers);
}

/// Codes of errors and warnings, for messages and for comparison.
inline std::vector<std::string> faults(const inspection::Inspection& inspection) {
  std::vector<std::string> codes;
  for (const inspection::Finding& finding : inspection.findings) {
    if (finding.severity != inspection::Severity::note) codes.push_back(finding.code);
  }
  return codes;
}

inline const inspection::Finding* find(const inspection::Inspection& inspection, std::string_view code) {
  for (const inspection::Finding& finding : inspection.findings) {
    if (finding.code == code) return &finding;
  }
  return nullptr;
}

}  // namespace fusebench::testing
