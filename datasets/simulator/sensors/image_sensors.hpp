// Colour and depth cameras that move: exposure, noise, quantisation.
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

/// A colour camera. Light is integrated over the exposure in linear light, so that fast motion blurs; noise
/// comes after that, then sRGB encoding to 8 bits. A pixel of row r is exposed for exposure_s around capture
/// + (r / (height - 1) - 1/2) * timing.color_readout_s.
struct ColorSensor {
  calibration::CalibratedCamera camera;  ///< with size; its distortion and read-out are simulated
  double exposure_s = 0.008;
  double gain_drift = 0;  ///< relative amplitude (< 1) of a slow auto-exposure drift, see exposure_gain()
  double vignetting = 0;  ///< relative loss of light in the corners; grows with the square of the radius
  double read_noise_grey = 0;  ///< standard deviation, grey levels, of each channel
  double shot_noise =
      0;  ///< standard deviation of full-scale linear light 1; at light L it is this times sqrt(L)
  /// Instants of the exposure, each at another place within the pixel; 0: as many as the motion of the image
  /// needs (exposure_samples.hpp).
  int blur_samples = 0;
  double gain = 1;             ///< factor on all light, on top of the drift
  double amplifier_gain = 1;   ///< the part of it that amplifies noise as well (only with a mosaic)
  bool covered = false;        ///< no light comes in; the noise stays
  ColorProcessing processing;  ///< with a mosaic it brings noise of its own, instead of the two above
};

/// An object that moves before the camera while an image is taken.
struct MovingObject {
  const render::Renderer& surface;  ///< in the object's own frame
  std::function<SE3(std::int64_t)>
      T_object_camera{};  ///< at an instant; camera: the one that takes the image
};

enum class DepthNoise {
  none,    ///< exact to the quantum
  handa,   ///< structured light as in ICL-NUIM: disparity quantisation, lateral jitter, holes; see
           ///< depth_noise_handa.cpp
  zr300,   ///< active stereo of the ZR300; see depth_noise_zr300.cpp
  kinect,  ///< a Kinect as in TUM freiburg1; also there
};

/// What the sensor of that noise matches in, for an image of that camera: 640 columns of a Kinect (and where
/// there is no noise), the image's own of a ZR300.
[[nodiscard]] NativePixels native_pixels(DepthNoise noise, const PinholeCamera& camera);

/// A depth camera. Row r is taken at capture + (r / (height - 1) - 1/2) * readout_s.
struct DepthSensor {
  PinholeCamera camera;  ///< with size; depth has no distortion
  double readout_s = 0;
  double units_per_metre = 1000;
  DepthNoise noise = DepthNoise::none;
  DepthErrors errors;  ///< come before the noise
};

/// The image that the sensor takes around capture_ns (middle of the exposure of its middle row).
/// rays: of sensor.camera. T_body_camera places the camera on the body that the spline moves. The same seed
/// and frame give the same bytes. before: may be null.
[[nodiscard]] ColorImage expose_color(const render::Renderer& renderer, const ColorSensor& sensor,
                                      const rays::RayField& rays, const synthetic_imu::PoseSpline& motion,
                                      const SE3& T_body_camera, std::int64_t capture_ns, std::uint64_t seed,
                                      std::uint64_t frame, const Workers& workers,
                                      const MovingObject* before = nullptr);

/// Raw values as the format stores them (0: no measurement, or beyond 65535 units).
[[nodiscard]] Image<std::uint16_t> sense_depth(const render::Renderer& renderer, const DepthSensor& sensor,
                                               const synthetic_imu::PoseSpline& motion,
                                               const SE3& T_body_camera, std::int64_t capture_ns,
                                               std::uint64_t seed, std::uint64_t frame,
                                               const Workers& workers, const MovingObject* before = nullptr);

/// The factor on all light at a time: 1 + drift s(t), with s a sum of three sines (periods 3.1 s, 7.3 s and
/// 17 s, phases from the seed) that stays within -1 and 1.
[[nodiscard]] double exposure_gain(double drift, std::int64_t capture_ns, std::uint64_t seed);

/// Where the camera is when row `row` is at the middle of its exposure.
[[nodiscard]] std::int64_t row_time_ns(std::int64_t capture_ns, double readout_s, int row, int height_px);

}  // namespace fusebench::simulator::sensors
