// Rendered view of the model: surface point, normal and weight at each pixel.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/baselines/point_map.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/estimator/model/raycast/raycast.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::baselines::infinitam {

struct ModelView {
  PinholeCamera camera;
  SE3 T_world_camera;
  PointMap point;       ///< world, metres
  PointMap normal;      ///< world, unit, towards the camera
  Image<float> weight;  ///< weight of the model at the point; negative without a point and normal
};

/// Renders views of a model and reuses its buffers.
class ModelRenderer {
 public:
  ModelRenderer(const PinholeCamera& camera, const config::DepthConfig& depth);

  /// Normals are cross products of differences over two pixels to either side, or one pixel if these are
  /// missing or more than 15 cm apart. with_weights: false sets all weights to 1.
  void render(const tsdf::TsdfVolume& model, const SE3& T_world_camera, bool with_weights,
              const Workers& workers, ModelView& view);

 private:
  PinholeCamera camera_;
  config::DepthConfig depth_;
  std::vector<raycast::PixelRay> rays_;
  std::vector<raycast::SurfacePoint> surfaces_;
};

}  // namespace fusebench::baselines::infinitam
