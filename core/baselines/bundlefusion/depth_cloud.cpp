#include "core/baselines/bundlefusion/depth_cloud.hpp"

#include <algorithm>

namespace fusebench::baselines::bundlefusion {

namespace {

using Eigen::Vector3f;

constexpr int kColumns = 80;             // of an image of 640 pixels, whose cells are 8 pixels wide
constexpr float kSameSurface_m = 0.05F;  // within a cell, and along z between the points of a normal
constexpr float kMaxDistance_m = 0.15F;
constexpr float kMinNormalProduct = 0.97F;

/// Camera of the small image: the centre of a cell of n pixels is (n - 1) / 2 pixels from its first pixel.
PinholeCamera camera_of_cells(const PinholeCamera& camera, int cell_px) {
  const double middle_px = 0.5 * (cell_px - 1);
  return {
      camera.width_px / cell_px, camera.height_px / cell_px,           camera.fx_px / cell_px,
      camera.fy_px / cell_px,    (camera.cx_px - middle_px) / cell_px, (camera.cy_px - middle_px) / cell_px};
}

/// Mean depth of the surface at the centre of a cell; 0 if there is none.
float cell_depth_m(const DepthImage& depth_m, int left_px, int top_px, int cell_px) {
  const float middle_m = depth_m(left_px + cell_px / 2, top_px + cell_px / 2);
  if (!(middle_m > 0)) return 0;
  float sum_m = 0;
  float count = 0;
  for (int y = top_px; y < top_px + cell_px; ++y) {
    for (int x = left_px; x < left_px + cell_px; ++x) {
      const float z_m = depth_m(x, y);
      if (!(z_m > 0) || std::abs(z_m - middle_m) > kSameSurface_m) continue;
      sum_m += z_m;
      count += 1;
    }
  }
  return sum_m / count;
}

/// Zero if a neighbour is missing or too distant.
Vector3f normal_at(const Image<Vector3f>& points, int x, int y) {
  const Vector3f& middle = points(x, y);
  const Vector3f &left = points(x - 1, y), &right = points(x + 1, y);
  const Vector3f &above = points(x, y - 1), &below = points(x, y + 1);
  for (const Vector3f* const neighbour : {&left, &right, &above, &below}) {
    if (!(neighbour->z() > 0) || std::abs(neighbour->z() - middle.z()) > kSameSurface_m)
      return Vector3f::Zero();
  }
  const Vector3f normal = (below - above).cross(right - left).normalized();
  return normal.dot(middle) > 0 ? Vector3f(-normal) : normal;
}

}  // namespace

std::optional<std::size_t> DepthCloud::cell_at(const Vector3f& point_camera) const {
  if (!(point_camera.z() > 0)) return std::nullopt;
  const Vector2d pixel = camera.project(point_camera.cast<double>());
  // Compared in floating point: a point near the plane of the camera projects beyond the range of integers.
  if (!(pixel.x() > -0.5 && pixel.y() > -0.5 && pixel.x() < points.width - 0.5 &&
        pixel.y() < points.height - 0.5))
    return std::nullopt;
  const std::size_t cell =
      points.index(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
  if (normals.data[cell].isZero(0)) return std::nullopt;
  return cell;
}

DepthCloud make_depth_cloud(const DepthImage& depth_m, const PinholeCamera& camera) {
  const int cell_px = std::max(1, (camera.width_px + kColumns / 2) / kColumns);
  DepthCloud cloud;
  cloud.camera = camera_of_cells(camera, cell_px);
  const int width = cloud.camera.width_px;
  const int height = cloud.camera.height_px;
  cloud.points = Image<Vector3f>(width, height, Vector3f::Zero());
  cloud.normals = Image<Vector3f>(width, height, Vector3f::Zero());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float z_m = cell_depth_m(depth_m, x * cell_px, y * cell_px, cell_px);
      if (z_m > 0)
        cloud.points(x, y) = cloud.camera.back_project(x, y, static_cast<double>(z_m)).cast<float>();
    }
  }
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      if (cloud.points(x, y).z() > 0) cloud.normals(x, y) = normal_at(cloud.points, x, y);
    }
  }
  return cloud;
}

bool are_of_one_surface(const Vector3f& point, const Vector3f& normal, const Vector3f& other_point,
                        const Vector3f& other_normal) {
  return (point - other_point).squaredNorm() < kMaxDistance_m * kMaxDistance_m &&
         normal.dot(other_normal) >= kMinNormalProduct;
}

}  // namespace fusebench::baselines::bundlefusion
