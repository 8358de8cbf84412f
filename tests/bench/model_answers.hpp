// Whether rays met the surface that they should have, and voxels became what they should have, for the
// programs that measure the model's kernels; and how much of the field these cannot do without.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/estimator/model/tsdf/band_blocks.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/support/felt_blocks.hpp"
#include "tests/support/plain_field.hpp"
#include "tests/support/plain_voxel_update.hpp"
#include "tests/support/raycast_image.hpp"

namespace fusebench::testing {

/// Surface points against the rendered truth: found almost everywhere, and nearly all of them within a voxel
/// (at the edges of the furniture the model is rounded).
class DepthCheck {
 public:
  explicit DepthCheck(const BenchScene& scene) : scene_(scene) {}
  void add(int x, int y, double depth_m) {
    ++asked_;
    if (depth_m <= 0) return;
    ++found_;
    const double error_m = std::abs(depth_m - static_cast<double>(scene_.frame.depth_m(x, y)));
    if (error_m < scene_.config.tsdf.voxel_m) ++close_;
  }
  void add(const std::vector<raycast::PixelRay>& pixels, const std::vector<raycast::SurfacePoint>& points) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      add(static_cast<int>(pixels[i].u_px), static_cast<int>(pixels[i].v_px),
          points[i].valid ? points[i].depth_m : 0.0);
    }
  }
  [[nodiscard]] bool passed() const { return found_ > 0.9 * asked_ && close_ > 0.97 * found_; }

 private:
  const BenchScene& scene_;
  double asked_ = 0;
  double found_ = 0;
  double close_ = 0;
};

/// The pixels of 100 patches of 10x10.
inline std::vector<raycast::PixelRay> patch_pixels(const PinholeCamera& camera) {
  std::vector<raycast::PixelRay> pixels;
  for (int patch = 0; patch < 100; ++patch) {
    const int x0 = (patch % 10 + 1) * camera.width_px / 12;
    const int y0 = (patch / 10 + 1) * camera.height_px / 12;
    for (int i = 0; i < 100; ++i)
      pixels.push_back({static_cast<double>(x0 + i % 10), static_cast<double>(y0 + i / 10)});
  }
  return pixels;
}

/// Rays felt along in small steps, without any cleverness.
class PlainRays {
 public:
  explicit PlainRays(const BenchScene& scene) : scene_(scene), field_(scene.model) {}

  /// z-depth of the first change from front to back of the trilinear field; 0 = none.
  [[nodiscard]] double depth_m(const raycast::PixelRay& ray) {
    const double length = scene_.camera.back_project(ray.u_px, ray.v_px, 1.0).norm();
    const double step_m = kStep_voxels * scene_.model.voxel_m() / length;
    const double end_m = std::min(static_cast<double>(ray.end_m), scene_.config.depth.max_m);
    double before_m = std::nan("");
    for (double z_m = std::max(static_cast<double>(ray.begin_m), scene_.config.depth.min_m); z_m <= end_m;
         z_m += step_m) {
      const Vector3d point_world =
          scene_.T_world_camera * scene_.camera.back_project(ray.u_px, ray.v_px, z_m);
      const double now_m = field_.distance_m(point_world).value_or(std::nan(""));
      if (before_m >= 0 && now_m < 0) return z_m - step_m * now_m / (now_m - before_m);
      before_m = now_m;
    }
    return 0;
  }

  /// Whether that is what another cast found, for every so many-th of its rays: nearly always, since where
  /// the field is torn, what is first is a matter of steps.
  [[nodiscard]] bool agree(const std::vector<raycast::PixelRay>& rays,
                           const std::vector<raycast::SurfacePoint>& points, std::size_t every) {
    std::size_t asked = 0;
    std::size_t found = 0;
    std::size_t same = 0;
    for (std::size_t i = 0; i < rays.size(); i += every) {
      const double expected_m = depth_m(rays[i]);
      const double found_m = points[i].valid ? points[i].depth_m : 0.0;
      ++asked;
      found += found_m > 0 ? 1 : 0;
      same += std::abs(found_m - expected_m) < kSame_voxels * scene_.model.voxel_m() ? 1U : 0U;
    }
    return 2 * found > asked && static_cast<double>(same) > 0.95 * static_cast<double>(asked);
  }

 private:
  static constexpr double kStep_voxels = 0.2;
  static constexpr double kSame_voxels = 0.1;

  const BenchScene& scene_;
  PlainField field_;
};

/// The voxels between which surface points lie, each counted once: what rays have to read at the least.
inline std::size_t voxels_around(const BenchScene& scene, const std::vector<raycast::PixelRay>& rays,
                                 const std::vector<raycast::SurfacePoint>& points) {
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!points[i].valid) continue;
    const Vector3d at_voxels = scene.T_world_camera *
                               scene.camera.back_project(rays[i].u_px, rays[i].v_px, points[i].depth_m) /
                               scene.model.voxel_m();
    const tsdf::VoxelIndex base = at_voxels.array().floor().cast<int>();
    for (int corner = 0; corner < 8; ++corner) {
      std::uint64_t key = 0;
      for (int axis = 0; axis < 3; ++axis)
        key = key << 21 | (static_cast<std::uint64_t>(base[axis] + ((corner >> axis) & 1)) & 0x1FFFFF);
      keys.push_back(key);
    }
  }
  std::ranges::sort(keys);
  return static_cast<std::size_t>(std::ranges::unique(keys).begin() - keys.begin());
}

