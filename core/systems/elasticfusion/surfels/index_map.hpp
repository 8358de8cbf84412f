// Which surfel lies where in an image, at four times its size: what measurements are compared with.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/systems/elasticfusion/surfels/surfel_map.hpp"
#include "core/systems/elasticfusion/surfels/visible_surfels.hpp"

namespace fusebench::systems::elasticfusion::surfels {

class IndexMap {
 public:
  static constexpr int kScale = 4;

  /// Puts the middle of each surfel of the choice into its cell, the nearest one of several.
  void build(const SurfelMap& map, const PinholeCamera& camera, const SE3& T_world_camera,
             const SurfelChoice& choice, const Workers& workers);

  /// What lies in the image, in the camera's frame.
  [[nodiscard]] std::span<const CameraSurfel> surfels() const { return visible_.all(); }

  /// Calls look(number) for the number in surfels() of each surfel within a pixel's width of the middle of
  /// the pixel, row by row.
  template <class Look>
  void around_pixel(int x_px, int y_px, const Look& look) const {
    around(kScale * x_px + kScale / 2, kScale * y_px + kScale / 2, look);
  }

  /// The same around the place where a surfel is seen (pixels).
  template <class Look>
  void around_place(const Vector2d& at_px, const Look& look) const {
    around(cell_of(at_px.x()), cell_of(at_px.y()), look);
  }

 private:
  [[nodiscard]] static int cell_of(double at_px) { return static_cast<int>((at_px + 0.5) * kScale); }

  /// The eight cells either way of a corner of cells.
  template <class Look>
  void around(int column, int row, const Look& look) const {
    const int left = std::max(0, column - kScale), right = std::min(cells_.width, column + kScale);
    if (left >= right) return;
    for (int y = std::max(0, row - kScale); y < std::min(cells_.height, row + kScale); ++y) {
      for (unsigned taken = taken_cells(left, right, y); taken != 0; taken &= taken - 1)
        look(static_cast<std::size_t>(cells_(left + std::countr_zero(taken), y)));
    }
  }

  /// Bit i is set where cell left + i holds a surfel. A look around goes by these bits, since a branch on
  /// each cell cannot be predicted and cost a fifth of the time of fusion.
  [[nodiscard]] unsigned taken_cells(int left, int right, int row) const {
    const std::size_t first = taken_byte(left, row);
    const unsigned bytes = taken_[first] | static_cast<unsigned>(taken_[first + 1]) << 8U;
    return bytes >> static_cast<unsigned>(left % 8) & ((1U << static_cast<unsigned>(right - left)) - 1U);
  }

  [[nodiscard]] std::size_t taken_byte(int column, int row) const {
    return static_cast<std::size_t>(row) * bytes_of_row_ + static_cast<std::size_t>(column / 8);
  }

  VisibleSurfels visible_;
  Image<std::int32_t> cells_;  ///< what is in a cell that is not taken is of an earlier map
  std::size_t bytes_of_row_ = 0;
  std::vector<std::uint8_t> taken_;  ///< a bit for each cell; a row begins at a byte, and a byte ends it all
};

}  // namespace fusebench::systems::elasticfusion::surfels
