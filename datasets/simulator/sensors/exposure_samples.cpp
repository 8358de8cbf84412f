#include "datasets/simulator/sensors/exposure_samples.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::simulator::sensors {

namespace {

constexpr double kStep_px = 2;
constexpr double kFewest = 8;
constexpr double kMost = 64;

}  // namespace

std::vector<Vector2d> sample_offsets_px(int samples) {
  constexpr double kPlastic = 1.32471795724474602596;
  std::vector<Vector2d> offsets;
  Vector2d mean = Vector2d::Zero();
  Vector2d trend = Vector2d::Zero();
  double squares = 0;
  const auto time_of = [&](int i) { return i + 0.5 - 0.5 * samples; };
  for (int i = 0; i < samples; ++i) {
    const Vector2d place(0.5 + i / kPlastic, 0.5 + i / (kPlastic * kPlastic));
    offsets.emplace_back(place.array() - place.array().floor());
    mean += offsets.back() / samples;
    trend += time_of(i) * offsets.back();
    squares += time_of(i) * time_of(i);
  }
  if (squares > 0) trend /= squares;
  for (int i = 0; i < samples; ++i) {
    const Vector2d centred = offsets[static_cast<std::size_t>(i)] - mean - time_of(i) * trend;
    offsets[static_cast<std::size_t>(i)] = centred.cwiseMax(-0.5).cwiseMin(0.5);
  }
  return offsets;
}

int samples_of_motion(double motion_px) {
  return static_cast<int>(std::clamp(std::ceil(motion_px / kStep_px), kFewest, kMost));
}

}  // namespace fusebench::simulator::sensors
