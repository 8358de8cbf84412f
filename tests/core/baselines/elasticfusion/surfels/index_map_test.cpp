#include "core/baselines/elasticfusion/surfels/index_map.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

namespace fusebench {

using namespace baselines::elasticfusion::surfels;

namespace {

constexpr int kScale = IndexMap::kScale;
// Its rows of 52 cells end amid a byte of eight.
const PinholeCamera kSmallCamera = {13, 9, 20, 20, 6, 4};

/// A surfel that is seen at the middle of a cell.
Surfel surfel_in_cell(int column, int row, double depth_m) {
  Surfel surfel;
  surfel.position =
      kSmallCamera.back_project((column + 0.5) / kScale - 0.5, (row + 0.5) / kScale - 0.5, depth_m)
          .cast<float>();
  surfel.normal = {0, 0, -1};
  surfel.radius_m = 0.01F;
  return surfel;
}

/// One surfel in every third cell, and in every sixth another behind it.
class ScatteredSurfels : public ::testing::Test {
 protected:
  ScatteredSurfels() {
    for (int row = 0; row < kScale * kSmallCamera.height_px; ++row) {
      for (int column = 0; column < kScale * kSmallCamera.width_px; ++column) {
        const int number = row * kScale * kSmallCamera.width_px + column + row;
        if (number % 3 != 0) continue;
        if (number % 6 == 0) surfels.add(surfel_in_cell(column, row, 3));
        in_cell[{row, column}] = surfels.size();
        surfels.add(surfel_in_cell(column, row, 2));
      }
    }
  }

  /// Reference: exhaustive search over all cells.
  [[nodiscard]] std::vector<std::size_t> expected(int column, int row) const {
    std::vector<std::size_t> numbers;
    for (int y = row - kScale; y < row + kScale; ++y) {
      for (int x = column - kScale; x < column + kScale; ++x) {
        if (const auto found = in_cell.find({y, x}); found != in_cell.end()) numbers.push_back(found->second);
      }
    }
    return numbers;
  }

  SurfelMap surfels;
  std::map<std::pair<int, int>, std::size_t> in_cell;  // row and column: index in the map
};

TEST_F(ScatteredSurfels, ALookMeetsTheNearestOfEachCellRowByRow) {
  IndexMap index;
  for (const int threads : {1, 2}) {
    index.build(surfels, kSmallCamera, {}, {0, 200, true, -1}, Workers{threads});
    for (int y = 0; y < kSmallCamera.height_px; ++y) {
      for (int x = 0; x < kSmallCamera.width_px; ++x) {
        std::vector<std::size_t> pixel, place;
        index.around_pixel(x, y, [&](std::size_t number) { pixel.push_back(index.surfels()[number].index); });
        index.around_place({x, y},
                           [&](std::size_t number) { place.push_back(index.surfels()[number].index); });
        EXPECT_EQ(pixel, expected(kScale * x + kScale / 2, kScale * y + kScale / 2)) << x << ", " << y;
        EXPECT_EQ(place, pixel) << x << ", " << y;
      }
    }
  }
}

TEST_F(ScatteredSurfels, DoNotDependOnAnEarlierMap) {
  IndexMap index;
  index.build(surfels, kSmallCamera, {}, {0, 200, true, -1}, Workers{1});
  index.build({}, kSmallCamera, {}, {0, 200, true, -1}, Workers{1});
  index.around_pixel(6, 4, [](std::size_t number) { ADD_FAILURE() << number; });
}

}  // namespace

}  // namespace fusebench
