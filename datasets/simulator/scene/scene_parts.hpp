// Scenes that are put together from parts which were built and lit on their own.
#pragma once

#include "core/base/types.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// Coordinates of parts are rounded to this grid (8 micrometres). A shift by a multiple of it, up to 128 m,
/// is exact in single precision, so that copies of a part agree to the bit wherever they stand.
inline constexpr double kPartGrid_m = 0x1p-17;

/// Adds the textures of a part to a scene. Returns the index of the first one, for add_part().
[[nodiscard]] std::int32_t add_part_textures(SimulatedScene& scene, const SimulatedScene& part);

/// Adds the surfaces of a part, with their light, moved by shift_m (multiples of kPartGrid_m). Every triangle
/// of the part has a texture; gloss and screens are not taken over. Copies may share their textures.
void add_part(SimulatedScene& scene, const SimulatedScene& part, std::int32_t first_texture,
              const Vector3d& shift_m);

}  // namespace fusebench::simulator::scene
