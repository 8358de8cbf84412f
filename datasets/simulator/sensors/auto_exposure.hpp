// Automatic exposure of a colour camera: exposure time and gain follow the brightness of what is in view.
#pragma once

#include <span>
#include <vector>

namespace fusebench::simulator::sensors {

/// The controller. It aims at a mean grey level and sees its own images some frames late.
struct ExposureControl {
  bool on = false;
  double unit_exposure_s = 0.012;  ///< at which light 1 is full scale without gain
  double target_grey = 135;        ///< mean of an image in grey levels of sRGB
  double least_s = 0.005;          ///< shortest exposure; brighter scenes are overexposed
  double most_s = 0.025;           ///< longest exposure; beyond it there is gain
  double most_gain = 8;            ///< of the amplifier; at least 1
  int lag_frames = 2;              ///< age of the newest image that an exposure is chosen from; at least 1
};

/// How one image is exposed.
struct FrameExposure {
  double exposure_s = 0;
  double gain = 1;
};

/// Mean grey level (0 to 255) of an image of this light: light times `factor`, cut off at full scale, encoded
/// as sRGB. light: linear, 0 to 1 and more.
[[nodiscard]] double mean_grey(std::span<const float> light, double factor);

/// Exposures of all frames in order. light_of_frame: for each frame the light at some pixels. The first frame
/// is exposed as if its scene had been in view for long.
[[nodiscard]] std::vector<FrameExposure> controlled_exposures(
    const ExposureControl& control, std::span<const std::vector<float>> light_of_frame);

}  // namespace fusebench::simulator::sensors
