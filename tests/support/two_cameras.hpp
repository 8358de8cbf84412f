// The two cameras of FMDataset's ZR300 before the textured room: exact depth in both, to hold registrations
// against.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/types.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench::testing {

struct TwoCameras {
  PinholeCamera depth{640, 480, 583.980, 583.980, 325.103, 240.718};
  PinholeCamera color{640, 480, 608.446, 607.847, 331.332, 245.549};
  SE3 T_color_depth;

  TwoCameras() {
    Matrix3d R;
    R << 0.999980211, -0.00069964811, -0.0062491186, 0.000735448557, 0.999983311, 0.00572841847,
        0.00624500681, -0.00573290139, 0.999964058;
    T_color_depth = {Quaterniond(R).normalized(), {-0.057460, -0.001073, -0.002205}};
  }
};

/// z-depth between the centres of pixels, by ray casting.
inline double exact_depth_m(const TexturedRoom& room, const PinholeCamera& camera, const SE3& T_world_camera,
                            double u_px, double v_px) {
  return room.hit(T_world_camera.translation, T_world_camera.rotation * camera.back_project(u_px, v_px, 1.0));
}

inline DepthImage exact_depth(const TexturedRoom& room, const PinholeCamera& camera,
                              const SE3& T_world_camera) {
  DepthImage depth_m(camera.width_px, camera.height_px);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x)
      depth_m(x, y) = static_cast<float>(exact_depth_m(room, camera, T_world_camera, x, y));
  }
  return depth_m;
}

/// Where the depth camera stands in the views that registrations are measured with.
inline std::vector<SE3> registration_views() {
  return {{so3_exp({0.02, -0.05, 0.01}), {0.05, 0.05, -0.1}},
          {so3_exp({0.15, 0.3, -0.05}), {-0.3, 0.0, 0.2}},
          {so3_exp({-0.1, -0.35, 0.2}), {0.4, -0.1, 0.3}}};
}

/// How registered depth compares with the truth of the colour camera, over some views.
struct RegistrationQuality {
  static constexpr double kWrongSurface_m = 0.05;

  std::size_t pixels = 0;        ///< of the colour images
  std::size_t with_depth = 0;    ///< of them
  std::size_t seen_by_both = 0;  ///< pixels whose surface the depth camera sees as well
  std::size_t missed = 0;        ///< of seen_by_both: no registered depth
  std::size_t too_near = 0;      ///< of with_depth: a surface in front of the true one
  std::size_t too_far = 0;       ///< of with_depth: a surface behind the true one
  std::vector<double> errors_m;  ///< absolute, of with_depth

  void add(const TexturedRoom& room, const TwoCameras& cameras, const SE3& T_world_depth,
           const DepthImage& registered_m) {
    const SE3 T_world_color = T_world_depth * cameras.T_color_depth.inverse();
    const DepthImage truth_m = exact_depth(room, cameras.color, T_world_color);
    const SE3 T_depth_color = cameras.T_color_depth.inverse();
    for (int y = 0; y < truth_m.height; ++y) {
      for (int x = 0; x < truth_m.width; ++x) {
        const double true_m = truth_m(x, y);
        const Vector3d point = T_depth_color * cameras.color.back_project(x, y, true_m);
        const Vector2d at = cameras.depth.project(point);
        const bool inside = at.x() >= 0 && at.y() >= 0 && at.x() <= cameras.depth.width_px - 1 &&
                            at.y() <= cameras.depth.height_px - 1;
        const bool both =
            inside &&
            std::abs(exact_depth_m(room, cameras.depth, T_world_depth, at.x(), at.y()) - point.z()) < 1e-3;
        const double error_m = registered_m(x, y) - true_m;
        const bool measured = registered_m(x, y) > 0;
        ++pixels;
        with_depth += measured ? 1 : 0;
        seen_by_both += both ? 1 : 0;
        missed += both && !measured ? 1 : 0;
        too_near += measured && error_m < -kWrongSurface_m ? 1 : 0;
        too_far += measured && error_m > kWrongSurface_m ? 1 : 0;
        if (measured) errors_m.push_back(std::abs(error_m));
      }
    }
  }

  [[nodiscard]] double error_quantile_m(double share) {
    const auto at =
        errors_m.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(errors_m.size() - 1));
    std::nth_element(errors_m.begin(), at, errors_m.end());
    return *at;
  }
};

}  // namespace fusebench::testing
