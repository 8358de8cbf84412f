#include "core/raycast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/tsdf_sampler.hpp"

namespace fusebench {
namespace {

constexpr std::size_t kPixelsPerChunk = 256;
constexpr std::size_t kRowsPerChunk = 4;
// Seen from the side, the field overstates the distance; a step of less than its value rarely jumps the
// surface, and where it jumps into the unknown, the walk repeats it in fine steps.
constexpr double kStepShare = 0.8;
constexpr double kFineStep_voxels = 0.5;
// The crossing is found when it is known to this, or the field is this close to zero.
constexpr double kBracket_voxels = 0.05;
constexpr double kZero_voxels = 0.005;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The ray of a pixel by z-depth: point(z) = origin + z * direction.
struct Ray {
  Ray(const Vector3d& origin, const Vector3d& direction)
      : origin_world(origin), direction_world(direction), z_per_m(1.0 / direction.norm()) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      // Parallel to a face: it is left after an astronomic way, a number rather than the NaN of 0 * infinity.
      inverse[axis] = direction[axis] == 0.0 ? 1e300 : 1.0 / direction[axis];
    }
  }

  [[nodiscard]] Vector3d at(double z_m) const { return origin_world + z_m * direction_world; }

  // How much z-depth a point on the ray has left in the cube with this index and side; the point is in units
  // of the side.
  [[nodiscard]] double z_to_leave(const Vector3d& point, const Eigen::Vector3i& cube, double side_m) const {
    double sides = std::numeric_limits<double>::infinity();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double face = cube[axis] + (direction_world[axis] >= 0.0 ? 1 : 0);
      sides = std::min(sides, (face - point[axis]) * inverse[axis]);
    }
    return sides * side_m;
  }

  Vector3d origin_world;
  Vector3d direction_world;  // per metre of z-depth, so longer than 1 off the axis
  double z_per_m;
  Vector3d inverse;
};

// Casts rays of one camera one after the other.
class RayCaster {
 public:
  RayCaster(const TsdfVolume& volume, const PinholeCamera& camera, const SE3& T_world_camera,
            const DepthConfig& depth)
      : sampler_(volume),
        camera_(camera),
        axes_world_(T_world_camera.rotation_matrix()),
        origin_world_(T_world_camera.translation),
        depth_(depth),
        voxel_m_(volume.voxel_m()),
        reach_m_(volume.reach_m()) {}

  [[nodiscard]] SurfacePoint cast(double u_px, double v_px) {
    const Ray ray(origin_world_, axes_world_ * camera_.back_project(u_px, v_px, 1.0));
    if (!(ray.at(depth_.max_m).cwiseAbs().maxCoeff() < reach_m_)) return {};  // also without a finite pose
    const std::optional<double> z_m = first_crossing(ray);
    if (!z_m) return {};
    const Vector3d gradient = sampler_.gradient_at(ray.at(*z_m));
    // The crossing goes into the surface; a gradient along the ray is noise at a rim, and no normal.
    if (!(gradient.dot(ray.direction_world) < 0.0)) return {};
    return {true, *z_m, gradient.normalized()};
  }

 private:
  // Two points of a ray with the surface between them: the field is + in front, - behind.
  struct Bracket {
    double front_z_m;
    double front_m;  // field
    double back_z_m;
    double back_m;
  };

  // Walks from front to back until the field changes from + to - between two neighbouring observed samples.
  [[nodiscard]] std::optional<double> first_crossing(const Ray& ray) {
    const double fine_z = kFineStep_voxels * voxel_m_ * ray.z_per_m;
    double z_m = depth_.min_m;
    double free_z_m = kNone;  // of the sample before, if it was observed and in front of a surface
    double free_m = 0;        // field there
    while (z_m <= depth_.max_m) {
      const Vector3d point = ray.at(z_m);
      const double empty_z = z_of_empty_space(ray, point);
      const TsdfSample sample = empty_z > 0.0 ? TsdfSample{} : sampler_.sample(point);
      if (!std::isnan(free_z_m)) {
        if (sample.valid && sample.distance_m < 0.0)
          return refine(ray, {free_z_m, free_m, z_m, sample.distance_m});
        if (!sample.valid) {
          const std::optional<double> jumped = crossing_between(ray, free_z_m, free_m, z_m);
          if (jumped) return jumped;
        }
      }
      free_z_m = sample.valid && sample.distance_m >= 0.0 ? z_m : kNone;
      free_m = sample.distance_m;
      z_m += std::max({fine_z, empty_z, kStepShare * std::abs(sample.distance_m) * ray.z_per_m});
    }
    return std::nullopt;
  }

