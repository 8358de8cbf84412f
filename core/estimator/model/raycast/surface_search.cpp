#include "core/estimator/model/raycast/surface_search.hpp"

#include <algorithm>
#include <limits>

#include "core/config/groups/frame_config.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::raycast {

namespace {

// Search distance along the ray on both sides of a measurement: noise of measurement and model, plus some
// voxels for the steps.
constexpr float kReach_sigmas = 2.0F;
constexpr float kReach_voxels = 2.0F;
// The gradient at a point uses the voxel before the base of its cell and two after it.
constexpr int kBefore = 1;
constexpr int kAfter = 2;
constexpr int kMaxSamples = 10;

// Copying a larger brick takes longer than a block lookup for each pixel, or exceeds the L2 cache (256 kB).
constexpr double kVoxelsPerPixel = 200;
constexpr double kMaxVoxels = 65536;
constexpr std::size_t kFewPixels = 32;

}  // namespace

/// From the first voxel to the last one on each axis.
struct SurfaceSearch::Box {
  [[nodiscard]] double voxels() const { return ((last - first).cast<double>().array() + 1.0).prod(); }

  tsdf::VoxelIndex first;
  tsdf::VoxelIndex last;
};

/// Eight pixels; unused lanes repeat the last one.
struct SurfaceSearch::PixelGroup {
  simd::Float8 u_px;
  simd::Float8 v_px;
  simd::Float8 depth_m;
  simd::Float8 reach_m;
};

SurfaceSearch::SurfaceSearch(const tsdf::TsdfLanes& field, const PinholeCamera& camera,
                             const SE3& T_world_camera, const config::DepthConfig& depth)
    : field_(field),
      rays_(camera, T_world_camera, field.volume().voxel_m()),
      camera_voxel_(T_world_camera.translation / field.volume().voxel_m()),
      depth_sigma_(depth),
      nearest_m_(static_cast<float>(depth.min_m)),
      farthest_m_(static_cast<float>(depth.max_m)),
      voxel_m_(static_cast<float>(field.volume().voxel_m())) {}

void SurfaceSearch::find(std::span<const ExpectedSurface> pixels, std::span<SurfacePoint> surfaces) const {
  find_in(field_, field_.origin_voxel(), false, pixels, surfaces);
}

void SurfaceSearch::find_near_measurements(std::span<const ExpectedSurface> pixels, tsdf::TsdfBrick& brick,
                                           std::span<SurfacePoint> surfaces) const {
  if (pixels.empty()) return;
  const Box box = box_around(pixels);
  if (box.voxels() <= kMaxVoxels && box.voxels() <= kVoxelsPerPixel * static_cast<double>(pixels.size())) {
    brick.copy(field_.volume(), box.first, box.last);
    find_in(brick, brick.origin_voxel().cast<double>(), true, pixels, surfaces);
  } else if (pixels.size() > kFewPixels) {
    // An edge between near and far, or distant pixels: each half is searched separately.
    const std::size_t half = pixels.size() / 2;
    find_near_measurements(pixels.first(half), brick, surfaces.first(half));
    find_near_measurements(pixels.subspan(half), brick, surfaces.subspan(half));
  } else {
    find_in(field_, field_.origin_voxel(), true, pixels, surfaces);
  }
}

template <class Field>
void SurfaceSearch::find_in(const Field& field, const Vector3d& field_origin_voxel, bool beside,
                            std::span<const ExpectedSurface> pixels, std::span<SurfacePoint> surfaces) const {
  const Eigen::Vector3f origin = (camera_voxel_ - field_origin_voxel).cast<float>();
  for (std::size_t begin = 0; begin < pixels.size(); begin += simd::kLanes) {
    const Hits hits = search(group_of(pixels, begin, beside), origin, field);
    const std::size_t count = std::min(simd::kLanes, pixels.size() - begin);
    for (std::size_t lane = 0; lane < count; ++lane) surfaces[begin + lane] = surface_point(hits, lane);
  }
}

SurfaceSearch::PixelGroup SurfaceSearch::group_of(std::span<const ExpectedSurface> pixels, std::size_t begin,
                                                  bool beside) const {
  PixelGroup group{};
  for (std::size_t lane = 0; lane < simd::kLanes; ++lane) {
    const ExpectedSurface& pixel = pixels[std::min(begin + lane, pixels.size() - 1)];
    group.u_px[lane] = pixel.u_px;
    group.v_px[lane] = pixel.v_px;
    group.depth_m[lane] = pixel.depth_m;
    group.reach_m[lane] = pixel.reach_m;
  }
  if (beside) {
    const simd::Float8 noise_m = kReach_sigmas * depth_sigma_.at_m(group.depth_m) + kReach_voxels * voxel_m_;
    group.reach_m = simd::min(group.reach_m, noise_m);
  }
  return group;
}

