#include "eval/metrics/mesh_error/mesh_views.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace fusebench::mesh_error {

namespace {

constexpr std::size_t kPointsPerChunk = 1024;

// Nearer to a point than this, what lies in front of it is taken for the point's own surface.
constexpr double kOwnSurface_m = 0.01;

// How far behind a measurement its surface may be: what sensors and registered depth get wrong.
constexpr double kBehind_m = 0.03;
constexpr double kBehind = 0.02;

/// What stands between a camera and a point that is in its image, or does not.
bool is_open(const Vector3d& point_truth, const Vector2d& pixel, double depth_m, const TriangleTree& truth,
             const MeshViews& views, std::size_t view) {
  switch (views.culling) {
    case Culling::frustum:
      return true;
    case Culling::occlusion: {
      const Vector3d& eye = views.T_truth_camera[view].translation;
      const double distance_m = (point_truth - eye).norm();
      const double clear = std::max(0.0, 1 - kOwnSurface_m / distance_m);
      return !truth.blocked(eye, eye + clear * (point_truth - eye));
    }
    case Culling::depth: {
      const double measured_m = views.depth_m[view](static_cast<int>(std::floor(pixel.x() + 0.5)),
                                                    static_cast<int>(std::floor(pixel.y() + 0.5)));
      return measured_m > 0 && depth_m < measured_m + std::max(kBehind_m, kBehind * measured_m);
    }
  }
  return false;
}

/// Views of which one may see a point, tried in turn from the one that saw the last point.
bool is_observed(const Vector3d& point_truth, const TriangleTree& truth, const MeshViews& views,
                 std::span<const SE3> T_camera_truth, std::size_t& first_view) {
  const PinholeCamera& camera = views.camera;
  for (std::size_t tried = 0; tried < T_camera_truth.size(); ++tried) {
    const std::size_t view = (first_view + tried) % T_camera_truth.size();
    const Vector3d point_camera = T_camera_truth[view] * point_truth;
    const double depth_m = point_camera.z();
    if (!(depth_m > 0 && depth_m >= views.min_depth_m && depth_m <= views.max_depth_m)) continue;
    const Vector2d pixel = camera.project(point_camera);
    if (!(pixel.x() >= -0.5 && pixel.x() < camera.width_px - 0.5)) continue;
    if (!(pixel.y() >= -0.5 && pixel.y() < camera.height_px - 0.5)) continue;
    if (!is_open(point_truth, pixel, depth_m, truth, views, view)) continue;
    first_view = view;
    return true;
  }
  return false;
}

}  // namespace

std::string_view to_string(Culling culling) {
  switch (culling) {
    case Culling::frustum:
      return "frustum";
    case Culling::occlusion:
      return "occlusion";
    case Culling::depth:
      return "depth";
  }
  return "";
}

std::vector<std::size_t> observed_points(std::span<const Vector3d> points_truth, const TriangleTree& truth,
                                         const MeshViews& views, const Workers& workers) {
  check(views.culling != Culling::depth || views.depth_m.size() == views.T_truth_camera.size(),
        "a view has its depth image");
  std::vector<SE3> T_camera_truth;
  for (const SE3& T_truth_camera : views.T_truth_camera) T_camera_truth.push_back(T_truth_camera.inverse());
  const auto parts = workers.map_chunks<std::vector<std::size_t>>(
      points_truth.size(), kPointsPerChunk, [&](std::size_t begin, std::size_t end) {
        std::vector<std::size_t> seen;
        std::size_t first_view = 0;
        for (std::size_t i = begin; i < end; ++i) {
          if (is_observed(points_truth[i], truth, views, T_camera_truth, first_view)) seen.push_back(i);
        }
        return seen;
      });
  std::vector<std::size_t> observed;
  for (const auto& part : parts) observed.insert(observed.end(), part.begin(), part.end());
  return observed;
}

}  // namespace fusebench::mesh_error
