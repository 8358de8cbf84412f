// The plain formulas that the kernels are held against, held against numeric derivatives and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "tests/support/measured_normal.hpp"
#include "tests/support/numeric_jacobian.hpp"
#include "tests/support/scalar_residuals.hpp"
#include "tests/support/scalar_sampling.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace patches;

namespace {

using testing::huber;
using testing::numeric_jacobian;
using testing::photometric_residual;
using testing::point_to_plane_residual;
using testing::project_with_jacobian;
using testing::Projection;
using testing::relative_difference;
using testing::sample_bicubic;

const SE3 kTImuCamera{so3_exp({0.02, -0.03, 1.5}), {0.09, 0.003, 0.002}};
const SE3 kTWorldImu{so3_exp({0.1, 0.2, -1.4}), {0.05, -0.1, 0.02}};

GreyImage smooth_image() {
  GreyImage image(320, 240);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image(x, y) = static_cast<std::uint8_t>(
          std::lround(128 + 60 * std::sin(0.21 * x + 0.05 * y) + 50 * std::cos(0.17 * y - 0.03 * x)));
    }
  }
  return image;
}

TEST(ScalarReferences, ProjectionJacobianEqualsNumericOne) {
  const PinholeCamera camera = camera_at_level(testing::small_camera(), 1);
  const Vector3d point_world(0.4, -0.3, 2.0);
  const PosedCamera posed(camera, kTWorldImu, kTImuCamera);
  const auto f = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    const PosedCamera p(camera, pose_plus(kTWorldImu, e), kTImuCamera);
    return p.camera.project(p.to_camera(point_world));
  };
  EXPECT_LT(relative_difference(project_with_jacobian(posed, posed.to_camera(point_world)).jacobian,
                                numeric_jacobian(f, 6)),
            1e-8);
}

TEST(ScalarReferences, PhotometricJacobianEqualsNumericOneAtAllLevels) {
  const std::vector<GreyImage> pyramid = build_pyramid(smooth_image(), 3);
  for (int level = 0; level < 3; ++level) {
    const PinholeCamera camera = camera_at_level(testing::small_camera(), level);
    const GreyImage& image = pyramid[static_cast<std::size_t>(level)];
    for (const Vector3d& point_world :
         {Vector3d(0.4, -0.3, 2.0), Vector3d(-0.5, 0.2, 1.4), Vector3d(0.1, 0.35, 2.5)}) {
      const auto residual = [&](const SE3& T_world_imu) {
        const PosedCamera p(camera, T_world_imu, kTImuCamera);
        const Projection projection = project_with_jacobian(p, p.to_camera(point_world));
        return photometric_residual(sample_bicubic(image, projection.pixel_px.x(), projection.pixel_px.y()),
                                    projection.jacobian, 120.0, 1.1, -3.0);
      };
      // The interpolant is smooth within a cell and its slope across: a step far below a pixel sees no more.
      const auto f = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(1, residual(pose_plus(kTWorldImu, e)).value_grey);
      };
      EXPECT_LT(relative_difference(residual(kTWorldImu).jacobian, numeric_jacobian(f, 6, 1e-7)), 1e-5)
          << "level " << level;
    }
  }
}

TEST(ScalarReferences, PlaneJacobianEqualsNumericOne) {
  const Vector3d point_imu(0.2, 0.5, 1.8);
  const Vector3d plane_point(0.3, 0.1, 2.0);
  const Vector3d normal = Vector3d(0.3, -0.5, -0.8).normalized();
  const auto residual = [&](const SE3& T_world_imu) {
    return point_to_plane_residual(PosedCamera(testing::small_camera(), T_world_imu, kTImuCamera), point_imu,
                                   plane_point, normal);
  };
  const auto f = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(1, residual(pose_plus(kTWorldImu, e)).value_m);
  };
  EXPECT_LT(relative_difference(residual(kTWorldImu).jacobian, numeric_jacobian(f, 6)), 1e-8);
}

TEST(ScalarReferences, BilinearSampleIsExactOnAPlaneAndAtTheBorder) {
  GreyImage image(8, 6);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) image(x, y) = static_cast<std::uint8_t>(10 + 5 * x + 7 * y);
  }
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {7.0, 5.0}, {3.25, 2.75}, {6.999, 0.001}}) {
    const IntensitySample sample = sample_bilinear(image, x, y);
    EXPECT_NEAR(sample.value, 10 + 5 * x + 7 * y, 1e-12);
    EXPECT_NEAR(sample.dx, 5, 1e-12);
    EXPECT_NEAR(sample.dy, 7, 1e-12);
  }
}

