// Processing of a low-cost colour camera from light to the 8-bit image: colour filter mosaic, photon and read
// noise, demosaicing, white balance, tone curve.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"

namespace fusebench::simulator::sensors {

/// Off: each pixel measures three colours with independent noise (ColorSensor).
struct ColorProcessing {
  bool mosaic = false;
  /// Standard deviation of the shot noise of red, green and blue at light 1 and gain 1; at light L and gain
  /// g, multiplied by sqrt(g L).
  std::array<double, 3> shot_noise{};
  double read_noise = 0;  ///< of each pixel, in units of light, at gain 1
  /// Weight of the 3x3 mean in each pixel after demosaicing; negative values sharpen.
  double smoothing = 0;
  double contrast = 0;  ///< 0 to 1: share of a tone curve that is steep in the middle
};

/// light: linear, with vignetting and all gains; gain: the part of the amplifier. Deterministic for a key.
[[nodiscard]] ColorImage processed_color(const Image<Eigen::Vector3f>& light,
                                         const ColorProcessing& processing, double gain, std::uint64_t key,
                                         const Workers& workers);

}  // namespace fusebench::simulator::sensors
