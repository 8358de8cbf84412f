// Reads scenes from mesh files.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

struct SceneFileOptions {
  bool y_up = false;             ///< the file's y axis points up (its z axis becomes -y)
  double metres_per_unit = 1.0;  ///< 1e-6 to 1e6
};

/// Reads a scene from a PLY (read_ply()) or Wavefront OBJ file, by its extension. Vertex colours are used as
/// they are (sRGB, with lighting). A mesh without colours has no trackable texture, so it gets a speckled
/// texture (1.2 m per repeat, projected along the dominant axis of each triangle) and a light from above.
/// Materials and texture images of OBJ files are ignored. free_space is the inner fifth of the bounding box
/// and not checked to be empty. Errors: usage (another extension), configuration (metres_per_unit),
/// data_missing (no such file), data_corrupt (it cannot be read, has no triangles, numbers that are not
/// finite, or vertices more than 1000 km from the origin).
[[nodiscard]] Result<SimulatedScene> read_scene(const std::filesystem::path& file,
                                                const SceneFileOptions& options = {});

}  // namespace fusebench::simulator::scene
