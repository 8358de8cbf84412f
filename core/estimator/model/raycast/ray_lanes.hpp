// Eight camera rays through a field: definition and intersections.
#pragma once

#include "core/estimator/model/raycast/surface_point.hpp"
#include "core/estimator/model/tsdf/trilinear.hpp"

namespace fusebench::raycast {

/// Eight rays by z-depth: point(z) = origin + z * direction, in voxels.
struct RayLanes {
  [[nodiscard]] simd::Points at(simd::Float8 z_m) const {
    return {simd::multiply_add(z_m, direction.x, simd::all_lanes(origin.x())),
            simd::multiply_add(z_m, direction.y, simd::all_lanes(origin.y())),
            simd::multiply_add(z_m, direction.z, simd::all_lanes(origin.z()))};
  }

  Eigen::Vector3f origin;
  simd::Points direction;    ///< per metre of z-depth
  simd::Float8 z_per_voxel;  ///< z-depth in metres of one voxel along the ray
};

/// The rays of the pixels of a camera in voxel coordinates.
class PixelRays {
 public:
  PixelRays(const PinholeCamera& camera, const SE3& T_world_camera, double voxel_m)
      : axes_((T_world_camera.rotation_matrix() / voxel_m).cast<float>()),
        per_fx_(static_cast<float>(1.0 / camera.fx_px)),
        per_fy_(static_cast<float>(1.0 / camera.fy_px)),
        cx_px_(static_cast<float>(camera.cx_px)),
        cy_px_(static_cast<float>(camera.cy_px)) {}

  /// `origin`: position of the camera in voxels.
  [[nodiscard]] RayLanes through(simd::Float8 u_px, simd::Float8 v_px, const Eigen::Vector3f& origin) const {
    const simd::Float8 x = (u_px - cx_px_) * per_fx_;
    const simd::Float8 y = (v_px - cy_px_) * per_fy_;
    RayLanes rays;
    rays.origin = origin;
    const auto row = [&](int i) {
      return simd::multiply_add(axes_(i, 0), x,
                                simd::multiply_add(axes_(i, 1), y, simd::all_lanes(axes_(i, 2))));
    };
    rays.direction = {row(0), row(1), row(2)};
    rays.z_per_voxel = 1.0F / simd::norm(rays.direction);
    return rays;
  }

 private:
  Eigen::Matrix3f axes_;  // columns: derivative of the ray by u and v (plane z = 1), and the optical axis
  float per_fx_, per_fy_, cx_px_, cy_px_;
};

/// Near the surface, a step goes this far beyond the predicted zero: two samples on both sides of a crossing
/// locate it better than many samples before it.
inline constexpr float kBeyond_voxels = 0.75F;

/// Two points of each ray with the surface between them: the field is + at the front point and - at the back
/// point. NaN until set.
struct Brackets {
  /// Stores samples of the field in the lanes `front` and `back`.
  void take(simd::Int8 front, simd::Int8 back, simd::Float8 z_m, simd::Float8 distance_m) {
    front_z_m = front ? z_m : front_z_m;
    front_m = front ? distance_m : front_m;
    back_z_m = back ? z_m : back_z_m;
    back_m = back ? distance_m : back_m;
  }
  [[nodiscard]] simd::Float8 zero_of_chord() const {
    return simd::multiply_add(front_m / (front_m - back_m), back_z_m - front_z_m, front_z_m);
  }
  [[nodiscard]] simd::Float8 middle() const { return 0.5F * (front_z_m + back_z_m); }
  /// True if the crossing is located within tolerance.
  [[nodiscard]] simd::Int8 are_narrow(simd::Float8 z_per_voxel) const {
    constexpr float kNarrow_voxels = 0.05F;
    return back_z_m - front_z_m <= kNarrow_voxels * z_per_voxel;
  }

  simd::Float8 front_z_m = tsdf::not_a_number();
  simd::Float8 front_m{};  ///< field values
  simd::Float8 back_z_m = tsdf::not_a_number();
  simd::Float8 back_m{};
};

/// True if the field is zero within tolerance.
[[nodiscard]] inline simd::Int8 is_zero(simd::Float8 distance_m, float voxel_m) {
  constexpr float kZero_voxels = 0.02F;
  return simd::abs(distance_m) < kZero_voxels * voxel_m;
}

/// Intersections of eight rays with the surface.
struct Hits {
  simd::Int8 valid{};
  simd::Float8 depth_m{};
  simd::Points normal_world{};
};

/// Crossings at these depths, with the gradient of the field as the normal. Valid ones enter the surface; a
/// gradient along the ray is noise at the border of the observed surface.
[[nodiscard]] inline Hits hits_at(simd::Int8 found, simd::Float8 depth_m, const simd::Points& gradient,
                                  const simd::Points& direction) {
  Hits hits;
  hits.depth_m = depth_m;
  const simd::Float8 length = simd::norm(gradient);
  hits.valid = found & (simd::dot(gradient, direction) < 0.0F) & (length > 0.0F);
  const simd::Float8 unit = 1.0F / (hits.valid ? length : simd::all_lanes(1.0F));
  hits.normal_world = {gradient.x * unit, gradient.y * unit, gradient.z * unit};
  return hits;
}

[[nodiscard]] inline SurfacePoint surface_point(const Hits& hits, std::size_t lane) {
  if (hits.valid[lane] == 0) return {};
  return {true,
          hits.depth_m[lane],
          {hits.normal_world.x[lane], hits.normal_world.y[lane], hits.normal_world.z[lane]}};
}

}  // namespace fusebench::raycast
