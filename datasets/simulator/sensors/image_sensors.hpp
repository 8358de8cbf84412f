// Models of moving colour and depth cameras: exposure, noise, quantisation.
#pragma once

#include <cstdint>
#include <functional>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "datasets/calibration/camera_model.hpp"
#include "datasets/simulator/rays/ray_field.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/simulator/sensors/color_processing.hpp"
#include "datasets/simulator/sensors/depth_errors.hpp"
#include "datasets/simulator/sensors/native_pixels.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::sensors {

/// A colour camera. It averages linear light over the exposure (motion blur), adds noise, and encodes to
/// 8-bit sRGB. A pixel of row r is exposed for exposure_s around capture + (r / (height - 1) - 1/2) *
/// timing.color_readout_s.
struct ColorSensor {
  calibration::CalibratedCamera camera;  ///< with size; distortion and read-out are simulated
  double exposure_s = 0.008;
  double gain_drift = 0;       ///< relative amplitude (< 1) of a slow gain drift, see exposure_gain()
  double vignetting = 0;       ///< relative loss of light in the corners; proportional to the squared radius
  double read_noise_grey = 0;  ///< standard deviation, grey levels, of each channel
  double shot_noise = 0;       ///< standard deviation at linear light 1; at light L, multiplied by sqrt(L)
  /// Number of instants of the exposure, each at another sub-pixel position; 0: by the image motion
  /// (exposure_samples.hpp).
  int blur_samples = 0;
  double gain = 1;             ///< factor on all light, in addition to the drift
  double amplifier_gain = 1;   ///< part of the gain that also amplifies noise (only with a mosaic)
  bool covered = false;        ///< no light, but noise
  ColorProcessing processing;  ///< its mosaic has its own noise, which replaces the two above
};

/// A moving object in front of the camera.
struct MovingObject {
  const render::Renderer& surface;  ///< in the object's own frame
  std::function<SE3(std::int64_t)>
      T_object_camera{};  ///< pose at an instant; camera: the one that takes the image
};

enum class DepthNoise {
  none,    ///< exact up to quantisation
  handa,   ///< structured light as in ICL-NUIM: disparity quantisation, lateral jitter, holes; see
           ///< depth_noise_handa.cpp
  zr300,   ///< active stereo of the ZR300; see depth_noise_zr300.cpp
  kinect,  ///< a Kinect as in TUM freiburg1; also in depth_noise_zr300.cpp
};

/// Native resolution of the sensor with that noise for an image of the camera: 640 columns for a Kinect (and
/// without noise), the image size for a ZR300.
[[nodiscard]] NativePixels native_pixels(DepthNoise noise, const PinholeCamera& camera);

/// A depth camera. Row r is captured at capture + (r / (height - 1) - 1/2) * readout_s.
struct DepthSensor {
  PinholeCamera camera;  ///< with size; depth has no distortion
  double readout_s = 0;
  double units_per_metre = 1000;
  DepthNoise noise = DepthNoise::none;
  DepthErrors errors;  ///< applied before the noise
};

/// Renders the image around capture_ns (middle of the exposure of the middle row). rays: of sensor.camera.
/// T_body_camera: mounting on the body of the spline. Deterministic for seed and frame. before: may be null.
[[nodiscard]] ColorImage expose_color(const render::Renderer& renderer, const ColorSensor& sensor,
                                      const rays::RayField& rays, const synthetic_imu::PoseSpline& motion,
                                      const SE3& T_body_camera, std::int64_t capture_ns, std::uint64_t seed,
                                      std::uint64_t frame, const Workers& workers,
                                      const MovingObject* before = nullptr);

/// Raw values in the format of the recording (0: no measurement, or more than 65535 units).
[[nodiscard]] Image<std::uint16_t> sense_depth(const render::Renderer& renderer, const DepthSensor& sensor,
                                               const synthetic_imu::PoseSpline& motion,
                                               const SE3& T_body_camera, std::int64_t capture_ns,
                                               std::uint64_t seed, std::uint64_t frame,
                                               const Workers& workers, const MovingObject* before = nullptr);

/// Gain at a time: 1 + drift s(t), with s in [-1, 1] the sum of three sines (periods 3.1 s, 7.3 s and 17 s,
/// phases from the seed).
[[nodiscard]] double exposure_gain(double drift, std::int64_t capture_ns, std::uint64_t seed);

/// Instant of the middle of the exposure of a row.
[[nodiscard]] std::int64_t row_time_ns(std::int64_t capture_ns, double readout_s, int row, int height_px);

}  // namespace fusebench::simulator::sensors
