#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <tuple>

#include "core/base/error.hpp"
#include "core/base/simd/image_lanes.hpp"
#include "core/estimator/preprocessing/node_grid.hpp"
#include "core/estimator/preprocessing/readout.hpp"

namespace fusebench::preprocessing {

namespace {

constexpr std::size_t kRowsPerChunk = 32;  // multiple of the cell height
/// Tolerance for border pixels whose motion is zero except for rounding.
constexpr float kRounding_px = 1e-4F;
/// Number of fixed-point iterations without an initial depth from the pixel above.
constexpr int kInitialDepthIterations = 3;

using simd::lane_details::byte_of;

using Bytes [[gnu::vector_size(32)]] = std::uint8_t;  ///< of eight words

/// 1 / depth; 0 without depth, which means infinitely far: rotation only. The parabolas are not valid below
/// the minimum range of the camera.
simd::Float8 inverse_depth(simd::Float8 depth_m) {
  constexpr float kNearest_m = 0.1F;
  const simd::Int8 measured = depth_m > 0.0F;
  return measured ? 1.0F / simd::max(depth_m, simd::all_lanes(kNearest_m)) : simd::Float8{};
}

/// Interpolates one channel of four neighbours, given as bytes of words, with rounding.
struct Bilinear {
  simd::Float8 right;  // weights
  simd::Float8 down;

  [[nodiscard]] simd::Int8 operator()(simd::Float8 upper_left, simd::Float8 upper_right,
                                      simd::Float8 lower_left, simd::Float8 lower_right) const {
    const simd::Float8 upper = mixed(upper_left, upper_right);
    const simd::Float8 lower = mixed(lower_left, lower_right);
    return simd::to_int(simd::multiply_add(down, lower - upper, upper + 0.5F));
  }
  [[nodiscard]] simd::Float8 mixed(simd::Float8 a, simd::Float8 b) const {
    return simd::multiply_add(right, b - a, a);
  }
};

/// Eight positions in an image.
struct ImagePositions {
  simd::Float8 x{};
  simd::Float8 y{};
  simd::Int8 inside{};
};

/// The source image.
class SourceBounds {
 public:
  explicit SourceBounds(const PinholeCamera& camera)
      : last_x_(static_cast<float>(camera.width_px - 1)), last_y_(static_cast<float>(camera.height_px - 1)) {}

  /// Positions displaced from eight pixels of a row, clamped to the image.
  [[nodiscard]] ImagePositions displaced(int column, int row, const Displacement8& by) const {
    const simd::Float8 x = static_cast<float>(column) + simd::kLaneNumber + by.x;
    const simd::Float8 y = static_cast<float>(row) + by.y;
    const simd::Int8 inside = (x >= -kRounding_px) & (x <= last_x_ + kRounding_px) & (y >= -kRounding_px) &
                              (y <= last_y_ + kRounding_px);
    return {held(x, last_x_), held(y, last_y_), inside};
  }

  /// The pixel at or before a position whose right and lower neighbours exist.
  [[nodiscard]] simd::Int8 left(simd::Float8 x) const {
    return simd::to_int(simd::min(x, simd::all_lanes(last_x_ - 1.0F)));
  }
  [[nodiscard]] simd::Int8 top(simd::Float8 y) const {
    return simd::to_int(simd::min(y, simd::all_lanes(last_y_ - 1.0F)));
  }

 private:
  /// NaN is clamped to the border too, so no read is out of bounds.
  static simd::Float8 held(simd::Float8 values, float last) {
    return simd::min(simd::max(simd::Float8{}, values), simd::all_lanes(last));
  }

  float last_x_, last_y_;
};

using DepthGrid = NodeGrid<Readout::kFromRows>;
using ColorGrid = NodeGrid<DisplacementParabola::kCount>;
static_assert(DepthGrid::kRows == ColorGrid::kRows && kRowsPerChunk % DepthGrid::kRows == 0,
              "cells are entered together");

/// Displacement of eight pixels of a row, given their depth.
template <class Cell>
Displacement8 displacement(const Cell& cell, float rows, simd::Float8 inverse_depth) {
  return DisplacementParabola::at(inverse_depth, [&](std::size_t i) { return cell.at(i, rows); });
}

/// Depth at the instant of the frame.
class DepthCarrier {
 public:
  DepthCarrier(const RgbdFrame& source, const PinholeCamera& camera, const Readout& readout)
      : source_m_(source.depth_m),
        bounds_(camera),
        grid_(camera.width_px, camera.height_px,
              [&](simd::Float8 u, float v) { return readout.from_rows(u, v); }) {}

