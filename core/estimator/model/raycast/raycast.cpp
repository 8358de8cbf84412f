#include "core/estimator/model/raycast/raycast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/config/groups/frame_config.hpp"
#include "core/estimator/model/raycast/block_bounds.hpp"
#include "core/estimator/model/raycast/ray_lanes.hpp"
#include "core/estimator/model/tsdf/tsdf_lanes.hpp"

namespace fusebench::raycast {
namespace {

// At grazing incidence the field overestimates the distance. A step of less than its value rarely crosses the
// surface; after a step into unobserved space, the march repeats that part in fine steps.
constexpr float kStepShare = 0.8F;
constexpr float kFineStep_voxels = 0.5F;
// The observed band in front of a surface is at least two voxels wide.
constexpr float kUnknownStep_voxels = 1.5F;
// Beyond this distance to the surface the nearest voxel is accurate enough; closer, the field is
// interpolated.
constexpr float kNear_voxels = 1.75F;
constexpr int kMaxRefinements = 24;
constexpr int kBlockShift = 3;   // voxels to blocks
constexpr int kRegionShift = 5;  // voxels to regions

struct Rays : RayLanes {
  /// z-depth from a point on the rays to the end of the cube with this index; point and cube in units of
  /// `side` voxels.
  [[nodiscard]] simd::Float8 z_to_leave(const simd::Points& point, const tsdf::LatticePoints& cube,
                                        simd::Float8 side) const {
    const auto along = [&](simd::Float8 from, simd::Int8 index, simd::Float8 inverse_step) {
      const simd::Float8 face = simd::to_float(index - (inverse_step >= 0.0F));  // true is -1
      return (face * side - from) * inverse_step;
    };
    return simd::min(simd::min(along(point.x, cube.x, inverse.x), along(point.y, cube.y, inverse.y)),
                     along(point.z, cube.z, inverse.z));
  }

  simd::Points inverse;  ///< of the direction
};

/// State of eight rays that march together.
struct MarchState {
  Rays rays;
  simd::Float8 end_m;
  simd::Float8 z_m;
  simd::Float8 free_z_m =
      tsdf::not_a_number();    ///< of the previous sample, if it was observed and in front of a surface
  simd::Float8 free_m{};       ///< field at that sample
  simd::Float8 careful_z_m{};  ///< fine steps up to this depth
  simd::Int8 active{};
  tsdf::LatticePoints voxel;  ///< nearest voxel to the rays
  tsdf::TsdfLanes::Location location;
  simd::Float8 nearest_m{};  ///< field of the nearest voxel
  Brackets brackets;
};

/// Eight pixels and the requested interval of their rays (z-depth).
struct RequestedRays {
  simd::Float8 u{};
  simd::Float8 v{};
  simd::Float8 begin_m{};
  simd::Float8 end_m = simd::all_lanes(std::numeric_limits<float>::infinity());
};

// Marches along rays of one camera, eight at a time, with several groups interleaved: the processor computes
// a step of one group while memory reads of another are pending. The result of a ray does not depend on its
// group.
class RayMarcher {
 public:
  RayMarcher(const tsdf::TsdfLanes& field, const PinholeCamera& camera, const SE3& T_world_camera,
             const config::DepthConfig& depth)
      : field_(field),
        pixels_(camera, T_world_camera, field.volume().voxel_m()),
        bounds_(field.volume(), camera, T_world_camera, depth),
        origin_((T_world_camera.translation / field.volume().voxel_m() - field.origin_voxel()).cast<float>()),
        nearest_m_(static_cast<float>(depth.min_m)),
        farthest_m_(static_cast<float>(depth.max_m)),
        voxel_m_(static_cast<float>(field.volume().voxel_m())) {}

  static constexpr std::size_t kMaxInterleaved = 8;

  /// At most kMaxInterleaved groups of eight pixels.
  void march(std::span<const RequestedRays> pixels, std::span<Hits> hits) const {
    std::array<MarchState, kMaxInterleaved> storage;
    const std::span<MarchState> states = std::span(storage).first(pixels.size());
    std::array<MarchState*, kMaxInterleaved> unfinished;
    std::size_t count = 0;
    for (std::size_t i = 0; i < states.size(); ++i) {
      states[i] = begin(pixels[i]);
      if (simd::any(states[i].active)) unfinished[count++] = &states[i];
    }
    // Issues reads that may miss the cache for all groups before it uses any result.
    while (count > 0) {
      const std::span<MarchState*> running = std::span(unfinished).first(count);
      for (MarchState* state : running) locate(*state);
      for (MarchState* state : running) state->nearest_m = field_.distances_m(state->location);
      for (MarchState* state : running) step(*state);
      const auto finished = std::remove_if(running.begin(), running.end(),
                                           [](const MarchState* state) { return !simd::any(state->active); });
      count = static_cast<std::size_t>(finished - running.begin());
    }
    for (std::size_t i = 0; i < states.size(); ++i) hits[i] = hits_of(states[i]);
  }