/// A wave that 8-bit pixels hold well, shifted.
GreyImage wave(double shift_px) {
  GreyImage image(40, 30);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image(x, y) = static_cast<std::uint8_t>(
          std::lround(127 + 80 * std::sin(0.8 * (x - shift_px)) * std::cos(0.6 * (y + shift_px))));
    }
  }
  return image;
}

TEST(ScalarReferences, BicubicSampleIsExactOnAParabolaAndSmooth) {
  GreyImage image(9, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 9; ++x) image(x, y) = static_cast<std::uint8_t>(3 * x * x + y * y - 2 * x * y + 20);
  }
  for (const auto& [x, y] : {std::pair{1.0, 1.0}, {7.0, 6.0}, {3.25, 2.75}, {6.999, 1.001}}) {
    const IntensitySample sample = sample_bicubic(image, x, y);
    EXPECT_NEAR(sample.value, 3 * x * x + y * y - 2 * x * y + 20, 1e-10);
    EXPECT_NEAR(sample.dx, 6 * x - 2 * y, 1e-10);
    EXPECT_NEAR(sample.dy, 2 * y - 2 * x, 1e-10);
  }
  const GreyImage rough = wave(0);
  for (const double x : {5.0, 5.37, 11.999999}) {  // whole pixels are no kinks
    const double numeric =
        (sample_bicubic(rough, x + 1e-6, 7.4).value - sample_bicubic(rough, x - 1e-6, 7.4).value) / 2e-6;
    EXPECT_NEAR(sample_bicubic(rough, x, 7.4).dx, numeric, 1e-3) << x;
  }
}

/// Shift with the best match of the shifted image and the reference, by Gauss-Newton.
template <typename Sampler>
double aligned_shift(const GreyImage& reference, const GreyImage& shifted, Sampler&& sample) {
  double shift = 0;
  for (int iteration = 0; iteration < 20; ++iteration) {
    double information = 0;
    double gradient = 0;
    for (int y = 8; y < 22; ++y) {
      for (int x = 8; x < 32; ++x) {
        const IntensitySample s = sample(shifted, x + shift, y - shift);
        const double slope = s.dx - s.dy;
        information += slope * slope;
        gradient += slope * (s.value - reference(x, y));
      }
    }
    shift -= gradient / information;
  }
  return shift;
}

TEST(ScalarReferences, BicubicSamplesAreDrawnLessTowardsWholePixels) {
  for (const double shift : {0.1, 0.2, 0.3, 0.4}) {
    const double linear = aligned_shift(wave(0), wave(shift), sample_bilinear<std::uint8_t>);
    const double cubic = aligned_shift(wave(0), wave(shift), sample_bicubic);
    EXPECT_LT(std::abs(cubic - shift), 0.5 * std::abs(linear - shift)) << linear << ' ' << cubic;
    EXPECT_LT(std::abs(cubic - shift), 0.02) << cubic;
  }
}

TEST(ScalarReferences, HuberIsSmoothAtItsKneeAndItsWeightIsTheDerivative) {
  const double k = 1.345;
  EXPECT_NEAR(huber(k - 1e-9, k).cost, huber(k + 1e-9, k).cost, 1e-8);
  for (const double r : {-5.0, -1.0, 0.3, 1.3, 2.0, 40.0}) {
    const double slope = (huber(r + 1e-6, k).cost - huber(r - 1e-6, k).cost) / 2e-6;
    EXPECT_NEAR(huber(r, k).weight * r, slope, 1e-6) << r;
  }
}

TEST(ScalarReferences, NormalOfASlantedPlaneFacesTheCamera) {
  const PinholeCamera camera = testing::small_camera();
  const Vector3d normal = Vector3d(0.4, -0.2, -1.0).normalized();
  DepthImage depth(320, 240);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      depth(x, y) = static_cast<float>(normal.z() * 2.0 / normal.dot(camera.back_project(x, y, 1.0)));
    }
  }
  EXPECT_LT((testing::measured_normal(depth, camera, 200, 90) - normal).norm(), 1e-4);
  EXPECT_EQ(testing::measured_normal(depth, camera, 2, 90).norm(), 0.0) << "no neighbours at the border";
  depth(204, 90) = 0;
  EXPECT_EQ(testing::measured_normal(depth, camera, 200, 90).norm(), 0.0) << "a missing neighbour";
}

}  // namespace
}  // namespace fusebench
