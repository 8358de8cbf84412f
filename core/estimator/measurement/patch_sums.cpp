#include "core/estimator/measurement/patch_sums.hpp"

#include <cmath>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/estimator/patches/measured_surfaces.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::measurement {

namespace {

/// As a share of the largest association distance: smaller changes keep an association.
constexpr float kSameShare = 0.1F;

/// Tests the angle between measured and model normals, cos >= min_cosine, without a division.
simd::Int8 within_angle(const simd::Points& direction, const simd::Points& unit, float min_cosine) {
  const simd::Float8 length = simd::norm(direction);
  return (length > 0.0F) & (simd::dot(direction, unit) >= min_cosine * length);
}

struct MeasuredNormals {
  simd::Points normal;  ///< any length, towards the camera
  simd::Int8 valid;
};

/// Central differences.
MeasuredNormals measured_normals(const patches::PosedLanes& camera, const DepthImage& depth_m, simd::Int8 x,
                                 simd::Int8 y, simd::Int8 wanted) {
  constexpr int kReach = patches::kNormalReach_px;
  const simd::Int8 inside =
      wanted & (x >= kReach) & (y >= kReach) & (x < depth_m.width - kReach) & (y < depth_m.height - kReach);
  const simd::Int8 at = inside ? y * depth_m.width + x : simd::all_lanes(kReach * depth_m.width + kReach);
  const float* const depths_m = depth_m.data.data();
  const simd::Float8 left_m = simd::gather(depths_m, at - kReach);
  const simd::Float8 right_m = simd::gather(depths_m, at + kReach);
  const simd::Float8 up_m = simd::gather(depths_m, at - kReach * depth_m.width);
  const simd::Float8 down_m = simd::gather(depths_m, at + kReach * depth_m.width);
  const simd::Float8 u = simd::to_float(x);
  const simd::Float8 v = simd::to_float(y);
  constexpr auto kStep = static_cast<float>(kReach);
  const simd::Points across =
      camera.back_project(u + kStep, v, right_m) - camera.back_project(u - kStep, v, left_m);
  const simd::Points down =
      camera.back_project(u, v + kStep, down_m) - camera.back_project(u, v - kStep, up_m);
  // y points down, so down x across points towards the camera.
  return {simd::cross(down, across),
          inside & (left_m > 0.0F) & (right_m > 0.0F) & (up_m > 0.0F) & (down_m > 0.0F)};
}

}  // namespace

filter::PoseQuadratic QuadraticSums::total() const {
  filter::PoseQuadratic sum;
  std::size_t entry = 0;
  for (int row = 0; row < filter::kPoseSize; ++row) {
    for (int column = row; column < filter::kPoseSize; ++column, ++entry) {
      sum.information(row, column) = simd::sum_of_lanes(information_[entry]);
      sum.information(column, row) = sum.information(row, column);
    }
    sum.gradient[row] = simd::sum_of_lanes(gradient_[static_cast<std::size_t>(row)]);
  }
  sum.cost = simd::sum_of_lanes(cost_);
  return sum;
}

Eigen::Matrix2d BrightnessSums::information() const {
  Eigen::Matrix2d sum;
  sum << simd::sum_of_lanes(information_[0]), simd::sum_of_lanes(information_[1]),
      simd::sum_of_lanes(information_[1]), simd::sum_of_lanes(information_[2]);
  return sum;
}

Vector2d BrightnessSums::gradient() const {
  return {simd::sum_of_lanes(gradient_[0]), simd::sum_of_lanes(gradient_[1])};
}

Eigen::Matrix<double, 2, filter::kPoseSize> BrightnessSums::by_pose() const {
  Eigen::Matrix<double, 2, filter::kPoseSize> sum;
  for (int i = 0; i < filter::kPoseSize; ++i) {
    sum(0, i) = simd::sum_of_lanes(by_pose_[0][static_cast<std::size_t>(i)]);
    sum(1, i) = simd::sum_of_lanes(by_pose_[1][static_cast<std::size_t>(i)]);
  }
  return sum;
}

