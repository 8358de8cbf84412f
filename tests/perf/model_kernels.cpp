#include "core/estimator/model/meshing/marching_cubes.hpp"
#include "core/estimator/model/tsdf/band_blocks.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/bench/model_answers.hpp"
#include "tests/perf/kernel_counts.hpp"

namespace fusebench::perf {

using namespace tsdf;
using namespace raycast;
using namespace meshing;

namespace {

void count_band_blocks(KernelCounts& counts, const testing::BenchScene& scene, const Workers& workers) {
  BandBlocks band;
  counts.count(
      "band_blocks", "block",
      [&] {
        band.find(scene.frame.depth_m, scene.camera, scene.T_world_camera,
                  kBlockSide * scene.config.tsdf.voxel_m, scene.config.tsdf, scene.config.depth, 0, workers);
      },
      [&] {
        for (const BlockIndex& block : band.blocks())
          check(scene.model.find_block(block) >= 0, "blocks are those that the frame was fused into");
        return band.blocks().size();
      });
}

/// A frame into a model that has its blocks already, as most frames are.
void count_integrate(KernelCounts& counts, const testing::BenchScene& scene, const Workers& workers) {
  TsdfVolume model = scene.model;
  bool fused = false;
  counts.count(
      "integrate", "pixel",
      [&] {
        fused = model.integrate(scene.frame, scene.camera, scene.T_world_camera, scene.config.depth, workers)
                    .has_value();
      },
      [&] {
        check(fused && testing::is_zero_on_surface(model, scene), "the field is zero on the surface");
        return scene.frame.depth_m.data.size();
      });
}

void count_rays(KernelCounts& counts, const testing::BenchScene& scene, const Workers& workers,
                std::string_view kernel, const std::vector<PixelRay>& rays) {
  std::vector<SurfacePoint> points;
  counts.count(
      kernel, "pixel",
      [&] {
        testing::raycast_pixels(scene.model, scene.camera, scene.T_world_camera, rays, scene.config.depth,
                                workers, points);
      },
      [&] {
        testing::DepthCheck depth(scene);
        depth.add(rays, points);
        check(depth.passed(), "depth is that of the room");
        return points.size();
      });
}

void count_meshing(KernelCounts& counts, const testing::BenchScene& scene, const Workers& workers) {
  Mesh mesh;
  counts.count(
      "extract_mesh", "triangle", [&] { mesh = extract_mesh(scene.model, 1.0, workers); },
      [&] {
        check(testing::is_zero_level(mesh, scene.model), "the mesh is the zero level of the field");
        return mesh.triangles.size();
      });
}

}  // namespace

void count_model_kernels(KernelCounts& counts, const testing::BenchScene& scene) {
  const Workers workers(1);
  count_band_blocks(counts, scene, workers);
  count_integrate(counts, scene, workers);
  count_rays(counts, scene, workers, "raycast_patches", testing::patch_pixels(scene.camera));
  count_rays(counts, scene, workers, "raycast_image", testing::image_rays(scene.camera));
  count_meshing(counts, scene, workers);
}

}  // namespace fusebench::perf
