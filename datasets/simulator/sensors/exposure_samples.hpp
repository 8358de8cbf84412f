// Instants of an exposure, and places within the pixel, at which light is sampled.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "datasets/simulator/render/renderer.hpp"

namespace fusebench::simulator::sensors {

/// Samples that are averaged: the i-th of n at the share (i + 1/2) / n of the exposure.
struct SampleSet {
  std::vector<Vector2d> offsets_px;  ///< of the rays, from the middle of the pixel
  /// Side of the square over which each sample averages the texture. It makes up for samples that cover
  /// little of the pixel: the blur of a still image has the same variance for any number of samples.
  float footprint_px = 1;
  render::Pixels pixels = render::Pixels::all;
};

/// samples: at least 1.
[[nodiscard]] SampleSet sample_set(int samples, render::Pixels pixels = render::Pixels::all);

/// The sets that expose an image which moves by so many pixels during the exposure: a sample for each two
/// pixels (Kotelnikov would ask for two a pixel of an image with the pixels' own sharpness; blur has little
/// left of that), one where it moves by less than one. Pixels at edges, whose surfaces have no texture to
/// average over, get four at least.
[[nodiscard]] std::vector<SampleSet> samples_of_motion(double motion_px);

}  // namespace fusebench::simulator::sensors
