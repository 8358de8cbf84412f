#include "core/patch_sums.hpp"

#include <cmath>

#include "core/depth_gates.hpp"

namespace fusebench {

namespace {

/// Of the largest distance between a point and its measurement: less makes no difference to an association.
constexpr float kSameShare = 0.1F;

/// Unit normals of the measured surface are compared with the model's without a division: cos >= min_cosine.
Int8 within_angle(const Points& direction, const Points& unit, float min_cosine) {
  const Float8 length = norm(direction);
  return (length > 0.0F) & (dot(direction, unit) >= min_cosine * length);
}

struct MeasuredNormals {
  Points normal;  ///< any length, towards the camera
  Int8 valid;
};

/// Central differences over +-4 pixels, since neighbouring pixels of structured-light depth share their
/// disparity step.
MeasuredNormals measured_normals(const PosedLanes& camera, const DepthImage& depth_m, Int8 x, Int8 y,
                                 Int8 wanted) {
  constexpr int kReach = 4;
  const Int8 inside =
      wanted & (x >= kReach) & (y >= kReach) & (x < depth_m.width - kReach) & (y < depth_m.height - kReach);
  const Int8 at = inside ? y * depth_m.width + x : all_lanes(kReach * depth_m.width + kReach);
  const float* const depths_m = depth_m.data.data();
  const Float8 left_m = gather(depths_m, at - kReach);
  const Float8 right_m = gather(depths_m, at + kReach);
  const Float8 up_m = gather(depths_m, at - kReach * depth_m.width);
  const Float8 down_m = gather(depths_m, at + kReach * depth_m.width);
  const Float8 u = to_float(x);
  const Float8 v = to_float(y);
  constexpr auto kStep = static_cast<float>(kReach);
  const Points across =
      camera.back_project(u + kStep, v, right_m) - camera.back_project(u - kStep, v, left_m);
  const Points down = camera.back_project(u, v + kStep, down_m) - camera.back_project(u, v - kStep, up_m);
  // y points down, so down x across looks back at the camera.
  return {cross(down, across), inside & (left_m > 0.0F) & (right_m > 0.0F) & (up_m > 0.0F) & (down_m > 0.0F)};
}

}  // namespace

PoseQuadratic QuadraticSums::total() const {
  PoseQuadratic sum;
  std::size_t entry = 0;
  for (int row = 0; row < kPoseSize; ++row) {
    for (int column = row; column < kPoseSize; ++column, ++entry) {
      sum.information(row, column) = sum_of_lanes(information_[entry]);
      sum.information(column, row) = sum.information(row, column);
    }
    sum.gradient[row] = sum_of_lanes(gradient_[static_cast<std::size_t>(row)]);
  }
  sum.cost = sum_of_lanes(cost_);
  return sum;
}

Eigen::Matrix2d BrightnessSums::information() const {
  Eigen::Matrix2d sum;
  sum << sum_of_lanes(information_[0]), sum_of_lanes(information_[1]), sum_of_lanes(information_[1]),
      sum_of_lanes(information_[2]);
  return sum;
}

Vector2d BrightnessSums::gradient() const { return {sum_of_lanes(gradient_[0]), sum_of_lanes(gradient_[1])}; }

Eigen::Matrix<double, 2, kPoseSize> BrightnessSums::by_pose() const {
  Eigen::Matrix<double, 2, kPoseSize> sum;
  for (int i = 0; i < kPoseSize; ++i) {
    sum(0, i) = sum_of_lanes(by_pose_[0][static_cast<std::size_t>(i)]);
    sum(1, i) = sum_of_lanes(by_pose_[1][static_cast<std::size_t>(i)]);
  }
  return sum;
}

AssociationGates::AssociationGates(const GeometricConfig& geometric, const DepthConfig& depth_in,
                                   double scale)
    : max_distance_m(static_cast<float>(geometric.max_distance_m)),
      min_normal_cosine(static_cast<float>(std::cos(radians(geometric.max_normal_angle_deg)))),
      min_incidence_cosine(static_cast<float>(std::cos(radians(depth_in.max_incidence_deg)))),
      model_noise_m(static_cast<float>(geometric.model_noise_m)),
      noise_scale(static_cast<float>(scale)),
      depth(depth_in) {}

PlanePairs associate(const PosedLanes& camera, const PixelLanes& pixels, const DepthImage& depth_m,
                     const AssociationGates& gates, const PlanePairs& before) {
  const Points predicted = camera.to_camera(pixels.point);
  const Int8 in_front = pixels.present & (predicted.z > 0.0F);
  const Float8 inverse_z = 1.0F / (in_front ? predicted.z : all_lanes(1.0F));
  const Float8 landed_x = multiply_add(camera.fx_px * predicted.x, inverse_z, all_lanes(camera.cx_px + 0.5F));
  const Float8 landed_y = multiply_add(camera.fy_px * predicted.y, inverse_z, all_lanes(camera.cy_px + 0.5F));
  const Int8 inside = in_front & (landed_x >= 0.0F) & (landed_y >= 0.0F) &
                      (landed_x < static_cast<float>(depth_m.width)) &
                      (landed_y < static_cast<float>(depth_m.height));
  const Int8 x = inside ? to_int(landed_x) : Int8{};
  const Int8 y = inside ? to_int(landed_y) : Int8{};
  const Int8 at = y * depth_m.width + x;
  const Int8 landed = inside ? at + 1 : Int8{};
  const Int8 deeper = abs(predicted.z - before.predicted_z_m) > kSameShare * gates.max_distance_m;
  if (!any((landed != before.landed) | (inside & deeper))) return before;

  const Float8 measured_m = gather(depth_m.data.data(), at);
  const Points measured = camera.back_project(to_float(x), to_float(y), measured_m);
  const Int8 near = inside & (measured_m > 0.0F) & (norm(measured - predicted) <= gates.max_distance_m);
  PlanePairs pairs;
  pairs.landed = landed;
  pairs.predicted_z_m = predicted.z;
  if (!any(near)) return pairs;

  const Points normal = rotated(camera.R_camera_world, pixels.normal);
  const MeasuredNormals surface = measured_normals(camera, depth_m, x, y, near);
  const Float8 range_m = norm(measured);
  const Float8 incidence_cosine = -dot(measured, normal) / (near ? range_m : all_lanes(1.0F));
  pairs.valid = surface.valid & within_angle(surface.normal, normal, gates.min_normal_cosine) &
                (incidence_cosine >= gates.min_incidence_cosine);
  pairs.point_imu = camera.to_imu(measured);
  // Depth noise acts along the ray; the plane sees its share along the normal.
  const Float8 along_normal_m = depth_sigma_m(measured_m, gates.depth) * range_m /
                                (near ? measured_m : all_lanes(1.0F)) * incidence_cosine;
  pairs.sigma_m =
      gates.noise_scale * sqrt(multiply_add(along_normal_m, along_normal_m,
                                            all_lanes(gates.model_noise_m * gates.model_noise_m)));
  return pairs;
}

}  // namespace fusebench