AssociationGates::AssociationGates(const config::GeometricConfig& geometric, const config::DepthConfig& depth,
                                   double scale)
    : max_distance_m(static_cast<float>(geometric.max_distance_m)),
      min_normal_cosine(static_cast<float>(std::cos(radians(geometric.max_normal_angle_deg)))),
      min_incidence_cosine(static_cast<float>(std::cos(radians(depth.max_incidence_deg)))),
      model_noise_m(static_cast<float>(geometric.model_noise_m)),
      noise_scale(static_cast<float>(scale)),
      depth_sigma(depth) {}

PlanePairs associate(const patches::PosedLanes& camera, const patches::PixelLanes& pixels,
                     const DepthImage& depth_m, const AssociationGates& gates, const PlanePairs& before) {
  const simd::Points predicted = camera.to_camera(pixels.point);
  const simd::Int8 in_front = pixels.present & (predicted.z > 0.0F);
  const simd::Float8 inverse_z = 1.0F / (in_front ? predicted.z : simd::all_lanes(1.0F));
  const simd::Float8 landed_x =
      simd::multiply_add(camera.fx_px * predicted.x, inverse_z, simd::all_lanes(camera.cx_px + 0.5F));
  const simd::Float8 landed_y =
      simd::multiply_add(camera.fy_px * predicted.y, inverse_z, simd::all_lanes(camera.cy_px + 0.5F));
  const simd::Int8 inside = in_front & (landed_x >= 0.0F) & (landed_y >= 0.0F) &
                            (landed_x < static_cast<float>(depth_m.width)) &
                            (landed_y < static_cast<float>(depth_m.height));
  const simd::Int8 x = inside ? simd::to_int(landed_x) : simd::Int8{};
  const simd::Int8 y = inside ? simd::to_int(landed_y) : simd::Int8{};
  const simd::Int8 at = y * depth_m.width + x;
  const simd::Int8 landed = inside ? at + 1 : simd::Int8{};
  const simd::Int8 deeper = simd::abs(predicted.z - before.predicted_z_m) > kSameShare * gates.max_distance_m;
  if (!simd::any((landed != before.landed) | (inside & deeper))) return before;

  const simd::Float8 measured_m = simd::gather(depth_m.data.data(), at);
  const simd::Points measured = camera.back_project(simd::to_float(x), simd::to_float(y), measured_m);
  const simd::Int8 near =
      inside & (measured_m > 0.0F) & (simd::norm(measured - predicted) <= gates.max_distance_m);
  PlanePairs pairs;
  pairs.landed = landed;
  pairs.predicted_z_m = predicted.z;
  if (!simd::any(near)) return pairs;

  const simd::Points normal = simd::rotated(camera.R_camera_world, pixels.normal);
  const MeasuredNormals surface = measured_normals(camera, depth_m, x, y, near);
  const simd::Float8 range_m = simd::norm(measured);
  const simd::Float8 incidence_cosine =
      -simd::dot(measured, normal) / (near ? range_m : simd::all_lanes(1.0F));
  pairs.valid = surface.valid & within_angle(surface.normal, normal, gates.min_normal_cosine) &
                (incidence_cosine >= gates.min_incidence_cosine);
  pairs.point_imu = camera.to_imu(measured);
  // Depth noise is along the ray; the residual contains its component along the normal.
  const simd::Float8 along_normal_m = gates.depth_sigma.at_m(measured_m) * range_m /
                                      (near ? measured_m : simd::all_lanes(1.0F)) * incidence_cosine;
  pairs.sigma_m = gates.noise_scale *
                  simd::sqrt(simd::multiply_add(along_normal_m, along_normal_m,
                                                simd::all_lanes(gates.model_noise_m * gates.model_noise_m)));
  return pairs;
}

}  // namespace fusebench::measurement
