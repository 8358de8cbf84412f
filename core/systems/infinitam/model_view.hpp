// What a camera sees of the model: the surface point behind each pixel, its normal and its weight.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/raycast/raycast.hpp"
#include "core/systems/point_map.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::systems::infinitam {

struct ModelView {
  PinholeCamera camera;
  SE3 T_world_camera;
  PointMap point;       ///< world, metres
  PointMap normal;      ///< unit, towards the camera
  Image<float> weight;  ///< of the model at the point; negative where there is no point with a normal
};

/// Renders views of a model, and keeps the memory for it.
class ModelRenderer {
 public:
  ModelRenderer(const PinholeCamera& camera, const config::DepthConfig& depth);

  /// Normals are cross products of differences over two pixels either way; over one where these are not
  /// there or 15 cm apart. with_weights: false leaves 1 in place of each weight.
  void render(const tsdf::TsdfVolume& model, const SE3& T_world_camera, bool with_weights,
              const Workers& workers, ModelView& view);

 private:
  PinholeCamera camera_;
  config::DepthConfig depth_;
  std::vector<raycast::PixelRay> rays_;
  std::vector<raycast::SurfacePoint> surfaces_;
};

}  // namespace fusebench::systems::infinitam
