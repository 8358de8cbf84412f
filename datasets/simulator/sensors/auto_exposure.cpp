#include "datasets/simulator/sensors/auto_exposure.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/simulator/texture/texture.hpp"

namespace fusebench::simulator::sensors {

namespace {

constexpr int kRoundsToSettle = 60;
constexpr double kMaxStep = 1.25;  // largest change per frame, up or down: avoids visible jumps

/// The next product of exposure and gain. Grey levels are about proportional to the square root of light.
/// Only a part of the error is corrected in each frame, so that the lag does not cause oscillation.
double corrected(const ExposureControl& control, double factor, double grey) {
  const double error = control.target_grey / std::max(grey, 1.0);
  const double step = std::sqrt(std::sqrt(error));
  const double least = control.least_s / control.unit_exposure_s;
  const double most = control.most_s / control.unit_exposure_s * control.most_gain;
  return std::clamp(factor * std::clamp(step, 1 / kMaxStep, kMaxStep), least, most);
}

/// Prefers a long exposure to gain, which amplifies noise.
FrameExposure split(const ExposureControl& control, double factor) {
  const double wanted_s = factor * control.unit_exposure_s;
  const double exposure_s = std::clamp(wanted_s, control.least_s, control.most_s);
  return {exposure_s, std::clamp(wanted_s / exposure_s, 1.0, control.most_gain)};
}

}  // namespace

double mean_grey(std::span<const float> light, double factor) {
  double sum = 0;
  for (const float l : light)
    sum += 255 * texture::srgb_from_linear(std::clamp(factor * static_cast<double>(l), 0.0, 1.0));
  return light.empty() ? 0 : sum / static_cast<double>(light.size());
}

std::vector<FrameExposure> controlled_exposures(const ExposureControl& control,
                                                std::span<const std::vector<float>> light_of_frame) {
  std::vector<FrameExposure> exposures;
  std::vector<double> grey;  // of the earlier images
  double factor = 1;
  for (int round = 0; round < kRoundsToSettle && !light_of_frame.empty(); ++round)
    factor = corrected(control, factor, mean_grey(light_of_frame.front(), factor));
  const auto lag = static_cast<std::size_t>(std::max(1, control.lag_frames));
  for (std::size_t k = 0; k < light_of_frame.size(); ++k) {
    if (k >= lag) factor = corrected(control, factor, grey[k - lag]);
    exposures.push_back(split(control, factor));
    grey.push_back(mean_grey(light_of_frame[k], factor));
  }
  return exposures;
}

}  // namespace fusebench::simulator::sensors