  /// Eight columns that are processed row by row: the depth found above a pixel starts its search.
  struct Columns {
    int column = 0;  ///< first column
    DepthGrid::Cell cell;
    simd::Float8 inverse_depth{};  ///< measured in the row above
  };

  void enter_cell(Columns& columns, int cell) const { columns.cell = grid_.cell(columns.column, cell); }

  void start(Columns& columns, int row) const {
    columns.inverse_depth = inverse_depth(simd::load(&source_m_.data[source_m_.index(columns.column, row)]));
    for (int i = 0; i + 1 < kInitialDepthIterations; ++i) std::ignore = depth_m(columns, row);
  }

  /// Depth in a row of these columns: of the depth pixel that moves there, transformed to the instant of the
  /// frame.
  [[nodiscard]] simd::Float8 depth_m(Columns& columns, int row) const {
    const auto rows = static_cast<float>(row % DepthGrid::kRows);
    const ImagePositions from =
        bounds_.displaced(columns.column, row, displacement(columns.cell, rows, columns.inverse_depth));
    const simd::Float8 measured_m = simd::gather(
        source_m_.data.data(), simd::to_int(from.y + 0.5F) * source_m_.width + simd::to_int(from.x + 0.5F));
    const simd::Int8 measured = measured_m > 0.0F;
    // At a hole the previous depth remains the initial value, unless it leads out of the image.
    const simd::Float8 before = from.inside ? columns.inverse_depth : simd::Float8{};
    columns.inverse_depth = measured ? inverse_depth(measured_m) : before;
    const simd::Float8 carried_m =
        simd::multiply_add(measured_m, columns.cell.at(Readout::kDepthFactor, rows),
                           columns.cell.at(Readout::kDepthShift_m, rows));
    return from.inside & measured & (carried_m > 0.0F) ? carried_m : simd::Float8{};
  }

 private:
  const DepthImage& source_m_;
  SourceBounds bounds_;
  DepthGrid grid_;
};

/// Source positions of colour and grey, and their sampling.
class ColorSource {
 public:
  ColorSource(const RgbdFrame& source, const PinholeCamera& camera, const Readout& readout)
      : source_(source),
        bounds_(camera),
        grid_(camera.width_px, camera.height_px,
              [&](simd::Float8 u, float v) { return readout.to_rows(u, v); }) {}

  [[nodiscard]] ColorGrid::Cell cell(int column, int cell) const { return grid_.cell(column, cell); }

  /// Source positions of eight pixels of a row in the given cell.
  [[nodiscard]] ImagePositions places(const ColorGrid::Cell& cell, int column, int row,
                                      simd::Float8 depth_m) const {
    const auto rows = static_cast<float>(row % ColorGrid::kRows);
    return bounds_.displaced(column, row, displacement(cell, rows, inverse_depth(depth_m)));
  }

  void write_grey(const ImagePositions& places, std::uint8_t* target) const {
    const simd::Int8 upper = upper_left(places);
    const Bilinear mix = shares(places);
    const auto* const bytes = source_.grey.data.data();
    const simd::Int8 above = simd::gather_bytes(bytes, source_.grey.data.size(), upper);
    const simd::Int8 below = simd::gather_bytes(bytes, source_.grey.data.size(), upper + source_.grey.width);
    const simd::Int8 grey = mix(byte_of(above, 0), byte_of(above, 1), byte_of(below, 0), byte_of(below, 1));
    const Bytes levels = __builtin_shuffle(std::bit_cast<Bytes>(grey),
                                           Bytes{0, 4, 8, 12, 16, 20, 24, 28, 0, 0, 0, 0, 0, 0, 0, 0,
                                                 0, 0, 0, 0,  0,  0,  0,  0,  0, 0, 0, 0, 0, 0, 0, 0});
    std::memcpy(target, &levels, simd::kLanes);
  }