/// Voxels around all searched parts of rays.
SurfaceSearch::Box SurfaceSearch::box_around(std::span<const ExpectedSurface> pixels) const {
  constexpr float kFar = std::numeric_limits<float>::max();
  simd::Points low = {simd::all_lanes(kFar), simd::all_lanes(kFar), simd::all_lanes(kFar)};
  simd::Points high = {simd::all_lanes(-kFar), simd::all_lanes(-kFar), simd::all_lanes(-kFar)};
  for (std::size_t begin = 0; begin < pixels.size(); begin += simd::kLanes) {
    const PixelGroup group = group_of(pixels, begin, true);
    const RayLanes rays = rays_.through(group.u_px, group.v_px, Eigen::Vector3f::Zero());
    for (const simd::Points& p :
         {rays.at(group.depth_m - group.reach_m), rays.at(group.depth_m + group.reach_m)}) {
      low = {simd::min(low.x, p.x), simd::min(low.y, p.y), simd::min(low.z, p.z)};
      high = {simd::max(high.x, p.x), simd::max(high.y, p.y), simd::max(high.z, p.z)};
    }
  }
  const auto least = [](simd::Float8 values) {
    float result = values[0];
    for (std::size_t lane = 1; lane < simd::kLanes; ++lane) result = std::min(result, values[lane]);
    return static_cast<double>(result);
  };
  const Vector3d first = camera_voxel_ + Vector3d(least(low.x), least(low.y), least(low.z));
  const Vector3d last = camera_voxel_ - Vector3d(least(-high.x), least(-high.y), least(-high.z));
  return {first.array().floor().cast<int>() - kBefore, last.array().floor().cast<int>() + kAfter};
}

template <class Field>
Hits SurfaceSearch::search(const PixelGroup& group, const Eigen::Vector3f& origin, const Field& field) const {
  const RayLanes rays = rays_.through(group.u_px, group.v_px, origin);
  const simd::Float8 begin_m = simd::max(group.depth_m - group.reach_m, simd::all_lanes(nearest_m_));
  const simd::Float8 end_m = simd::min(group.depth_m + group.reach_m, simd::all_lanes(farthest_m_));
  const simd::Float8 z_per_metre = rays.z_per_voxel * (1.0F / voxel_m_);
  Brackets bracket;
  simd::Float8 z_m = group.depth_m;
  simd::Float8 crossing_m = group.depth_m;
  simd::Int8 found{};
  simd::Int8 open = (z_m >= begin_m) & (z_m <= end_m);
  simd::Int8 halve{};  // next: middle of the bracket, after the zero of its chord
  for (int i = 0; i < kMaxSamples && simd::any(open); ++i) {
    const simd::Float8 distance_m = field.sample(rays.at(z_m));
    open &= distance_m == distance_m;
    const simd::Int8 front = open & (distance_m >= 0.0F);
    bracket.take(front, open & ~front, z_m, distance_m);
    const simd::Int8 bracketed =
        (bracket.front_z_m == bracket.front_z_m) & (bracket.back_z_m == bracket.back_z_m);
    const simd::Float8 chord_m = bracketed ? bracket.zero_of_chord() : z_m + z_per_metre * distance_m;
    const simd::Int8 done = open & (is_zero(distance_m, voxel_m_) | bracket.are_narrow(rays.z_per_voxel));
    crossing_m = done ? chord_m : crossing_m;
    found |= done;
    open &= ~done;
    const simd::Float8 beyond_m = kBeyond_voxels * rays.z_per_voxel;
    const simd::Float8 onward_m = chord_m + (front ? beyond_m : -beyond_m);
    const simd::Float8 next_m = bracketed ? (halve ? bracket.middle() : chord_m) : onward_m;
    halve = bracketed & ~halve;
    open &= (next_m >= begin_m) & (next_m <= end_m);
    z_m = open ? next_m : z_m;
  }
  if (!simd::any(found)) return {};
  return hits_at(found, crossing_m, field.gradient(rays.at(crossing_m)), rays.direction);
}

}  // namespace fusebench::raycast
