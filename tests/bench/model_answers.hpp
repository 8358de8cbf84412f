// Whether rays met the surface that they should have, for the programs that measure the model's kernels.
#pragma once

#include <cmath>
#include <vector>

#include "core/raycast.hpp"
#include "tests/bench/bench_scene.hpp"

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
  void add(const std::vector<PixelRay>& pixels, const std::vector<SurfacePoint>& points) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      add(static_cast<int>(pixels[i].u_px), static_cast<int>(pixels[i].v_px),
          points[i].valid ? points[i].depth_m : 0.0);
    }
  }
  void add(const DepthImage& depth_m) {
    for (int y = 0; y < depth_m.height; ++y) {
      for (int x = 0; x < depth_m.width; ++x) add(x, y, static_cast<double>(depth_m(x, y)));
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
inline std::vector<PixelRay> patch_pixels(const PinholeCamera& camera) {
  std::vector<PixelRay> pixels;
  for (int patch = 0; patch < 100; ++patch) {
    const int x0 = (patch % 10 + 1) * camera.width_px / 12;
    const int y0 = (patch / 10 + 1) * camera.height_px / 12;
    for (int i = 0; i < 100; ++i)
      pixels.push_back({static_cast<double>(x0 + i % 10), static_cast<double>(y0 + i / 10)});
  }
  return pixels;
}

/// On a surface that was fused the field is zero, within a voxel, wherever it can be interpolated.
inline bool is_zero_on_surface(const TsdfVolume& model, const BenchScene& scene) {
  double error_m = 0;
  int sampled = 0;
  for (const PixelRay& pixel : patch_pixels(scene.camera)) {
    const double depth_m =
        static_cast<double>(scene.frame.depth_m(static_cast<int>(pixel.u_px), static_cast<int>(pixel.v_px)));
    const TsdfSample sample =
        model.sample(scene.T_world_camera * scene.camera.back_project(pixel.u_px, pixel.v_px, depth_m));
    if (!sample.valid) continue;
    ++sampled;
    error_m += std::abs(sample.distance_m);
  }
  return sampled > 5000 && error_m < sampled * scene.config.tsdf.voxel_m;
}

/// Vertices lie where the field crosses zero, and triangles have corners.
inline bool is_zero_level(const Mesh& mesh, const TsdfVolume& model) {
  if (mesh.triangles.size() <= 1000) return false;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= mesh.vertices.size()) return false;
    }
  }
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const TsdfSample sample = model.sample(vertex.cast<double>());
    if (sample.valid && std::abs(sample.distance_m) >= 1e-4) return false;
  }
  return true;
}

}  // namespace fusebench::testing
