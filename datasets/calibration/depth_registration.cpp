#include "datasets/calibration/depth_registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::calibration {

namespace {

// Neighbours are on one surface if their depths differ by less than this share: a slope of 87 degrees at the
// focal length of a ZR300. Wider steps are edges; what remains of narrower ones is below the sensor's noise.
constexpr float kMaxStep = 0.03F;
// Rectangles of neighbours share their borders only up to the skew between rows; without an overlap, pixels
// at their corners would be missed.
constexpr float kOverlap_px = 0.02F;
constexpr float kFar = std::numeric_limits<float>::infinity();

/// One row of measurements in the colour image. An entry more on each side has no depth, so that every
/// measurement has neighbours. Where there is no measurement, depth_m is 0 and the rest any finite number.
struct ProjectedRow {
  std::vector<float> u_px;
  std::vector<float> v_px;
  std::vector<float> depth_m;  ///< in the colour camera
  std::vector<float> half_px;  ///< half of a pixel of the depth camera, in the colour image

  explicit ProjectedRow(std::size_t width)
      : u_px(width + 2), v_px(width + 2), depth_m(width + 2), half_px(width + 2) {}
};

/// What measurements cover along one axis of the image: pixels first to end - 1, and the slope in metres per
/// pixel.
struct Cover {
  std::vector<int> first;
  std::vector<int> end;
  std::vector<float> slope;

  explicit Cover(std::size_t width) : first(width), end(width), slope(width) {}
};

/// The neighbours of a row's measurements along one axis, and the positions on it.
struct Axis {
  const float* at_px;
  const float* before_m;
  const float* before_px;
  const float* after_m;
  const float* after_px;
  int size_px;  ///< of the image
};

/// Both sides are computed before the choice, so that the compiler makes vector instructions of a loop: it
/// may not compute what the program would skip.
template <class T>
T select(bool condition, T yes, T no) {
  return condition ? yes : no;
}

void find_cover(const float* depth_m, const float* half_px, const Axis& axis, Cover& cover) {
  const auto size = static_cast<float>(axis.size_px);
  int* const first = cover.first.data();
  int* const end = cover.end.data();
  float* const slope = cover.slope.data();
  const auto [at_px, before_m, before_px, after_m, after_px, unused] = axis;
  const std::size_t count = cover.first.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float z = depth_m[i];
    const float at = at_px[i];
    const float half = half_px[i];
    const float back_m = z - before_m[i];
    const float ahead_m = after_m[i] - z;
    const float back_px = at - before_px[i];
    const float ahead_px = after_px[i] - at;
    // A missing neighbour has depth 0, which is more than a step away from any measurement.
    const float step_m = kMaxStep * z;
    const bool joined_back = std::abs(back_m) < step_m;
    const bool joined_ahead = std::abs(ahead_m) < step_m;
    // A surface seen from behind by the colour camera has its neighbours in the wrong order. It keeps its
    // half pixels, and nearer surfaces hide it.
    const float low_px = select(joined_back & (back_px > 0), 0.5F * back_px, half);
    const float high_px = select(joined_ahead & (ahead_px > 0), 0.5F * ahead_px, half);
    const float low = std::ceil(at - low_px - kOverlap_px);
    const float high = std::floor(at + high_px + kOverlap_px) + 1;
    // In this order, what is no number becomes 0 and covers nothing: a depth so small that its inverse is
    // infinite.
    first[i] = static_cast<int>(std::min(std::max(0.0F, low), size));
    end[i] = static_cast<int>(std::min(std::max(0.0F, high), size));
    const float span_px = select(joined_back, back_px, 0.0F) + select(joined_ahead, ahead_px, 0.0F);
    const float rise_m = select(joined_back, back_m, 0.0F) + select(joined_ahead, ahead_m, 0.0F);
    slope[i] = select(span_px > half, rise_m / std::max(span_px, half), 0.0F);
  }
}

/// Draws the measurements of a row.
void splat_row(const ProjectedRow& row, const Cover& x, const Cover& y, DepthImage& nearest_m) {
  for (std::size_t i = 0; i < x.first.size(); ++i) {
    const float z = row.depth_m[i + 1];
    if (!(z > 0)) continue;
    for (int py = y.first[i]; py < y.end[i]; ++py) {
      const float z_row = z + y.slope[i] * (static_cast<float>(py) - row.v_px[i + 1]);
      for (int px = x.first[i]; px < x.end[i]; ++px) {
        float& kept_m = nearest_m(px, py);
        kept_m = std::min(kept_m, z_row + x.slope[i] * (static_cast<float>(px) - row.u_px[i + 1]));
      }
    }
  }
}

}  // namespace

