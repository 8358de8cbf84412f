#include "tests/bench/peers/our_pipeline.hpp"

#include <numeric>

#include "core/estimator/model/meshing/marching_cubes.hpp"
#include "tests/bench/peers/cpu_stopwatch.hpp"
#include "tests/bench/peers/wall_stopwatch.hpp"
#include "tests/support/camera_velocity.hpp"

namespace fusebench::peers {

using namespace preprocessing;
using namespace tsdf;
using namespace meshing;
using namespace health;

Result<OurCost> OurPipeline::process(const RgbdFrame& frame) {
  const WallStopwatch wall;
  const CpuStopwatch cpu;
  const Result<FrameReport> report = pipeline_.process(frame);
  OurCost cost;
  cost.frame_ms = cpu.milliseconds();
  const double wall_ms = wall.milliseconds();
  if (!report) return tl::unexpected(report.error());

  const bool lost = report->status == FrameStatus::lost;
  motion_ = lost ? std::nullopt : std::optional(T_world_camera_.inverse() * report->T_world_camera);
  T_world_camera_ = report->T_world_camera;
  velocity_ = testing::camera_velocity(*report, rig_.T_imu_camera);

  // Stages are reported in wall time. With one thread that is CPU time unless something else held the core:
  // then each stage bears its share of that.
  const double cpu_of_wall = wall_ms > 0 ? cost.frame_ms / wall_ms : 1.0;
  const auto& stage_ms = report->stages.sums_ms();
  const double fuse_ms = stage_ms[static_cast<std::size_t>(Stage::fuse)];
  fused_ = fuse_ms > 0;
  cost.fusion_ms = cpu_of_wall * fuse_ms;
  cost.tracking_ms = cpu_of_wall * (std::accumulate(stage_ms.begin(), stage_ms.end(), 0.0) - fuse_ms);
  return cost;
}

FusedSurface OurPipeline::surface() const {
  constexpr double kLeastWeight = 1e-6;
  FusedSurface surface{model().block_count(), kBlockSide, {}};
  for (const auto& vertex : extract_mesh(model(), kLeastWeight, workers_).vertices)
    surface.points_world.push_back(vertex.cast<double>());
  return surface;
}

}  // namespace fusebench::peers
