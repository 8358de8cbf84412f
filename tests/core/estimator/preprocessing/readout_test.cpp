// Displacements by a moving camera that reads row by row, on a grid, against each pixel by itself in double
// precision.
#include "core/estimator/preprocessing/readout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/geometry.hpp"
#include "core/estimator/preprocessing/node_grid.hpp"

namespace fusebench {

using namespace simd;
using namespace preprocessing;

namespace {

constexpr double kReadout_s = 0.026;
constexpr double kDelay_s = 0.012;
const PinholeCamera kCamera{640, 480, 520, 525, 318.3, 241.1};

double row_time_s(double row) { return kDelay_s + (row / (kCamera.height_px - 1) - 0.5) * kReadout_s; }

/// Projection of the point of a pixel at the read-out time of its row.
Vector2d to_row(const Vector2d& pixel, double depth_m, const CameraVelocity& velocity) {
  const Vector3d now = kCamera.back_project(pixel.x(), pixel.y(), depth_m);
  Vector2d then = pixel;
  for (int i = 0; i < 50; ++i) {
    const double time_s = row_time_s(then.y());
    then = kCamera.project(so3_exp(-time_s * velocity.angular_radps) *
                           Vector3d(now - time_s * velocity.linear_mps));
  }
  return then;
}

/// Position and depth of a pixel of the image at the instant of the frame.
Vector3d from_row(const Vector2d& pixel, double depth_m, const CameraVelocity& velocity) {
  const double time_s = row_time_s(pixel.y());
  const Vector3d carried =
      so3_exp(time_s * velocity.angular_radps) * kCamera.back_project(pixel.x(), pixel.y(), depth_m) +
      time_s * velocity.linear_mps;
  const Vector2d landed = kCamera.project(carried);
  return {landed.x(), landed.y(), carried.z()};
}

struct ReadMotion {
  const char* name;
  CameraVelocity velocity;
  double tolerance_px;
};

/// check(pixel, displacement, depth, number(i) of the grid) at pixels all over the image, of several depths.
template <class Grid, class Check>
void for_each_pixel(const Grid& grid, const Check& check) {
  for (int row = 0; row < kCamera.height_px; row += 7) {
    for (int column = 0; column + 8 <= kCamera.width_px; column += 8) {
      const auto cell = grid.cell(column, row / Grid::kRows);
      const auto rows = static_cast<float>(row % Grid::kRows);
      for (const float depth_m : {0.4F, 0.7F, 1.5F, 6.0F}) {
        const Displacement8 by = DisplacementParabola::at(all_lanes(1.0F / depth_m),
                                                          [&](std::size_t i) { return cell.at(i, rows); });
        for (std::size_t lane = 0; lane < kLanes; lane += 3) {
          const Vector2d pixel(column + static_cast<int>(lane), row);
          check(pixel, Vector2d(static_cast<double>(by.x[lane]), static_cast<double>(by.y[lane])), depth_m,
                [&](std::size_t i) { return static_cast<double>(cell.at(i, rows)[lane]); });
        }
      }
    }
  }
}

class ReadoutMotion : public ::testing::TestWithParam<ReadMotion> {
 protected:
  Readout readout{kCamera, RowTimes(kCamera.height_px, kDelay_s, kReadout_s), GetParam().velocity};
};

TEST_P(ReadoutMotion, LeadsToWhereThePointsWereWhenTheirRowsWereRead) {
  const NodeGrid<DisplacementParabola::kCount> grid(kCamera.width_px, kCamera.height_px,
                                                    [&](Float8 u, float v) { return readout.to_rows(u, v); });
  double worst_px = 0;
  for_each_pixel(grid, [&](const Vector2d& pixel, const Vector2d& by, float depth_m, const auto&) {
    const Vector2d expected = to_row(pixel, static_cast<double>(depth_m), GetParam().velocity);
    worst_px = std::max(worst_px, (pixel + by - expected).norm());
  });
  RecordProperty("worst_px", std::to_string(worst_px));
  EXPECT_LT(worst_px, GetParam().tolerance_px);
}

TEST_P(ReadoutMotion, FindsThePixelsThatMotionCarriesToAPlaceAndTheirDepthThere) {
  const NodeGrid<Readout::kFromRows> grid(kCamera.width_px, kCamera.height_px,
                                          [&](Float8 u, float v) { return readout.from_rows(u, v); });
  double worst_px = 0;
  double worst_share = 0;
  for_each_pixel(grid, [&](const Vector2d& pixel, const Vector2d& by, float depth_m, const auto& number) {
    const auto measured_m = static_cast<double>(depth_m);
    const Vector3d landed = from_row(pixel + by, measured_m, GetParam().velocity);
    worst_px = std::max(worst_px, (landed.head<2>() - pixel).norm());
    const double carried_m =
        measured_m * (number(Readout::kDepthFactor) + number(Readout::kDepthShift_m) / measured_m);
    worst_share = std::max(worst_share, std::abs(carried_m - landed.z()) / landed.z());
  });
  RecordProperty("worst_px", std::to_string(worst_px));
  RecordProperty("worst_share", std::to_string(worst_share));
  EXPECT_LT(worst_px, GetParam().tolerance_px);
  EXPECT_LT(worst_share, 0.002);
}

INSTANTIATE_TEST_SUITE_P(Motions, ReadoutMotion,
                         ::testing::Values(ReadMotion{"slow", {{0.3, -0.2, 0.1}, {0.1, 0.05, -0.1}}, 0.003},
                                           ReadMotion{
                                               "handheld", {{0.8, -1.0, 0.4}, {0.4, -0.2, 0.3}}, 0.015},
                                           ReadMotion{"fast", {{2.0, 2.0, -1.5}, {0.8, -0.6, 0.5}}, 0.2},
                                           ReadMotion{"pan", {{0, 5, 0}, {0, 0, 0}}, 0.05}),
                         [](const auto& test) { return test.param.name; });

TEST(Readout, OfACameraAtRestDisplacesNothingAtAll) {
  const Readout readout(kCamera, RowTimes(kCamera.height_px, kDelay_s, kReadout_s), {});
  for (const Float8& coefficient : readout.to_rows(8.0F * kLaneNumber, 100.0F)) {
    EXPECT_EQ(lane_bits(coefficient != 0.0F), 0U);
  }
}

TEST(Readout, OfATurnDoesNotDependOnDepth) {
  const Readout readout(kCamera, RowTimes(kCamera.height_px, kDelay_s, kReadout_s),
                        {{0.4, 2, -1}, {0, 0, 0}});
  const auto coefficients = readout.to_rows(8.0F * kLaneNumber, 100.0F);
  for (const std::size_t i : {1U, 2U, 4U, 5U}) EXPECT_EQ(lane_bits(coefficients[i] != 0.0F), 0U) << i;
}

/// Without the grid, whose interpolation hides it: a turn of 6 rad/s about the optical axis.
TEST(Readout, FollowsTheTurnBetweenRowsToTheSecondOrder) {
  const CameraVelocity velocity{{0, 0, 6}, {0, 0, 0}};
  const Readout readout(kCamera, RowTimes(kCamera.height_px, kDelay_s, kReadout_s), velocity);
  double worst_px = 0;
  for (const int row : {300, 400, 479}) {
    const auto coefficients = readout.to_rows(80.0F * kLaneNumber, static_cast<float>(row));
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Vector2d pixel(80.0 * static_cast<double>(lane), row);
      const Vector2d by(static_cast<double>(coefficients[0][lane]),
                        static_cast<double>(coefficients[3][lane]));
      worst_px = std::max(worst_px, (pixel + by - to_row(pixel, 1.0, velocity)).norm());
    }
  }
  EXPECT_LT(worst_px, 0.02);
}

TEST(NodeGrid, IsExactForWhatIsStraightAlsoInColumnsThatFitNoCell) {
  constexpr int kWidth_px = 322;
  constexpr int kHeight_px = 241;
  const NodeGrid<2> grid(kWidth_px, kHeight_px, [](Float8 u, float v) {
    return std::array<Float8, 2>{u + 2.0F * v, 0.25F * u - v};
  });
  for (int row = 0; row < kHeight_px; ++row) {
    const auto rows = static_cast<float>(row % NodeGrid<2>::kRows);
    for (const int column : {0, 8, 312, kWidth_px - 8}) {
      const auto cell = grid.cell(column, row / NodeGrid<2>::kRows);
      const Float8 u = static_cast<float>(column) + kLaneNumber;
      const auto v = static_cast<float>(row);
      EXPECT_EQ(lane_bits(cell.at(0, rows) != u + 2.0F * v), 0U) << column << ", " << row;
      EXPECT_EQ(lane_bits(cell.at(1, rows) != 0.25F * u - v), 0U) << column << ", " << row;
    }
  }
}

}  // namespace
}  // namespace fusebench