  // The same in fine steps behind a free sample, as far as the field was observed.
  [[nodiscard]] std::optional<double> crossing_between(const Ray& ray, double free_z_m, double free_m,
                                                       double end_z_m) {
    const double fine_z = kFineStep_voxels * voxel_m_ * ray.z_per_m;
    for (double z_m = free_z_m + fine_z; z_m < end_z_m; z_m += fine_z) {
      const TsdfSample sample = sampler_.sample(ray.at(z_m));
      if (!sample.valid) break;
      if (sample.distance_m < 0.0) return refine(ray, {z_m - fine_z, free_m, z_m, sample.distance_m});
      free_m = sample.distance_m;
    }
    return std::nullopt;
  }

  // How much z-depth a ray can skip at a point: what is left of its region or its block if nothing is
  // allocated there, or 0.
  [[nodiscard]] double z_of_empty_space(const Ray& ray, const Vector3d& point) {
    const double block_m = kBlockSide * voxel_m_;
    const Vector3d in_blocks = point * (1.0 / block_m);
    const BlockIndex block(static_cast<int>(std::floor(in_blocks.x())),
                           static_cast<int>(std::floor(in_blocks.y())),
                           static_cast<int>(std::floor(in_blocks.z())));
    const Eigen::Vector3i region = region_of(block);
    if (!sampler_.has_region(region)) {
      return ray.z_to_leave(in_blocks * (1.0 / kRegionSide), region, kRegionSide * block_m);
    }
    return sampler_.block(block) == nullptr ? ray.z_to_leave(in_blocks, block, block_m) : 0.0;
  }

  // Alternates the zero of the chord, which is close where the field is smooth, with the middle, which always
  // helps.
  [[nodiscard]] std::optional<double> refine(const Ray& ray, Bracket bracket) {
    const double enough_z = kBracket_voxels * voxel_m_ * ray.z_per_m;
    for (bool chord = true; bracket.back_z_m - bracket.front_z_m > enough_z; chord = !chord) {
      const double z_m = chord ? zero_of_chord(bracket) : 0.5 * (bracket.front_z_m + bracket.back_z_m);
      const TsdfSample sample = sampler_.sample(ray.at(z_m));
      if (!sample.valid) return std::nullopt;
      if (std::abs(sample.distance_m) < kZero_voxels * voxel_m_) return z_m;
      if (sample.distance_m < 0.0) {
        bracket.back_z_m = z_m;
        bracket.back_m = sample.distance_m;
      } else {
        bracket.front_z_m = z_m;
        bracket.front_m = sample.distance_m;
      }
    }
    return zero_of_chord(bracket);
  }

  static double zero_of_chord(const Bracket& bracket) {
    const double share = bracket.front_m / (bracket.front_m - bracket.back_m);
    return bracket.front_z_m + share * (bracket.back_z_m - bracket.front_z_m);
  }

  TsdfSampler sampler_;
  const PinholeCamera& camera_;
  Matrix3d axes_world_;
  Vector3d origin_world_;
  const DepthConfig& depth_;
  double voxel_m_;
  double reach_m_;
};

}  // namespace

SurfacePoint raycast_pixel(const TsdfVolume& volume, const PinholeCamera& camera, const SE3& T_world_camera,
                           double u_px, double v_px, const DepthConfig& depth) {
  return RayCaster(volume, camera, T_world_camera, depth).cast(u_px, v_px);
}

std::vector<SurfacePoint> raycast_pixels(const TsdfVolume& volume, const PinholeCamera& camera,
                                         const SE3& T_world_camera, const std::vector<Vector2d>& pixels_px,
                                         const DepthConfig& depth, const Workers& workers) {
  std::vector<SurfacePoint> points(pixels_px.size());
  workers.for_chunks(pixels_px.size(), kPixelsPerChunk, [&](std::size_t begin, std::size_t end) {
    RayCaster caster(volume, camera, T_world_camera, depth);
    for (std::size_t i = begin; i < end; ++i) points[i] = caster.cast(pixels_px[i].x(), pixels_px[i].y());
  });
  return points;
}

SurfaceImage raycast_image(const TsdfVolume& volume, const PinholeCamera& camera, const SE3& T_world_camera,
                           const DepthConfig& depth, const Workers& workers) {
  SurfaceImage image = {DepthImage(camera.width_px, camera.height_px),
                        Image<Eigen::Vector3f>(camera.width_px, camera.height_px, Eigen::Vector3f::Zero())};
  const auto rows = static_cast<std::size_t>(camera.height_px);
  workers.for_chunks(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    RayCaster caster(volume, camera, T_world_camera, depth);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < camera.width_px; ++x) {
        const SurfacePoint point = caster.cast(x, y);
        if (!point.valid) continue;
        image.depth_m(x, y) = static_cast<float>(point.depth_m);
        image.normal_world(x, y) = point.normal_world.cast<float>();
      }
    }
  });
  return image;
}

}  // namespace fusebench
