// Index image of surfels at four times the image size, for the association of measurements.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"
#include "core/baselines/elasticfusion/surfels/visible_surfels.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

class IndexMap {
 public:
  static constexpr int kScale = 4;

  /// Writes the centre of each selected surfel into its cell; the nearest one wins.
  void build(const SurfelMap& map, const PinholeCamera& camera, const SE3& T_world_camera,
             const SurfelChoice& choice, const Workers& workers);

  /// The surfels inside the image, in the camera frame.
  [[nodiscard]] std::span<const CameraSurfel> surfels() const { return visible_.all(); }

  /// Calls look(number) for each surfel within a pixel's width of the centre of the pixel, row by row;
  /// number: index in surfels().
  template <class Look>
  void around_pixel(int x_px, int y_px, const Look& look) const {
    around(kScale * x_px + kScale / 2, kScale * y_px + kScale / 2, look);
  }

  /// Variant around an image position (pixels).
  template <class Look>
  void around_place(const Vector2d& at_px, const Look& look) const {
    around(cell_of(at_px.x()), cell_of(at_px.y()), look);
  }

 private:
  [[nodiscard]] static int cell_of(double at_px) { return static_cast<int>((at_px + 0.5) * kScale); }

  /// Visits eight cells in each direction around a corner of cells.
  template <class Look>
  void around(int column, int row, const Look& look) const {
    const int left = std::max(0, column - kScale), right = std::min(cells_.width, column + kScale);
    if (left >= right) return;
    for (int y = std::max(0, row - kScale); y < std::min(cells_.height, row + kScale); ++y) {
      for (unsigned taken = taken_cells(left, right, y); taken != 0; taken &= taken - 1)
        look(static_cast<std::size_t>(cells_(left + std::countr_zero(taken), y)));
    }
  }

  /// Bit i is set if cell left + i has a surfel. A branch for each cell cannot be predicted and took a fifth
  /// of the fusion time.
  [[nodiscard]] unsigned taken_cells(int left, int right, int row) const {
    const std::size_t first = taken_byte(left, row);
    const unsigned bytes = taken_[first] | static_cast<unsigned>(taken_[first + 1]) << 8U;
    return bytes >> static_cast<unsigned>(left % 8) & ((1U << static_cast<unsigned>(right - left)) - 1U);
  }

  [[nodiscard]] std::size_t taken_byte(int column, int row) const {
    return static_cast<std::size_t>(row) * bytes_of_row_ + static_cast<std::size_t>(column / 8);
  }

  VisibleSurfels visible_;
  Image<std::int32_t> cells_;  ///< cells that are not taken hold entries of earlier maps
  std::size_t bytes_of_row_ = 0;
  /// one bit for each cell, each row padded to bytes, with a byte of padding at the end
  std::vector<std::uint8_t> taken_;
};

}  // namespace fusebench::baselines::elasticfusion::surfels
