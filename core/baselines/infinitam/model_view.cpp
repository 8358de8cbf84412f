#include "core/baselines/infinitam/model_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/baselines/image_rows.hpp"

namespace fusebench::baselines::infinitam {

namespace {

constexpr int kBorder_px = 3;  // without normals
constexpr double kNearNeighbours_m = 0.15;

/// Weight of the voxel nearest to the point; 0 if it was never observed.
float weight_at(const tsdf::TsdfVolume& model, const Vector3d& point_world) {
  const auto place = model.nearest_voxel(point_world);
  return place ? model.voxel(place->slot, place->offset).weight : 0.0F;
}

/// Differences of the points around a pixel: right minus left, below minus above.
struct Differences {
  Vector3d across;
  Vector3d down;

  [[nodiscard]] bool are_near() const {
    return std::max(across.squaredNorm(), down.squaredNorm()) <= kNearNeighbours_m * kNearNeighbours_m;
  }
};

/// Surface points of a view, for the computation of normals.
class RenderedPoints {
 public:
  RenderedPoints(const std::vector<raycast::SurfacePoint>& surfaces, const PinholeCamera& camera)
      : surfaces_(surfaces), camera_(camera) {}

  /// Point in the camera frame.
  [[nodiscard]] std::optional<Vector3d> at(int x, int y) const {
    const auto pixel = static_cast<std::size_t>(y * camera_.width_px + x);
    if (!surfaces_[pixel].valid) return std::nullopt;
    return camera_.back_project(x, y, surfaces_[pixel].depth_m);
  }

  /// Unit normal in the camera frame, towards the camera.
  [[nodiscard]] std::optional<Vector3d> normal_at(int x, int y) const {
    const auto point = at(x, y);
    const bool inside = x >= kBorder_px && y >= kBorder_px && x < camera_.width_px - kBorder_px &&
                        y < camera_.height_px - kBorder_px;
    if (!point || !inside) return std::nullopt;
    auto differences = differences_at(x, y, 2);
    if (!differences || !differences->are_near()) differences = differences_at(x, y, 1);
    if (!differences) return std::nullopt;
    // y points down, so down x across points towards the camera.
    const Vector3d normal = differences->down.cross(differences->across).normalized();
    if (!(normal.dot(*point) < 0)) return std::nullopt;
    return normal;
  }

 private:
  [[nodiscard]] std::optional<Differences> differences_at(int x, int y, int reach_px) const {
    const auto left = at(x - reach_px, y), right = at(x + reach_px, y);
    const auto above = at(x, y - reach_px), below = at(x, y + reach_px);
    if (!left || !right || !above || !below) return std::nullopt;
    return Differences{*right - *left, *below - *above};
  }

  const std::vector<raycast::SurfacePoint>& surfaces_;
  const PinholeCamera& camera_;
};

}  // namespace

ModelRenderer::ModelRenderer(const PinholeCamera& camera, const config::DepthConfig& depth)
    : camera_(camera), depth_(depth) {
  rays_.reserve(static_cast<std::size_t>(camera.width_px * camera.height_px));
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x)
      rays_.push_back({static_cast<double>(x), static_cast<double>(y)});
  }
}

void ModelRenderer::render(const tsdf::TsdfVolume& model, const SE3& T_world_camera, bool with_weights,
                           const Workers& workers, ModelView& view) {
  view.camera = camera_;
  view.T_world_camera = T_world_camera;
  view.point.resize(camera_.width_px, camera_.height_px);
  view.normal.resize(camera_.width_px, camera_.height_px);
  view.weight.resize(camera_.width_px, camera_.height_px);
  const auto field = tsdf::field_in_view(model, camera_, T_world_camera, depth_);
  if (!field) {
    std::ranges::fill(view.weight.data, -1.0F);
    return;
  }
  raycast::raycast_pixels(*field, camera_, T_world_camera, rays_, depth_, workers, surfaces_);
  const RenderedPoints points(surfaces_, camera_);
  workers.for_chunks(static_cast<std::size_t>(camera_.height_px), kRowsAtOnce,
                     [&](std::size_t begin, std::size_t end) {
                       for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                         for (int x = 0; x < camera_.width_px; ++x) {
                           const std::size_t pixel = view.weight.index(x, y);
                           const auto normal = points.normal_at(x, y);
                           view.weight.data[pixel] = -1.0F;
                           view.point.put(pixel, Eigen::Vector3f::Zero());
                           view.normal.put(pixel, Eigen::Vector3f::Zero());
                           if (!normal) continue;
                           const Vector3d point_world = T_world_camera * *points.at(x, y);
                           view.point.put(pixel, point_world.cast<float>());
                           view.normal.put(pixel, (T_world_camera.rotation * *normal).cast<float>());
                           view.weight.data[pixel] = with_weights ? weight_at(model, point_world) : 1.0F;
                         }
                       }
                     });
}

}  // namespace fusebench::baselines::infinitam
