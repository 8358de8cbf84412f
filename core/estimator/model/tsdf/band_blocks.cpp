#include "core/estimator/model/tsdf/band_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/base/bits.hpp"
#include "core/base/simd/lanes.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::tsdf {
namespace {

constexpr std::size_t kRowsPerChunk = 32;  // a multiple of any stride
constexpr int kPixels = static_cast<int>(simd::kLanes);

/// Phase of the selected pixels, 0 to stride - 1 (stride: a power of two, at most 4). It changes with
/// `number`, distant phases first (van der Corput 1935).
int taken_of(int stride, std::uint32_t number) {
  constexpr std::array<int, 4> kBitReversed = {0, 2, 1, 3};
  return kBitReversed[number % kBitReversed.size()] * stride / 4;
}

/// Traversal of eight ray segments along one axis of the lattice, in units of blocks.
struct AxisSegments {
  simd::Int8 begin;      ///< block at the start of the segment
  simd::Int8 crossings;  ///< number of crossed faces, negative if downwards
  simd::Float8 next;     ///< fraction of the segment at the first crossing
  simd::Float8 delta;    ///< fraction between two crossings
};

/// Segment from origin + near * ray to origin + far * ray.
AxisSegments segments_along(float origin, simd::Float8 ray, simd::Float8 near, simd::Float8 far) {
  const simd::Float8 never = simd::all_lanes(std::numeric_limits<float>::infinity());
  const simd::Float8 from = simd::multiply_add(near, ray, simd::all_lanes(origin));
  const simd::Float8 to = simd::multiply_add(far, ray, simd::all_lanes(origin));
  const simd::Int8 begin = simd::floor_to_int(from);
  const simd::Int8 crossings = simd::floor_to_int(to) - begin;
  const simd::Float8 floor_from = simd::to_float(begin);
  const simd::Float8 length = simd::abs(to - from);
  const simd::Float8 between = 1.0F / (crossings == 0 ? simd::all_lanes(1.0F) : length);
  const simd::Float8 rest = crossings > 0 ? floor_from + 1.0F - from : from - floor_from;
  return {begin, crossings, crossings == 0 ? never : rest * between, crossings == 0 ? never : between};
}

/// Block traversal of eight segments. Segments pass the same blocks if they begin in the same block and cross
/// the same faces in the same order. Most neighbouring pixels do.
struct Paths {
  std::array<simd::Int8, 3> begin;
  std::array<simd::Int8, 3> crossings;
  simd::Int8 order;  ///< of the crossings; -1 if an axis is crossed more than twice or without a measurement

  /// Bit i is set if pixel i passes other blocks than the previous pixel; `last`: paths before the first.
  [[nodiscard]] unsigned changes(const Paths& last) const {
    simd::Int8 same = (order != -1) & (order == shifted(last.order, order));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      same &= (begin[axis] == shifted(last.begin[axis], begin[axis])) &
              (crossings[axis] == shifted(last.crossings[axis], crossings[axis]));
    }
    return ~simd::lane_bits(same) & 0xFF;
  }
  /// The last lane of `last`, followed by all but the last lane of `now`.
  static simd::Int8 shifted(simd::Int8 last, simd::Int8 now) {
    return __builtin_shuffle(last, now, simd::Int8{7, 8, 9, 10, 11, 12, 13, 14});
  }
};

/// One bit for each comparison of crossings of two axes.
simd::Int8 order_of(const std::array<AxisSegments, 3>& axes) {
  const simd::Float8 never = simd::all_lanes(std::numeric_limits<float>::infinity());
  simd::Int8 often{};
  std::array<std::array<simd::Float8, 2>, 3> at;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisSegments& segments = axes[axis];
    const simd::Int8 magnitude = segments.crossings < 0 ? -segments.crossings : segments.crossings;
    often |= magnitude > 2;
    at[axis] = {segments.next, magnitude > 1 ? segments.next + segments.delta : never};
  }
  simd::Int8 order{};
  int bit = 1;
  for (const auto& [a, b] : {std::pair{0U, 1U}, std::pair{0U, 2U}, std::pair{1U, 2U}}) {
    for (const simd::Float8& of_a : at[a]) {
      for (const simd::Float8& of_b : at[b]) {
        order |= (of_a <= of_b) & bit;
        bit *= 2;
      }
    }
  }
  return order | often;  // true is -1
}