  void write_color(const ImagePositions& places, Rgb* target) const {
    static_assert(sizeof(Rgb) == 3 && std::endian::native == std::endian::little);
    const simd::Int8 upper = upper_left(places);
    const Bilinear mix = shares(places);
    const int width = source_.color.width;
    const auto* const bytes = source_.color.data.data()->data();
    const auto pixels = [&](simd::Int8 at) {
      return simd::gather_bytes(bytes, 3 * source_.color.data.size(), 3 * at);
    };
    const simd::Int8 upper_left = pixels(upper);
    const simd::Int8 upper_right = pixels(upper + 1);
    const simd::Int8 lower_left = pixels(upper + width);
    const simd::Int8 lower_right = pixels(upper + width + 1);
    const auto channel = [&](int at) {
      return mix(byte_of(upper_left, at), byte_of(upper_right, at), byte_of(lower_left, at),
                 byte_of(lower_right, at));
    };
    const simd::Int8 words = channel(0) | channel(1) << 8 | channel(2) << 16;
    const Bytes eight = __builtin_shuffle(
        std::bit_cast<Bytes>(words), Bytes{0,  1,  2,  4,  5,  6,  8,  9,  10, 12, 13, 14, 16, 17, 18, 20,
                                           21, 22, 24, 25, 26, 28, 29, 30, 0,  0,  0,  0,  0,  0,  0,  0});
    std::memcpy(target, &eight, 3 * simd::kLanes);
  }

 private:
  [[nodiscard]] simd::Int8 upper_left(const ImagePositions& places) const {
    return bounds_.top(places.y) * source_.grey.width + bounds_.left(places.x);
  }
  [[nodiscard]] Bilinear shares(const ImagePositions& places) const {
    return {places.x - simd::to_float(bounds_.left(places.x)),
            places.y - simd::to_float(bounds_.top(places.y))};
  }

