#include "datasets/simulator/sensors/exposure_samples.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::simulator::sensors {

namespace {

constexpr double kStep_px = 2;
constexpr int kMostSamples = 64;
constexpr int kEdgeSamples = 4;

/// Variance, in each direction, of a square pixel sampled at eight places with squares of an eighth of its
/// area: 1/12 of the places and f^2 / 4 of the texture (two linear interpolations over squares of side f).
constexpr double kPixelVariance_px2 = 1.0 / 12 + 0.25 / 8;
constexpr double kLeastFootprint_px = 0.1;

/// Places within the pixel for the samples of an exposure: a low-discrepancy sequence (Roberts' R2), from
/// which mean and trend over time are taken out, since they would shift the image and change the length of
/// its blur.
std::vector<Vector2d> sample_offsets(int samples) {
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

}  // namespace

SampleSet sample_set(int samples, render::Pixels pixels) {
  SampleSet set{sample_offsets(samples), 1, pixels};
  double variance = 0;
  for (const Vector2d& offset : set.offsets_px) variance += 0.5 * offset.squaredNorm() / samples;
  const double left = std::max(0.0, kPixelVariance_px2 - variance);
  set.footprint_px = static_cast<float>(std::max(kLeastFootprint_px, 2 * std::sqrt(left)));
  return set;
}

std::vector<SampleSet> samples_of_motion(double motion_px) {
  const int samples =
      motion_px < 1
          ? 1
          : static_cast<int>(std::clamp(std::ceil(motion_px / kStep_px), 2.0, double{kMostSamples}));
  if (samples >= kEdgeSamples) return {sample_set(samples)};
  return {sample_set(samples, render::Pixels::inside_faces),
          sample_set(kEdgeSamples, render::Pixels::at_edges)};
}

}  // namespace fusebench::simulator::sensors