/// The rays of the pixels of a camera, cut to the band around their measurements.
class PixelSegments {
 public:
  PixelSegments(const PinholeCamera& camera, const SE3& T_world_camera, double block_m,
                const config::TsdfConfig& tsdf, const config::DepthConfig& depth)
      : rays_((T_world_camera.rotation_matrix() / block_m).cast<float>()),
        camera_block_((T_world_camera.translation / block_m).array().floor().cast<int>()),
        origin_((T_world_camera.translation / block_m - camera_block_.cast<double>()).cast<float>()),
        per_fx_(static_cast<float>(1.0 / camera.fx_px)),
        per_fy_(static_cast<float>(1.0 / camera.fy_px)),
        cx_(static_cast<float>(camera.cx_px)),
        cy_(static_cast<float>(camera.cy_px)),
        nearest_m_(static_cast<float>(depth.min_m)),
        farthest_m_(static_cast<float>(depth.max_m)),
        truncation_m_(static_cast<float>(std::max(tsdf.truncation_m, 2.0 * tsdf.voxel_m))),
        truncation_sigmas_(static_cast<float>(tsdf.truncation_sigmas)),
        depth_sigma_(depth) {}

  /// Adds the blocks of every stride-th pixel of a row, from `first` on.
  void add_row(const float* row_m, int width, int y, int first, int stride, OrderedBlocks& blocks) {
    last_.order = simd::all_lanes(-1);
    const simd::Float8 ray_y = simd::all_lanes((static_cast<float>(y) - cy_) * per_fy_);
    const simd::Float8 columns = static_cast<float>(stride) * simd::kLaneNumber;
    for (int x = first; x < width; x += stride * kPixels) {
      // Pixels beyond the end of the row have no measurement.
      const simd::Int8 offset = stride * simd::to_int(simd::kLaneNumber);
      const simd::Int8 inside = offset < width - x;
      const simd::Float8 depth_m =
          inside ? simd::gather(row_m + x, inside ? offset : simd::Int8{}) : simd::Float8{};
      add_pixels(depth_m, (static_cast<float>(x) - cx_ + columns) * per_fx_, ray_y, blocks);
    }
  }

