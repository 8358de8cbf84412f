// Combines scenes from parts that were built and lit separately.
#pragma once

#include "core/base/types.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// Grid of the coordinates of parts (8 micrometres). A shift by a multiple of it, up to 128 m, is exact in
/// single precision, so copies of a part are bit-identical at any position.
inline constexpr double kPartGrid_m = 0x1p-17;

/// Adds the textures of a part to a scene. Returns the index of the first one for add_part().
[[nodiscard]] std::int32_t add_part_textures(SimulatedScene& scene, const SimulatedScene& part);

/// Adds the surfaces of a part with their light, moved by shift_m (multiples of kPartGrid_m). Each triangle
/// of the part must have a texture; gloss and screens are not copied. Copies may share their textures.
void add_part(SimulatedScene& scene, const SimulatedScene& part, std::int32_t first_texture,
              const Vector3d& shift_m);

}  // namespace fusebench::simulator::scene