 private:
  [[nodiscard]] Rays rays_of(simd::Float8 u, simd::Float8 v) const {
    Rays rays{pixels_.through(u, v, origin_), {}};
    // For rays parallel to a face, the distance to it is a huge finite number, not the NaN of 0 * infinity.
    const auto inverse = [](simd::Float8 step) {
      return step == 0.0F ? simd::all_lanes(1e30F) : 1.0F / step;
    };
    rays.inverse = {inverse(rays.direction.x), inverse(rays.direction.y), inverse(rays.direction.z)};
    return rays;
  }

  /// The field at the current points of the rays.
  struct Sample {
    simd::Float8 distance_m;  // NaN if not observed
    simd::Float8 empty_z_m;   // z-depth without any block; 0 inside a block
    simd::Int8 near;          // distance_m was interpolated
  };

  void locate(MarchState& state) const {
    // Adds half a voxel, so that the floor is the nearest voxel.
    const simd::Points at = state.rays.at(state.z_m);
    state.voxel = {simd::floor_to_int(at.x + 0.5F), simd::floor_to_int(at.y + 0.5F),
                   simd::floor_to_int(at.z + 0.5F)};
    state.location = field_.locate(state.voxel);
  }

  [[nodiscard]] Sample sample(const MarchState& state) const {
    const simd::Int8 active = state.active;
    const simd::Points at = state.rays.at(state.z_m);
    Sample result;
    result.distance_m = state.nearest_m;
    result.empty_z_m = simd::Float8{};
    const simd::Int8 no_block = state.location.slot < 0;
    if (simd::any(no_block & active)) {
      const tsdf::LatticePoints& voxel = state.voxel;
      const simd::Int8 shift =
          state.location.no_region ? simd::all_lanes(kRegionShift) : simd::all_lanes(kBlockShift);
      const simd::Float8 left = state.rays.z_to_leave({at.x + 0.5F, at.y + 0.5F, at.z + 0.5F},
                                                      {voxel.x >> shift, voxel.y >> shift, voxel.z >> shift},
                                                      simd::to_float(simd::all_lanes(1) << shift));
      result.empty_z_m = no_block ? left : simd::Float8{};
    }
    result.near = (simd::abs(state.nearest_m) < kNear_voxels * voxel_m_) & active;
    if (simd::any(result.near)) {
      const simd::Float8 interpolated_m = field_.sample(at);
      result.distance_m = result.near ? interpolated_m : result.distance_m;
    }
    return result;
  }

  [[nodiscard]] MarchState begin(const RequestedRays& pixels) const {
    MarchState state;
    state.rays = rays_of(pixels.u, pixels.v);
    const simd::Float8 begin_m = simd::max(simd::max(pixels.begin_m, bounds_.nearest_m(pixels.u, pixels.v)),
                                           simd::all_lanes(nearest_m_));
    state.end_m = simd::min(pixels.end_m, simd::all_lanes(farthest_m_));
    state.active = begin_m <= state.end_m;
    state.z_m = state.active ? begin_m : simd::all_lanes(nearest_m_);
    return state;
  }

  /// Moves one step from front to back. Rays stop where the field changes from + to - between two
  /// neighbouring observed samples.
  void step(MarchState& state) const {
    const Rays& rays = state.rays;
    const simd::Float8 fine_z = kFineStep_voxels * rays.z_per_voxel;
    const simd::Float8 z_m = state.z_m;
    const Sample now = sample(state);
    const simd::Int8 observed = now.distance_m == now.distance_m;
    const simd::Int8 was_free = state.free_z_m == state.free_z_m;
    const simd::Int8 careful = z_m < state.careful_z_m;
    const simd::Int8 crossed = state.active & was_free & observed & (now.distance_m < 0.0F);
    Brackets& brackets = state.brackets;
    brackets.front_z_m = crossed ? state.free_z_m : brackets.front_z_m;
    brackets.front_m = crossed ? state.free_m : brackets.front_m;
    brackets.back_z_m = crossed ? z_m : brackets.back_z_m;
    brackets.back_m = crossed ? now.distance_m : brackets.back_m;
    // Step from free into unobserved space: it may have crossed a surface, so it is repeated in fine steps.
    const simd::Int8 repeat = was_free & ~observed & ~careful & (z_m - state.free_z_m > 1.01F * fine_z);
    const simd::Int8 give_up = ~observed & careful;
    const simd::Int8 free = observed & (now.distance_m >= 0.0F);
    const simd::Float8 field_z =
        (observed ? simd::abs(now.distance_m) : simd::Float8{}) * (rays.z_per_voxel * (1.0F / voxel_m_));
    const simd::Float8 beyond = field_z + kBeyond_voxels * rays.z_per_voxel;
    // In unobserved space no surface is missed before the next free space, which is wider than this step.
    const simd::Float8 least_z = observed | was_free ? fine_z : kUnknownStep_voxels * rays.z_per_voxel;
    const simd::Float8 plain =
        simd::max(simd::max(least_z, now.empty_z_m), now.near & free ? beyond : kStepShare * field_z);
    const simd::Float8 onward = careful & free ? z_m + fine_z : z_m + plain;
    const simd::Float8 next =
        repeat ? state.free_z_m + fine_z : (give_up ? simd::max(state.careful_z_m, onward) : onward);
    state.careful_z_m = repeat ? z_m : state.careful_z_m;
    state.free_z_m = free ? z_m : (repeat ? state.free_z_m : tsdf::not_a_number());
    state.free_m = free ? now.distance_m : state.free_m;
    state.active &= ~crossed & (next <= state.end_m);
    state.z_m = state.active ? next : z_m;
  }

