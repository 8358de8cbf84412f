// From the light on the pixels of a colour camera to its 8-bit image, as the electronics of a cheap one make
// it: one colour a pixel behind a mosaic of filters, noise of photons and of the read-out, interpolation of
// the missing colours, white balance, a tone curve.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"

namespace fusebench::simulator::sensors {

/// Off: every pixel measures three colours, each with noise of its own (ColorSensor).
struct ColorProcessing {
  bool mosaic = false;
  /// Standard deviation of the shot noise of red, green and blue at light 1 and gain 1; at light L and gain g
  /// it is this times sqrt(g L).
  std::array<double, 3> shot_noise{};
  double read_noise = 0;  ///< of each pixel, in light, at gain 1
  /// Share of the mean of its 3x3 neighbours that a pixel takes on after the interpolation; negative
  /// sharpens.
  double smoothing = 0;
  double contrast = 0;  ///< 0 to 1: share of a tone curve that is steep in the middle
};

/// light: linear, with vignetting and all gains; gain: the amplifier's part of them. The same key gives the
/// same bytes.
[[nodiscard]] ColorImage processed_color(const Image<Eigen::Vector3f>& light,
                                         const ColorProcessing& processing, double gain, std::uint64_t key,
                                         const Workers& workers);

}  // namespace fusebench::simulator::sensors