/// On a surface that was fused the field is zero, within a voxel, wherever it can be interpolated.
inline bool is_zero_on_surface(const tsdf::TsdfVolume& model, const BenchScene& scene) {
  PlainField field(model);
  double error_m = 0;
  int sampled = 0;
  for (const raycast::PixelRay& pixel : patch_pixels(scene.camera)) {
    const double depth_m =
        static_cast<double>(scene.frame.depth_m(static_cast<int>(pixel.u_px), static_cast<int>(pixel.v_px)));
    if (!(depth_m > 0)) continue;
    const auto distance_m =
        field.distance_m(scene.T_world_camera * scene.camera.back_project(pixel.u_px, pixel.v_px, depth_m));
    if (!distance_m) continue;
    ++sampled;
    error_m += std::abs(*distance_m);
  }
  return sampled > 5000 && error_m < sampled * scene.config.tsdf.voxel_m;
}

/// The blocks around the frame's measurements: nearly all that are felt for along its rays, and not many
/// more.
inline bool are_band_blocks(const std::vector<tsdf::BlockIndex>& found, const BenchScene& scene) {
  constexpr int kEvery_px = 4;
  const BlockSet blocks = block_set(found);
  const BlockSet felt = felt_blocks(scene.frame.depth_m, scene.camera, scene.T_world_camera,
                                    tsdf::kBlockSide * scene.config.tsdf.voxel_m, scene.config.tsdf,
                                    scene.config.depth, kEvery_px);
  return blocks.size() == found.size() && felt.size() > 100 &&
         static_cast<double>(missing(felt, blocks)) < 0.05 * static_cast<double>(felt.size()) &&
         static_cast<double>(missing(blocks, felt)) < 0.25 * static_cast<double>(blocks.size());
}

/// What the frame did to a model.
struct FusedVoxels {
  bool as_plain = true;  ///< as plain formulas say, voxel by voxel
  std::size_t blocks = 0;
  std::size_t updated = 0;  ///< voxels
  std::size_t colored = 0;  ///< of them
};

inline PlainBlock stored_block(const tsdf::TsdfVolume& model, const tsdf::BlockIndex& index) {
  PlainBlock block;
  const int slot = model.find_block(index);
  for (std::size_t i = 0; slot >= 0 && i < block.size(); ++i)
    block[i] = model.voxel(static_cast<std::size_t>(slot), i);
  return block;
}

inline bool is_same_voxel(const tsdf::Voxel& a, const tsdf::Voxel& b) {
  // A last digit may round to the next number of eleven bits.
  constexpr float kDigit = 1.0F / 1024.0F;
  constexpr float kDistance_m = 1e-5F;
  const auto is_same = [](float p, float q, float beside) {
    return std::abs(p - q) <= kDigit * std::abs(p) + beside;
  };
  if (a.weight == 0.0F || b.weight == 0.0F) return a.weight == b.weight;
  bool same = is_same(a.distance_m, b.distance_m, kDistance_m) && is_same(a.weight, b.weight, 0.0F) &&
              a.color_count == b.color_count;
  for (std::size_t channel = 0; channel < 3; ++channel)
    same = same && std::abs(a.color[channel] - b.color[channel]) <= 1;
  return same;
}

/// before, after: the model without and with the frame.
inline FusedVoxels fused_voxels(const tsdf::TsdfVolume& before, const tsdf::TsdfVolume& after,
                                const BenchScene& scene) {
  tsdf::BandBlocks band;
  band.find(scene.frame.depth_m, scene.camera, scene.T_world_camera,
            tsdf::kBlockSide * scene.config.tsdf.voxel_m, scene.config.tsdf, scene.config.depth,
            before.frame_count(), Workers(1));
  const PlainVoxelUpdate update(scene.frame, scene.camera, scene.T_world_camera, scene.config.depth,
                                scene.config.tsdf, before.frame_count());
  FusedVoxels fused;
  fused.blocks = band.blocks().size();
  std::size_t different = 0;
  for (const tsdf::BlockIndex& index : band.blocks()) {
    const PlainBlock old = stored_block(before, index);
    const PlainBlock now = stored_block(after, index);
    PlainBlock plain = old;
    update.apply(index, plain);
    for (std::size_t i = 0; i < plain.size(); ++i) {
      fused.updated += plain[i].weight != old[i].weight ? 1U : 0U;
      fused.colored += plain[i].color_count != old[i].color_count ? 1U : 0U;
      different += is_same_voxel(plain[i], now[i]) ? 0U : 1U;
    }
  }
  // A last digit may put a voxel into the pixel beside its own.
  fused.as_plain = fused.updated > 10'000 && 10'000 * different < fused.updated;
  return fused;
}

/// Vertices lie where the field crosses zero, and triangles have corners.
inline bool is_zero_level(const Mesh& mesh, const tsdf::TsdfVolume& model) {
  if (mesh.triangles.size() <= 1000) return false;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= mesh.vertices.size()) return false;
    }
  }
  PlainField field(model);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    if (std::abs(field.distance_m(vertex.cast<double>()).value_or(0.0)) >= 1e-4) return false;
  }
  return true;
}

}  // namespace fusebench::testing
