// The sums over eight pixels at a time against plain double precision, one pixel at a time (tests/support).
#include "core/estimator/measurement/patch_sums.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/residuals_config.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/base/simd/image_lanes.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"
#include "tests/support/measured_normal.hpp"
#include "tests/support/scalar_residuals.hpp"
#include "tests/support/scalar_sampling.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace filter;
using namespace preprocessing;
using namespace patches;
using namespace measurement;

namespace {

const SE3 kTImuCamera{so3_exp({0.1, -0.2, 0.3}), {0.02, -0.01, 0.05}};
const SE3 kTWorldImu{so3_exp({-0.2, 0.1, 0.05}), {0.4, -0.3, 0.2}};
const Vector3d kOrigin(0.3, 0.2, 1.0);

PosedCamera posed() { return PosedCamera(testing::small_camera(), kTWorldImu, kTImuCamera); }

Vector3d lane_of(const Points& points, std::size_t lane) {
  return {points.x[lane], points.y[lane], points.z[lane]};
}

/// Points before the camera, relative to the origin, with normals that face it.
PixelLanes random_pixels(std::mt19937& random) {
  std::uniform_real_distribution<float> u(20, 300), v(20, 220), depth_m(0.6F, 3.0F), turn(-0.3F, 0.3F);
  PixelLanes pixels;
  const PosedCamera camera = posed();
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Vector3d in_camera = camera.camera.back_project(u(random), v(random), depth_m(random));
    const Vector3d point =
        camera.R_camera_world.transpose() * (in_camera - camera.t_camera_world_m) - kOrigin;
    const Vector3d normal = camera.R_camera_world.transpose() *
                            (so3_exp({turn(random), turn(random), 0}) * -in_camera.normalized());
    for (const auto& [target, value] : {std::pair{&pixels.point, point}, std::pair{&pixels.normal, normal}}) {
      target->x[lane] = static_cast<float>(value.x());
      target->y[lane] = static_cast<float>(value.y());
      target->z[lane] = static_cast<float>(value.z());
    }
    pixels.intensity[lane] = turn(random) * 100.0F + 100.0F;
    pixels.present[lane] = -1;
    pixels.depth_confirmed[lane] = -1;
  }
  return pixels;
}

TEST(PatchSums, PhotometricJacobianIsThePlainOne) {
  std::mt19937 random(3);
  const PosedCamera plain = posed();
  const PosedLanes lanes(plain, kOrigin);
  for (int i = 0; i < 50; ++i) {
    const PixelLanes pixels = random_pixels(random);
    const Points in_camera = lanes.to_camera(pixels.point);
    const Float8 dx = kLaneNumber - 3.0F;
    const Float8 dy = 2.0F - kLaneNumber;
    const JacobianLanes jacobian = photometric_jacobian(lanes, in_camera, dx, dy);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Vector3d point_camera = plain.to_camera(lane_of(pixels.point, lane) + kOrigin);
      EXPECT_LT((lane_of(in_camera, lane) - point_camera).norm(), 2e-6);
      const testing::PhotometricResidual expected = testing::photometric_residual(
          {0, dx[lane], dy[lane]}, testing::project_with_jacobian(plain, point_camera).jacobian, 0, 1, 0);
      for (int k = 0; k < kPoseSize; ++k) {
        EXPECT_NEAR(jacobian[static_cast<std::size_t>(k)][lane], expected.jacobian[k],
                    1e-5 * expected.jacobian.norm());
      }
    }
  }
}

