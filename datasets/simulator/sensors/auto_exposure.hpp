// Automatic exposure of a colour camera: exposure time and gain follow the brightness of the view.
#pragma once

#include <span>
#include <vector>

namespace fusebench::simulator::sensors {

/// Controller with a mean grey level as its target. It measures its own images with a delay of some frames.
struct ExposureControl {
  bool on = false;
  double unit_exposure_s = 0.012;  ///< exposure with light 1 at full scale without gain
  double target_grey = 135;        ///< mean of an image in grey levels of sRGB
  double least_s = 0.005;          ///< shortest exposure; brighter scenes are overexposed
  double most_s = 0.025;           ///< longest exposure; darker scenes use gain
  double most_gain = 8;            ///< of the amplifier; at least 1
  int lag_frames = 2;              ///< age of the newest image used; at least 1
};

/// Exposure of one image.
struct FrameExposure {
  double exposure_s = 0;
  double gain = 1;
};

/// Mean grey level (0 to 255) of an image: light * factor, clipped at full scale, encoded as sRGB. light:
/// linear, >= 0.
[[nodiscard]] double mean_grey(std::span<const float> light, double factor);

/// Exposures of all frames in order. light_of_frame: light at some pixels of each frame. The first frame has
/// the steady-state exposure of its scene.
[[nodiscard]] std::vector<FrameExposure> controlled_exposures(
    const ExposureControl& control, std::span<const std::vector<float>> light_of_frame);

}  // namespace fusebench::simulator::sensors
