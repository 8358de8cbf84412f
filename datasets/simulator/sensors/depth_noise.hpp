// Noise models of depth sensors. Images in metres, 0 without a measurement; deterministic for a key.
#pragma once

#include <cstdint>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/simulator/sensors/native_pixels.hpp"

namespace fusebench::simulator::sensors {

/// Structured light, after Handa et al. (ICRA 2014) and Barron & Malik (CVPR 2013); see
/// depth_noise_handa.cpp.
[[nodiscard]] DepthImage structured_light_depth(const Image<render::Renderer::Surface>& surfaces,
                                                const NativePixels& native, std::uint64_t key,
                                                const Workers& workers);

/// Active stereo as in the R200 and ZR300; see depth_noise_zr300.cpp.
[[nodiscard]] DepthImage active_stereo_depth(const Image<render::Renderer::Surface>& surfaces,
                                             const NativePixels& native, std::uint64_t key,
                                             const Workers& workers);

/// A Kinect with realistic steps; those of ICL-NUIM's noisy sequences (a centimetre) are too coarse at short
/// range. See depth_noise_zr300.cpp, which has the same model.
[[nodiscard]] DepthImage kinect_depth(const Image<render::Renderer::Surface>& surfaces,
                                      const NativePixels& native, std::uint64_t key, const Workers& workers);

}  // namespace fusebench::simulator::sensors