 private:
  void add_pixels(simd::Float8 depth_m, simd::Float8 ray_x, simd::Float8 ray_y, OrderedBlocks& blocks) {
    const simd::Int8 measured = (depth_m >= nearest_m_) & (depth_m <= farthest_m_);
    const simd::Float8 band_m =
        simd::max(simd::all_lanes(truncation_m_), truncation_sigmas_ * depth_sigma_.at_m(depth_m));
    const simd::Float8 near_m = measured ? simd::max(simd::Float8{}, depth_m - band_m) : simd::Float8{};
    const simd::Float8 far_m = measured ? depth_m + band_m : simd::Float8{};
    std::array<AxisSegments, 3> axes;
    Paths paths;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      const simd::Float8 ray = simd::multiply_add(
          rays_(k, 0), ray_x, simd::multiply_add(rays_(k, 1), ray_y, simd::all_lanes(rays_(k, 2))));
      axes[axis] = segments_along(origin_[k], ray, near_m, far_m);
      paths.begin[axis] = axes[axis].begin;
      paths.crossings[axis] = axes[axis].crossings;
    }
    paths.order = measured ? order_of(axes) : simd::all_lanes(-1);
    const unsigned walk = paths.changes(last_) & simd::lane_bits(measured);
    for_each_bit(walk, [&](std::size_t lane) { add_blocks(axes, lane, blocks); });
    last_ = paths;
  }

  // Adds the blocks of a segment by the traversal of Amanatides & Woo 1987. The number of steps is computed
  // first, so the loop always ends; rounding can at worst select a neighbour at a corner.
  void add_blocks(const std::array<AxisSegments, 3>& axes, std::size_t lane, OrderedBlocks& blocks) const {
    const std::array<int, 3> crossings = {axes[0].crossings[lane], axes[1].crossings[lane],
                                          axes[2].crossings[lane]};
    std::array<float, 3> next = {axes[0].next[lane], axes[1].next[lane], axes[2].next[lane]};
    BlockIndex at = camera_block_ + BlockIndex(axes[0].begin[lane], axes[1].begin[lane], axes[2].begin[lane]);
    blocks.add(at);
    for (int steps = std::abs(crossings[0]) + std::abs(crossings[1]) + std::abs(crossings[2]); steps > 0;
         --steps) {
      const std::size_t axis =
          next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : (next[1] <= next[2] ? 1 : 2);
      at[static_cast<Eigen::Index>(axis)] += crossings[axis] > 0 ? 1 : -1;
      next[axis] += axes[axis].delta[lane];
      blocks.add(at);
    }
  }

  // Lattice coordinates below are relative to the camera's block, to keep them small.
  Eigen::Matrix3f rays_;  // columns: derivative of the ray by u and v (plane z = 1), and the optical axis
  BlockIndex camera_block_;
  Eigen::Vector3f origin_;
  float per_fx_, per_fy_, cx_, cy_;  // pixels
  float nearest_m_, farthest_m_;
  float truncation_m_;
  float truncation_sigmas_;
  preprocessing::DepthSigma depth_sigma_;
  Paths last_{};  // of the previous pixels
};

}  // namespace

double half_band_m(double depth_m, const config::TsdfConfig& tsdf, const config::DepthConfig& depth) {
  return std::max(std::max(tsdf.truncation_m, 2.0 * tsdf.voxel_m),
                  tsdf.truncation_sigmas * preprocessing::depth_sigma_m(depth_m, depth));
}

void OrderedBlocks::clear() {
  table_.clear();
  blocks_.clear();
  clear_recent();
}

void OrderedBlocks::clear_recent() {
  recent_.fill(BlockIndex::Constant(std::numeric_limits<int>::max()));  // outside the lattice
}

void BandBlocks::find(const DepthImage& depth_m, const PinholeCamera& camera, const SE3& T_world_camera,
                      double block_m, const config::TsdfConfig& tsdf, const config::DepthConfig& depth,
                      std::uint32_t frame_number, const Workers& workers) {
  const double block_px = block_m * std::min(camera.fx_px, camera.fy_px) / depth.max_m;
  const int stride = block_px >= kFinePixels ? 4 : (block_px >= kFinePixels / 2 ? 2 : 1);
  const auto rows = static_cast<std::size_t>(depth_m.height);
  const auto most = static_cast<std::size_t>(tsdf.max_blocks);
  chunks_.resize((rows + kRowsPerChunk - 1) / kRowsPerChunk);
  workers.for_chunks(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    OrderedBlocks& blocks = chunks_[begin / kRowsPerChunk];
    blocks.clear();
    PixelSegments segments(camera, T_world_camera, block_m, tsdf, depth);
    for (int y = static_cast<int>(begin) + taken_of(stride, frame_number);
         y < static_cast<int>(end) && blocks.blocks().size() <= most; y += stride) {
      const int first = taken_of(stride, static_cast<std::uint32_t>(y / stride) + frame_number);
      segments.add_row(&depth_m.data[depth_m.index(0, y)], depth_m.width, y, first, stride, blocks);
    }
  });
  found_.clear();
  for (const OrderedBlocks& chunk : chunks_) {
    if (found_.blocks().size() > most) break;
    for (const BlockIndex& index : chunk.blocks()) found_.add(index);
  }
}

}  // namespace fusebench::tsdf