TEST(PatchSums, PlaneResidualAndJacobianAreThePlainOnes) {
  std::mt19937 random(4);
  const PosedCamera plain = posed();
  const PosedLanes lanes(plain, kOrigin);
  for (int i = 0; i < 50; ++i) {
    const PixelLanes planes = random_pixels(random);
    PlanePairs pairs;
    pairs.point_imu = lanes.to_imu(lanes.to_camera(planes.point));
    pairs.point_imu.x += 0.01F * kLaneNumber;
    const Float8 residual = plane_residual(lanes, pairs, planes);
    const JacobianLanes jacobian = plane_jacobian(lanes, pairs, planes);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const testing::PlaneResidual expected = testing::point_to_plane_residual(
          plain, lane_of(pairs.point_imu, lane), lane_of(planes.point, lane) + kOrigin,
          lane_of(planes.normal, lane));
      EXPECT_NEAR(residual[lane], expected.value_m, 3e-6);
      for (int k = 0; k < kPoseSize; ++k) {
        EXPECT_NEAR(jacobian[static_cast<std::size_t>(k)][lane], expected.jacobian[k], 2e-6);
      }
    }
  }
}

TEST(PatchSums, SumsAreThoseOfTheNormalEquations) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-2, 2);
  QuadraticSums sums;
  BrightnessSums light;
  PoseQuadratic expected;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Vector2d gradient = Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> by_pose = Eigen::Matrix<double, 2, 6>::Zero();
  for (int i = 0; i < 20; ++i) {
    JacobianLanes jacobian;
    Float8 residual{}, weight{}, cost{}, intensity{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      testing::RowVector6d row;
      for (std::size_t k = 0; k < 6; ++k)
        row[static_cast<Eigen::Index>(k)] = jacobian[k][lane] = number(random);
      residual[lane] = number(random);
      weight[lane] = lane == 3 ? 0.0F : std::abs(number(random));
      cost[lane] = number(random);
      intensity[lane] = number(random);
      const double w = weight[lane];
      const Vector2d by_light(-intensity[lane], -1.0);
      expected.information += w * row.transpose() * row;
      expected.gradient += w * residual[lane] * row.transpose();
      expected.cost += cost[lane];
      information += w * by_light * by_light.transpose();
      gradient += w * residual[lane] * by_light;
      by_pose += w * by_light * row;
    }
    sums.add(jacobian, residual, weight, cost);
    light.add(jacobian, residual, weight, intensity);
  }
  const PoseQuadratic total = sums.total();
  EXPECT_LT((total.information - expected.information).norm(), 1e-5 * expected.information.norm());
  EXPECT_LT((total.gradient - expected.gradient).norm(), 1e-4);
  EXPECT_NEAR(total.cost, expected.cost, 1e-4);
  EXPECT_LT((light.information() - information).norm(), 1e-4);
  EXPECT_LT((light.gradient() - gradient).norm(), 1e-4);
  EXPECT_LT((light.by_pose() - by_pose).norm(), 1e-4);
}

TEST(PatchSums, KernelAndSamplesAreThePlainOnes) {
  const testing::TexturedRoom room;
  const GreyImage image = room.render(testing::small_camera(), SE3{}, 0).grey;
  std::mt19937 random(6);
  std::uniform_real_distribution<float> x(1, 318), y(1, 238), value(-5, 5);
  for (int i = 0; i < 200; ++i) {
    Float8 u{}, v{}, whitened{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      u[lane] = lane == 7 ? 318.0F : x(random);  // the last place where there is room
      v[lane] = lane == 7 ? 238.0F : y(random);
      whitened[lane] = value(random);
    }
    const IntensityLanes cubic = sample_bicubic(image, u, v);
    const Float8 alone = sample_bicubic_value(image, u, v);
    const Float8 linear = sample_bilinear_value(image, u, v);
    const RobustLanes robust = huber(whitened, 1.345F);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const IntensitySample expected = testing::sample_bicubic(image, u[lane], v[lane]);
      EXPECT_NEAR(cubic.value[lane], expected.value, 1e-3);
      EXPECT_NEAR(cubic.dx[lane], expected.dx, 1e-3);
      EXPECT_NEAR(cubic.dy[lane], expected.dy, 1e-3);
      EXPECT_EQ(alone[lane], cubic.value[lane]);
      EXPECT_NEAR(linear[lane], sample_bilinear(image, u[lane], v[lane]).value, 1e-3);
      EXPECT_NEAR(robust.cost[lane], testing::huber(whitened[lane], 1.345).cost, 1e-5);
      EXPECT_NEAR(robust.weight[lane], testing::huber(whitened[lane], 1.345).weight, 1e-6);
    }
  }
}

