// Prints the results of the vectorised kernels, as hashes of their bytes. Built twice, for the project's
// instruction set and for any x86-64 processor; both must print the same (CMakeLists.txt compares them).
#include <fmt/format.h>

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/estimator/measurement/patch_sums.hpp"
#include "core/estimator/model/meshing/marching_cubes.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "core/estimator/patches/patch_deformation.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"
#include "tests/support/gated_depth.hpp"
#include "tests/support/raycast_image.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace filter;
using namespace preprocessing;
using namespace tsdf;
using namespace meshing;
using namespace patches;
using namespace measurement;

namespace {

/// FNV-1a: enough to tell results apart.
class Bytes {
 public:
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(values.data(), values.size() * sizeof(Value));
  }
  template <class Value>
  void add(const Value& value) {
    add(&value, sizeof(value));
  }
  void add(const void* data, std::size_t size) {
    for (const char byte : std::string_view(static_cast<const char*>(data), size)) {
      hash_ = (hash_ ^ static_cast<std::uint8_t>(byte)) * 0x100000001B3ULL;
    }
  }
  void print(std::string_view kernel) const { fmt::print("{:<24} {:016x}\n", kernel, hash_); }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

const PinholeCamera kCamera{322, 241, 241.0, 239.0, 160.3, 119.8};  // neither size is a multiple of eight
const SE3 kTWorldCamera{so3_exp({0.05, -0.08, 0.03}), {0.1, -0.1, -0.4}};

RgbdFrame compensated(const RgbdFrame& frame, const Workers& workers) {
  const FrameTiming timing{.color_readout_s = 0.026, .depth_readout_s = 0.021};
  RgbdFrame result;
  const CameraVelocity velocity{{-1.2, 1.5, 0.8}, {0.5, -0.4, 0.6}};
  compensate_motion(frame, kCamera, timing, velocity, workers, result);
  compensate_color(frame, kCamera, timing, velocity, result.depth_m, workers, result.color);
  Bytes bytes;
  bytes.add(result.color.data);
  bytes.add(result.grey.data);
  bytes.add(result.depth_m.data);
  bytes.print("motion_compensation");
  return result;
}

void fuse(const RgbdFrame& frame, TsdfVolume& model, const Workers& workers) {
  for (int view = 0; view < 3; ++view) {
    const SE3 moved = kTWorldCamera * SE3{so3_exp({0.01 * view, 0.02 * view, 0}), {0.02 * view, 0, 0}};
    if (!model.integrate(frame, kCamera, moved, DepthConfig{}, workers)) return;
  }
  Bytes bytes;
  bytes.add(model.block_indices());
  for (std::size_t slot = 0; slot < model.block_count(); ++slot) {
    for (std::size_t i = 0; i < kBlockVoxels; ++i) bytes.add(model.voxel(slot, i));
  }
  bytes.print("integrate");
}

void cast(const TsdfVolume& model, const Workers& workers) {
  const testing::SurfaceImage surface =
      testing::raycast_image(model, kCamera, kTWorldCamera, DepthConfig{}, workers);
  Bytes bytes;
  bytes.add(surface.depth_m.data);
  bytes.add(surface.normal_world.data);
  bytes.print("raycast");
}

void extract(const TsdfVolume& model, const Workers& workers) {
  const Mesh mesh = extract_mesh(model, 0.5, workers);
  Bytes bytes;
  bytes.add(mesh.vertices);
  bytes.add(mesh.normals);
  bytes.add(mesh.colors);
  bytes.add(mesh.triangles);
  bytes.print("marching_cubes");
}

/// Sums of the residuals of pixels all over the image, seen from a displaced camera.
void track(const RgbdFrame& frame, const TsdfVolume& model, const Workers& workers) {
  Patch patch;
  PatchLevel& level = patch.levels.emplace_back();
  const testing::SurfaceImage surface =
      testing::raycast_image(model, kCamera, kTWorldCamera, DepthConfig{}, workers);
  for (int y = 10; y < kCamera.height_px; y += 7) {
    for (int x = 10; x < kCamera.width_px; x += 7) {
      if (surface.depth_m(x, y) <= 0) continue;
      PatchPixel& pixel = level.pixels.emplace_back();
      pixel.intensity = frame.grey(x, y);
      pixel.point_world =
          kTWorldCamera * kCamera.back_project(x, y, static_cast<double>(surface.depth_m(x, y)));
      pixel.normal_world = surface.normal_world(x, y);
    }
  }
  const Vector3d origin = kTWorldCamera.translation;
  LevelLanes lanes;
  pack(std::span(&patch, 1), 0, origin, lanes);
  const SE3 moved = kTWorldCamera * SE3{so3_exp({0.01, -0.02, 0.005}), {0.01, 0.02, -0.03}};
  const PosedLanes posed(PosedCamera(kCamera, moved, SE3{}), origin);
  warp_level(lanes.pixels, lanes.warp_points, posed, lanes.warped);
  MutualOcclusion occlusion;
  occlusion.resize(kCamera.width_px, kCamera.height_px);
  occlusion.test(lanes.warped, DepthConfig{}, ShrinkTest::depth_jump);
  test_measured_occlusion(lanes.warped, frame.depth_m, 1, 0.1, DepthConfig{});
  Bytes bytes;
  QuadraticSums sums;
  for (std::size_t i = 0; i < lanes.pixels.size(); ++i) {
    const WarpedLanes& w = lanes.warped[i];
    bytes.add(w.visible);
    const PlanePairs pairs = associate(posed, lanes.pixels[i], frame.depth_m, AssociationGates({}, {}, 1.0));
    const Float8 weight = pairs.valid ? all_lanes(1.0F) : Float8{};
    const Float8 residual = pairs.valid ? plane_residual(posed, pairs, lanes.pixels[i]) : Float8{};
    const RobustLanes robust = huber(residual * 500.0F, 0.7F);
    sums.add(plane_jacobian(posed, pairs, lanes.pixels[i]), residual, weight * robust.weight, robust.cost);
  }
  const PoseQuadratic total = sums.total();
  bytes.add(total.information);
  bytes.add(total.gradient);
  bytes.add(total.cost);
  bytes.print("residual_sums");
}

int run() {
  const Workers workers(1);
  const RgbdFrame rendered = testing::TexturedRoom{}.render(kCamera, kTWorldCamera, 0);
  RgbdFrame frame = compensated(rendered, workers);
  frame.depth_m = testing::gated_depth(frame.depth_m, DepthConfig{});
  Bytes gated;
  gated.add(frame.depth_m.data);
  gated.print("depth_gates");
  TsdfVolume model{TsdfConfig{}};
  fuse(frame, model, workers);
  cast(model, workers);
  extract(model, workers);
  track(frame, model, workers);
  return model.block_count() > 500 ? 0 : 1;
}

}  // namespace
}  // namespace fusebench

int main() { return fusebench::run(); }
