// Scenes from mesh files.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

struct SceneFileOptions {
  bool y_up = false;             ///< the file's y axis points up (its z axis becomes -y)
  double metres_per_unit = 1.0;  ///< 1e-6 to 1e6
};

/// A scene from a PLY (read_ply()) or Wavefront OBJ file, by the name's ending. Vertex colours are taken as
/// they are (sRGB, lighting included). A mesh without them cannot be tracked by its looks, so it gets a
/// speckled texture (1.2 m a repeat, laid on along the axis that a triangle faces most) and a light from
/// above. Materials and texture images of OBJ files are not used. free_space is the inner fifth of the
/// bounding box and not checked to be empty. Errors: usage (another ending), configuration (metres_per_unit),
/// data_missing (no such file), data_corrupt (it cannot be read, has no triangles, numbers that are not
/// finite, or vertices more than 1000 km from the origin).
[[nodiscard]] Result<SimulatedScene> read_scene(const std::filesystem::path& file,
                                                const SceneFileOptions& options = {});

}  // namespace fusebench::simulator::scene