TEST(PatchSums, PointsAreAssociatedWithWhatWasMeasuredWhereTheyLand) {
  // A wall that the camera sees at 1.5 m straight ahead, measured 1 cm nearer.
  const PinholeCamera camera = testing::small_camera();
  const PosedLanes lanes(PosedCamera(camera, SE3{}, SE3{}), Vector3d::Zero());
  DepthImage depth_m(camera.width_px, camera.height_px, 1.49F);
  depth_m(60, 50) = 0.0F;  // a hole
  depth_m(80, 50) = 2.0F;  // too far from the wall
  PixelLanes pixels;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const double u = 40.0 + 20.0 * static_cast<double>(lane);
    const Vector3d point = camera.back_project(lane == 7 ? 318 : u, 50, 1.5);
    pixels.point.x[lane] = static_cast<float>(point.x());
    pixels.point.y[lane] = static_cast<float>(point.y());
    pixels.point.z[lane] = static_cast<float>(point.z());
    pixels.normal.x[lane] = lane == 4 ? 0.6F : 0.0F;  // turned by 37 degrees
    pixels.normal.z[lane] = lane == 4 ? -0.8F : -1.0F;
    pixels.present[lane] = lane == 5 ? 0 : -1;
  }
  const GeometricConfig geometric;
  const DepthConfig depth;
  const PlanePairs pairs = associate(lanes, pixels, depth_m, AssociationGates(geometric, depth, 2.0));
  // The hole, the far measurement, the turned normal, the missing pixel, the border without neighbours.
  const std::array<bool, kLanes> expected = {true, false, false, true, false, false, true, false};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(pairs.valid[lane] != 0, expected[lane]) << lane;
    if (!expected[lane]) continue;
    const Vector3d measured = camera.back_project(40.0 + 20.0 * static_cast<double>(lane), 50, 1.49);
    EXPECT_LT((lane_of(pairs.point_imu, lane) - measured).norm(), 1e-6);
    EXPECT_NEAR(plane_residual(lanes, pairs, pixels)[lane], 0.01, 1e-6);
    // Along the ray, and as the wall's normal sees it: the depth's own noise.
    const double sigma_m = 2.0 * std::hypot(depth_sigma_m(1.49, depth), geometric.model_noise_m);
    EXPECT_NEAR(pairs.sigma_m[lane], sigma_m, 1e-5);
  }
}

TEST(PatchSums, AssociatesByTheAngleToTheMeasuredNormal) {
  // Waves, so that the normal changes from pixel to pixel.
  const PinholeCamera camera = testing::small_camera();
  DepthImage depth_m(camera.width_px, camera.height_px);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      depth_m(x, y) =
          1.5F + 0.06F * std::sin(0.11F * static_cast<float>(x)) * std::cos(0.07F * static_cast<float>(y));
    }
  }
  const PosedLanes lanes(PosedCamera(camera, SE3{}, SE3{}), Vector3d::Zero());
  const GeometricConfig geometric;
  const DepthConfig depth;
  const AssociationGates gates(geometric, depth, 1.0);
  const double most_deg = geometric.max_normal_angle_deg;
  std::mt19937 random(7);
  std::uniform_int_distribution<int> x(0, camera.width_px - 1), y(0, camera.height_px - 1);
  std::uniform_real_distribution<double> turn_deg(0.0, 2.0 * most_deg), number(-1, 1);
  int valid = 0;
  int turned = 0;
  int at_border = 0;
  for (int i = 0; i < 400; ++i) {
    PixelLanes pixels;
    std::array<Vector3d, kLanes> measured;  // normals
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const int u = x(random);
      const int v = y(random);
      const Vector3d point = camera.back_project(u, v, static_cast<double>(depth_m(u, v)));
      measured[lane] = testing::measured_normal(depth_m, camera, u, v);
      const Vector3d facing = measured[lane].isZero() ? Vector3d(-Vector3d::UnitZ()) : measured[lane];
      const Vector3d axis = facing.cross(Vector3d(number(random), number(random), 0.1)).normalized();
      const Vector3d normal = so3_exp(radians(turn_deg(random)) * axis) * facing;
      for (const auto& [target, value] :
           {std::pair{&pixels.point, point}, std::pair{&pixels.normal, normal}}) {
        target->x[lane] = static_cast<float>(value.x());
        target->y[lane] = static_cast<float>(value.y());
        target->z[lane] = static_cast<float>(value.z());
      }
      pixels.present[lane] = -1;
    }
    const PlanePairs pairs = associate(lanes, pixels, depth_m, gates);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (measured[lane].isZero()) {
        EXPECT_EQ(pairs.valid[lane], 0);
        ++at_border;
        continue;
      }
      const Vector3d normal = lane_of(pixels.normal, lane);
      const double incidence = -normal.dot(lane_of(pixels.point, lane).normalized());
      const double normal_deg = degrees(std::acos(std::clamp(normal.dot(measured[lane]), -1.0, 1.0)));
      const double incidence_deg = degrees(std::acos(incidence));
      if (std::abs(normal_deg - most_deg) < 0.05 || incidence_deg > depth.max_incidence_deg - 0.05) continue;
      ASSERT_EQ(pairs.valid[lane] != 0, normal_deg < most_deg) << normal_deg;
      (normal_deg < most_deg ? valid : turned) += 1;
    }
  }
  EXPECT_GT(valid, 500);
  EXPECT_GT(turned, 500);
  EXPECT_GT(at_border, 50);
}

