#include "datasets/simulator/render/visible_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fusebench::simulator::render {

namespace {

/// Threshold of the relative second difference of inverse depth (0 on a plane) for an edge.
constexpr float kDepthJump = 0.02F;
constexpr int kMotionStep_px = 16;

/// Tests three pixels in a line.
bool has_jump(float before, float middle, float after) {
  return std::abs(before + after - 2 * middle) > kDepthJump * middle;
}

/// Maximum within `reach` of each pixel, in both directions. Each step doubles the window.
Image<float> greatest_around(const Image<float>& image, int reach) {
  Image<float> result = image;
  const auto widen = [&](std::ptrdiff_t shift, int columns, int rows) {
    for (int v = 0; v < rows; ++v) {
      float* row = &result(0, v);
      for (int u = 0; u < columns; ++u) row[u] = std::max(row[u], row[u + shift]);
    }
  };
  // Windows of 2 reach + 1 from a pixel on, along rows and columns, which are then centred.
  const int side = 2 * reach + 1;
  for (int covered = 1; covered < side; covered *= 2) {
    const int step = std::min(covered, side - covered);
    widen(step, result.width - step, result.height);
    widen(static_cast<std::ptrdiff_t>(step) * result.width, result.width, result.height - step);
  }
  Image<float> centred(image.width, image.height);
  for (int v = 0; v < image.height; ++v) {
    const float* from = &result(0, std::max(0, v - reach));
    for (int u = 0; u < image.width; ++u) centred(u, v) = from[std::max(0, u - reach)];
  }
  return centred;
}

}  // namespace

void mark_edges(const std::int32_t* faces, VisibleTriangles& visible) {
  const int width = visible.triangle.width;
  const int height = visible.triangle.height;
  Image<std::int32_t> face(width, height);
  std::ranges::transform(visible.triangle.data, face.data.begin(), [&](std::int32_t triangle) {
    return triangle < 0 ? VisibleTriangles::kEdge : faces[triangle];
  });
  visible.face = Image<std::int32_t>(width, height, VisibleTriangles::kEdge);
  const Image<float>& w = visible.inverse_depth_per_m;
  for (int v = 1; v + 1 < height; ++v) {
    for (int u = 1; u + 1 < width; ++u) {
      const std::int32_t own = face(u, v);
      std::int32_t other = 0;
      for (int dv = -1; dv <= 1; ++dv) {
        const std::int32_t* row = &face(u - 1, v + dv);
        other |= (row[0] ^ own) | (row[1] ^ own) | (row[2] ^ own);
      }
      if (other != 0 || has_jump(w(u - 1, v), w(u, v), w(u + 1, v)) ||
          has_jump(w(u, v - 1), w(u, v), w(u, v + 1)))
        continue;
      visible.face(u, v) = own;
    }
  }
}

void find_nearest_around(int distance_px, VisibleTriangles& visible) {
  visible.nearest_inverse_depth_per_m = greatest_around(visible.inverse_depth_per_m, distance_px);
}

double longest_image_motion_px(const VisibleTriangles& visible, const rays::RayField& rays,
                               const RowPoses& begin, const RowPoses& end) {
  const PinholeCamera& camera = rays.camera();
  const auto width = static_cast<std::size_t>(camera.width_px);
  std::vector<float> x(width), y(width);
  double longest2_px = 0;
  for (int v = 0; v < camera.height_px; v += kMotionStep_px) {
    rays.row(v, Vector2d::Zero(), x, y);
    const SE3 T_end_begin = end.of_row(v).inverse() * begin.of_row(v);
    const Matrix3d R = T_end_begin.rotation_matrix();
    for (int u = 0; u < camera.width_px; u += kMotionStep_px) {
      const Vector3d ray(static_cast<double>(x[static_cast<std::size_t>(u)]),
                         static_cast<double>(y[static_cast<std::size_t>(u)]), 1.0);
      const Vector3d moved =
          R * ray + static_cast<double>(visible.inverse_depth_per_m(u, v)) * T_end_begin.translation;
      if (moved.z() < 0.1) continue;  // at or behind the camera: no length in pixels
      const Vector2d step = moved.head<2>() / moved.z() - ray.head<2>();
      longest2_px =
          std::max(longest2_px, step.cwiseProduct(Vector2d(camera.fx_px, camera.fy_px)).squaredNorm());
    }
  }
  return std::sqrt(longest2_px);
}

}  // namespace fusebench::simulator::render