  [[nodiscard]] Hits hits_of(const MarchState& state) const {
    const Rays& rays = state.rays;
    simd::Int8 found = state.brackets.front_z_m == state.brackets.front_z_m;
    if (!simd::any(found)) return {};
    const simd::Float8 depth_m = refined(rays, state.brackets, found);
    const simd::Points gradient = field_.gradient(rays.at(found ? depth_m : simd::all_lanes(nearest_m_)));
    return hits_at(found, depth_m, gradient, rays.direction);
  }

  /// Zeros in the brackets. Alternates between the zero of the chord, which is accurate for a smooth field,
  /// and the middle, which always halves the bracket. Removes lanes in unobserved space from `found`.
  [[nodiscard]] simd::Float8 refined(const Rays& rays, Brackets bracket, simd::Int8& found) const {
    simd::Int8 open = found & ~bracket.are_narrow(rays.z_per_voxel);
    for (int i = 0; i < kMaxRefinements && simd::any(open); ++i) {
      const simd::Float8 z_m = i % 2 == 0 ? bracket.zero_of_chord() : bracket.middle();
      const simd::Float8 distance_m = field_.sample(rays.at(open ? z_m : simd::all_lanes(nearest_m_)));
      const simd::Int8 unknown = open & (distance_m != distance_m);
      found &= ~unknown;
      open &= ~unknown;
      const simd::Int8 behind = open & (distance_m < 0.0F);
      bracket.take(open & ~behind, behind, z_m, distance_m);
      open &= ~(is_zero(distance_m, voxel_m_) | bracket.are_narrow(rays.z_per_voxel));
    }
    return found ? bracket.zero_of_chord() : simd::all_lanes(nearest_m_);
  }

  const tsdf::TsdfLanes& field_;
  PixelRays pixels_;
  BlockBounds bounds_;
  Eigen::Vector3f origin_;
  float nearest_m_, farthest_m_;
  float voxel_m_;
};

constexpr std::size_t kPixelsPerBatch = RayMarcher::kMaxInterleaved * simd::kLanes;

}  // namespace

void raycast_pixels(const tsdf::TsdfLanes& field, const PinholeCamera& camera, const SE3& T_world_camera,
                    std::span<const PixelRay> pixels, const config::DepthConfig& depth,
                    const Workers& workers, std::vector<SurfacePoint>& points) {
  points.resize(pixels.size());
  const RayMarcher marcher(field, camera, T_world_camera, depth);
  workers.for_chunks(pixels.size(), kPixelsPerBatch, [&](std::size_t begin, std::size_t end) {
    std::array<RequestedRays, RayMarcher::kMaxInterleaved> lanes;
    std::array<Hits, RayMarcher::kMaxInterleaved> hits;
    for (std::size_t i = begin; i < begin + kPixelsPerBatch; ++i) {
      const PixelRay& pixel = pixels[std::min(i, end - 1)];
      RequestedRays& group = lanes[(i - begin) / simd::kLanes];
      const std::size_t lane = (i - begin) % simd::kLanes;
      group.u[lane] = static_cast<float>(pixel.u_px);
      group.v[lane] = static_cast<float>(pixel.v_px);
      group.begin_m[lane] = pixel.begin_m;
      group.end_m[lane] = pixel.end_m;
    }
    marcher.march(lanes, hits);
    for (std::size_t i = begin; i < end; ++i) {
      points[i] = surface_point(hits[(i - begin) / simd::kLanes], (i - begin) % simd::kLanes);
    }
  });
}

}  // namespace fusebench::raycast