DepthRegistration::DepthRegistration(const PinholeCamera& depth_camera, const PinholeCamera& color_camera,
                                     const SE3& T_color_depth)
    : depth_camera_(depth_camera), color_camera_(color_camera) {
  check(depth_camera.width_px > 0 && color_camera.width_px > 0,
        "registration needs the sizes of both images");
  Matrix3d K_color;
  K_color << color_camera.fx_px, 0, color_camera.cx_px, 0, color_camera.fy_px, color_camera.cy_px, 0, 0, 1;
  const Matrix3d to_color = K_color * T_color_depth.rotation_matrix();
  ray_by_u_ = (to_color.col(0) / depth_camera.fx_px).cast<float>();
  ray_by_v_ = (to_color.col(1) / depth_camera.fy_px).cast<float>();
  ray_at_origin_ = (to_color * depth_camera.back_project(0, 0, 1)).cast<float>();
  offset_ = (K_color * T_color_depth.translation).cast<float>();
  pixel_scale_ = static_cast<float>(
      std::max(color_camera.fx_px / depth_camera.fx_px, color_camera.fy_px / depth_camera.fy_px));
}

DepthImage DepthRegistration::register_depth(const DepthImage& depth_m) const {
  check(depth_m.width == depth_camera_.width_px && depth_m.height == depth_camera_.height_px,
        "the image has the size of its camera");
  const auto width = static_cast<std::size_t>(depth_m.width);
  const float half_pixel = 0.5F * pixel_scale_;
  const auto project = [&](int v, ProjectedRow& row) {
    const Eigen::Vector3f ray = ray_at_origin_ + static_cast<float>(v) * ray_by_v_;
    const float* const measured_m = &depth_m.data[depth_m.index(0, v)];
    float* const u_px = &row.u_px[1];
    float* const v_px = &row.v_px[1];
    float* const half_px = &row.half_px[1];
    float* const color_m = &row.depth_m[1];
    const Eigen::Vector3f by_u = ray_by_u_;
    const Eigen::Vector3f offset = offset_;
#pragma GCC ivdep
    for (int i = 0; i < depth_m.width; ++i) {
      const auto u = static_cast<float>(i);
      const float z = measured_m[i];
      const float depth = z * (ray.z() + u * by_u.z()) + offset.z();
      const bool seen = (z > 0) & (depth > 0);
      const float inverse = 1.0F / select(seen, depth, 1.0F);
      u_px[i] = (z * (ray.x() + u * by_u.x()) + offset.x()) * inverse;
      v_px[i] = (z * (ray.y() + u * by_u.y()) + offset.y()) * inverse;
      half_px[i] = half_pixel * z * inverse;
      color_m[i] = select(seen, depth, 0.0F);
    }
  };
  DepthImage nearest_m(color_camera_.width_px, color_camera_.height_px, kFar);
  std::array<ProjectedRow, 3> rows{ProjectedRow(width), ProjectedRow(width), ProjectedRow(width)};
  const ProjectedRow nothing(width);
  Cover x(width);
  Cover y(width);
  const auto at = [&](int v) -> ProjectedRow& { return rows[static_cast<std::size_t>(v) % 3]; };
  project(0, at(0));
  for (int v = 0; v < depth_m.height; ++v) {
    const bool last = v + 1 == depth_m.height;
    if (!last) project(v + 1, at(v + 1));
    const ProjectedRow& row = at(v);
    const ProjectedRow& above = v > 0 ? at(v - 1) : nothing;
    const ProjectedRow& below = last ? nothing : at(v + 1);
    const float* const z = &row.depth_m[1];
    const float* const u = &row.u_px[1];
    find_cover(z, &row.half_px[1], {u, z - 1, u - 1, z + 1, u + 1, nearest_m.width}, x);
    find_cover(z, &row.half_px[1],
               {&row.v_px[1], &above.depth_m[1], &above.v_px[1], &below.depth_m[1], &below.v_px[1],
                nearest_m.height},
               y);
    splat_row(row, x, y, nearest_m);
  }
  std::ranges::replace(nearest_m.data, kFar, 0.0F);
  return nearest_m;
}

}  // namespace fusebench::calibration