TEST(PatchSums, AssociationsStayWhileAllPointsLandOnTheSamePixelsAsDeep) {
  const PinholeCamera camera = testing::small_camera();
  const auto seen_from = [&](double x_m, double z_m) {
    return PosedLanes(PosedCamera(camera, SE3{Quaterniond::Identity(), {x_m, 0, z_m}}, SE3{}),
                      Vector3d::Zero());
  };
  PixelLanes pixels;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    // Around the optical axis, so that a move along it leaves them where they are.
    const double u_px = std::round(camera.cx_px) - 4 + static_cast<double>(lane);
    const Vector3d point = camera.back_project(u_px, std::round(camera.cy_px), 1.5);
    pixels.point.x[lane] = static_cast<float>(point.x());
    pixels.point.y[lane] = static_cast<float>(point.y());
    pixels.point.z[lane] = static_cast<float>(point.z());
    pixels.normal.z[lane] = -1.0F;
    pixels.present[lane] = -1;
  }
  const GeometricConfig geometric;
  const AssociationGates gates(geometric, {}, 1.0);
  const DepthImage wall_m(camera.width_px, camera.height_px, 1.49F);
  // Another image shows whether anything is read again.
  const DepthImage other_wall_m(camera.width_px, camera.height_px, 1.47F);
  const PlanePairs first = associate(seen_from(0, 0), pixels, wall_m, gates);
  ASSERT_EQ(lane_bits(first.valid), 0xFFU);
  const auto depth_from = [&](double x_m, double z_m) {
    const PlanePairs pairs = associate(seen_from(x_m, z_m), pixels, other_wall_m, gates, first);
    const bool same = lane_bits(pairs.point_imu.z != all_lanes(pairs.point_imu.z[0])) == 0U;
    return same ? pairs.point_imu.z[0] : -1.0F;
  };
  const double pixel_m = 1.5 / camera.fx_px;
  EXPECT_EQ(depth_from(0.1 * pixel_m, 0), 1.49F);
  EXPECT_EQ(depth_from(0.9 * pixel_m, 0), 1.47F);
  EXPECT_EQ(depth_from(0, 0.05 * geometric.max_distance_m), 1.49F);
  EXPECT_EQ(depth_from(0, 0.2 * geometric.max_distance_m), 1.47F);
  // One point that lands elsewhere is enough.
  pixels.point.x[3] += static_cast<float>(pixel_m);
  EXPECT_EQ(depth_from(0, 0), 1.47F);
}

}  // namespace
}  // namespace fusebench