  const RgbdFrame& source_;
  SourceBounds bounds_;
  ColorGrid grid_;
};

/// Interleaves independent groups of columns: each step is done for all groups before the next step, which
/// hides memory latency.
constexpr int kGroupsPerTile = 8;
constexpr int kTileWidth = kGroupsPerTile * static_cast<int>(simd::kLanes);

/// Calls use(group, column) for each eight columns of a tile. The last group of a row may overlap the one
/// before.
template <class Use>
void for_each_group(int first_column, int width, const Use& use) {
  std::size_t group = 0;
  for (int x = first_column; x < std::min(first_column + kTileWidth, width);
       x += static_cast<int>(simd::kLanes))
    use(group++, std::min(x, width - static_cast<int>(simd::kLanes)));
}

/// Compensates depth and grey of a tile, row by row.
void compensate_tile(const DepthCarrier& carrier, const ColorSource& colors, int first_column, int first_row,
                     int end_row, RgbdFrame& result) {
  std::array<DepthCarrier::Columns, kGroupsPerTile> depth;
  std::array<ColorGrid::Cell, kGroupsPerTile> color;
  std::array<simd::Float8, kGroupsPerTile> carried_m;
  std::array<ImagePositions, kGroupsPerTile> places;
  const int width = result.grey.width;
  for (int row = first_row; row < end_row; ++row) {
    if (row % DepthGrid::kRows == 0) {
      for_each_group(first_column, width, [&](std::size_t group, int column) {
        depth[group].column = column;
        carrier.enter_cell(depth[group], row / DepthGrid::kRows);
        if (row == first_row) carrier.start(depth[group], row);
        color[group] = colors.cell(column, row / ColorGrid::kRows);
      });
    }
    for_each_group(first_column, width,
                   [&](std::size_t group, int) { carried_m[group] = carrier.depth_m(depth[group], row); });
    for_each_group(first_column, width, [&](std::size_t group, int column) {
      places[group] = colors.places(color[group], column, row, carried_m[group]);
      // Depth without colour is not used.
      simd::store(places[group].inside ? carried_m[group] : simd::Float8{}, &result.depth_m(column, row));
    });
    for_each_group(first_column, width, [&](std::size_t group, int column) {
      colors.write_grey(places[group], &result.grey(column, row));
    });
  }
}

/// Compensates the colour of a tile, given its compensated depth.
void compensate_tile(const ColorSource& colors, const DepthImage& depth_m, int first_column, int first_row,
                     int end_row, ColorImage& result) {
  std::array<ColorGrid::Cell, kGroupsPerTile> cells;
  std::array<ImagePositions, kGroupsPerTile> places;
  for (int row = first_row; row < end_row; ++row) {
    if (row % ColorGrid::kRows == 0) {
      for_each_group(first_column, result.width, [&](std::size_t group, int column) {
        cells[group] = colors.cell(column, row / ColorGrid::kRows);
      });
    }
    for_each_group(first_column, result.width, [&](std::size_t group, int column) {
      places[group] = colors.places(cells[group], column, row, simd::load(&depth_m(column, row)));
    });
    for_each_group(first_column, result.width, [&](std::size_t group, int column) {
      colors.write_color(places[group], &result(column, row));
    });
  }
}

/// Calls use(first_column, first_row, end_row) for all tiles.
template <class Use>
void for_each_tile(const PinholeCamera& camera, const Workers& workers, const Use& use) {
  workers.for_chunks(static_cast<std::size_t>(camera.height_px), kRowsPerChunk,
                     [&](std::size_t begin, std::size_t end) {
                       for (int x = 0; x < camera.width_px; x += kTileWidth)
                         use(x, static_cast<int>(begin), static_cast<int>(end));
                     });
}

void check_sizes(const RgbdFrame& frame, const PinholeCamera& camera) {
  check(camera.width_px >= static_cast<int>(simd::kLanes) && camera.height_px >= 2,
        "an image has at least 8 columns and 2 rows");
  const auto has_size = [&](const auto& image) {
    return image.width == camera.width_px && image.height == camera.height_px;
  };
  check(has_size(frame.grey) && has_size(frame.depth_m) && (frame.color.empty() || has_size(frame.color)),
        "images have the camera's size");
}

Readout color_readout(const PinholeCamera& camera, const FrameTiming& timing,
                      const CameraVelocity& velocity) {
  return {camera, RowTimes(camera.height_px, 0.0, timing.color_readout_s), velocity};
}

}  // namespace

FrameTiming frame_timing(const RgbdFrame& frame, const SensorTiming& timing) {
  return {timing.color_readout_s, timing.depth_readout_s, seconds_between(0, frame.depth_offset_ns)};
}

void compensate_motion(const RgbdFrame& frame, const PinholeCamera& camera, const FrameTiming& timing,
                       const CameraVelocity& velocity, const Workers& workers, RgbdFrame& result) {
  check_sizes(frame, camera);
  result.timestamp_ns = frame.timestamp_ns;
  result.capture_offset_ns = frame.capture_offset_ns;
  result.depth_offset_ns = 0;
  result.grey.resize(camera.width_px, camera.height_px);
  result.depth_m.resize(camera.width_px, camera.height_px);
  const RowTimes depth_times(camera.height_px, timing.depth_delay_s, timing.depth_readout_s);
  const DepthCarrier carrier(frame, camera, Readout(camera, depth_times, velocity));
  const ColorSource colors(frame, camera, color_readout(camera, timing, velocity));
  for_each_tile(camera, workers, [&](int first_column, int first_row, int end_row) {
    compensate_tile(carrier, colors, first_column, first_row, end_row, result);
  });
}

void compensate_color(const RgbdFrame& frame, const PinholeCamera& camera, const FrameTiming& timing,
                      const CameraVelocity& velocity, const DepthImage& depth_m, const Workers& workers,
                      ColorImage& result) {
  check_sizes(frame, camera);
  check(depth_m.data.size() == frame.depth_m.data.size(), "depth has the camera's size");
  result.resize(frame.color.width, frame.color.height);
  if (frame.color.empty()) return;
  const ColorSource colors(frame, camera, color_readout(camera, timing, velocity));
  for_each_tile(camera, workers, [&](int first_column, int first_row, int end_row) {
    compensate_tile(colors, depth_m, first_column, first_row, end_row, result);
  });
}

}  // namespace fusebench::preprocessing
