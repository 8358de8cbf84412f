#include "tests/bench/bench_scene.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <utility>

#include "core/base/trajectory/trajectory.hpp"
#include "core/config/config.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"
#include "core/recording_estimator.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/synthetic_imu/synthetic_imu.hpp"
#include "tests/support/camera_velocity.hpp"
#include "tests/support/rolling_shutter.hpp"

namespace fusebench::testing {

using namespace simd;
using namespace trajectory;
using namespace preprocessing;
using namespace health;
using namespace core;
using namespace synthetic_imu;
using namespace datasets;

namespace {

constexpr std::size_t kRecordedViews = 30;

void make_room(int width_px, BenchScene& scene) {
  const TexturedRoom room;
  const Workers workers(1);  // more would leave threads behind that take turns with what is measured
  scene.kind = SceneKind::room;
  scene.config.patches.fast_threshold = 2;  // the room's texture is soft, more so in larger images
  const double focal_px = 0.75 * width_px;
  const int height_px = width_px * 3 / 4;
  scene.camera = {width_px, height_px, focal_px, focal_px, 0.5 * (width_px - 1), 0.5 * (height_px - 1)};
  scene.timing = {.color_readout_s = 0.026, .depth_readout_s = 0.026, .depth_delay_s = 0.01};
  scene.velocity = {{0.5, 1.8, -0.7}, {0.3, -0.2, 0.1}};
  for (int view = 0; view < 3; ++view) {
    scene.T_world_camera = {so3_exp({0.02 * view, -0.03 * view, 0.01 * view}),
                            {0.03 * view, 0.0, -0.02 * view}};
    scene.frame = room.render(scene.camera, scene.T_world_camera, view);
    const auto fused =
        scene.model.integrate(scene.frame, scene.camera, scene.T_world_camera, scene.config.depth, workers);
    check(fused.has_value(), "the scene fits into the model");
    scene.views.push_back({scene.frame.grey, scene.frame.depth_m, scene.T_world_camera});
  }
  scene.ungated_depth_m = scene.frame.depth_m;
  scene.sensed = render_rolling(room, scene.camera, scene.timing, [&](double after_s) {
    return scene.T_world_camera *
           SE3{so3_exp(after_s * scene.velocity.angular_radps), after_s * scene.velocity.linear_mps};
  });
}

/// The tracker is where the ground truth is, from the first camera on.
bool is_near_truth(const SE3& T_first_camera, const Trajectory& truth, std::int64_t first_ns,
                   std::int64_t now_ns) {
  constexpr std::int64_t kMostGap_ns = 100'000'000;
  const auto first = interpolate_pose(truth, first_ns, kMostGap_ns);
  const auto now = interpolate_pose(truth, now_ns, kMostGap_ns);
  if (!first || !now) return false;
  const SE3 error = (first->inverse() * *now).inverse() * T_first_camera;
  return error.translation.norm() < 0.05 && rotation_angle_rad(error.rotation, {1, 0, 0, 0}) < radians(3);
}

/// At the poses that the estimator finds. The ground truth is a reference for trajectories, not for pixels
/// (docs/datasets.md): frames fused at its poses make a model that patches fit worse than in any run.
void make_recording(BenchScene& scene) {
  const auto folder = recorded_folder();
  check(folder.has_value(), "the recording is there");
  auto recording = open_recording(*folder);
  check(recording.has_value() && add_synthetic_imu(*recording).has_value(), "the recording can be opened");
  scene.kind = SceneKind::recording;
  scene.camera = recording->rig.camera;
  scene.timing = recording->rig.timing;
  const Workers workers(1);
  config::Config config;
  config.patches = scene.config.patches;
  config.depth = scene.config.depth;
  config.tsdf = scene.config.tsdf;
  RecordingEstimator pipeline(config, recording->rig, recording->imu, workers);
  std::int64_t first_ns = 0;
  for (std::size_t i = 0; i <= kRecordedViews; ++i) {
    if (i == kRecordedViews) scene.model = pipeline.model();
    auto sensed = recording->load_frame(i);
    check(sensed.has_value(), "the recording's frames can be read");
    const auto report = pipeline.process(*sensed);
    check(report.has_value() && report->status != FrameStatus::lost, "the recording is tracked");
    if (i == 0) first_ns = sensed->capture_ns();
    scene.T_world_camera = report->T_world_camera;
    scene.velocity = camera_velocity(*report, recording->rig.T_imu_camera);
    scene.sensed = std::move(*sensed);
    compensate_motion(scene.sensed, scene.camera, scene.frame_timing(), scene.velocity, workers, scene.frame);
    compensate_color(scene.sensed, scene.camera, scene.frame_timing(), scene.velocity, scene.frame.depth_m,
                     workers, scene.frame.color);
    scene.ungated_depth_m = scene.frame.depth_m;
    gate_depth(scene.ungated_depth_m, scene.config.depth, scene.frame.depth_m);
    if (i < kRecordedViews)
      scene.views.push_back({scene.frame.grey, scene.frame.depth_m, scene.T_world_camera});
  }
  check(is_near_truth(scene.T_world_camera, recording->ground_truth, first_ns, scene.sensed.capture_ns()),
        "the recording is tracked to where it was");
}

}  // namespace

Result<std::filesystem::path> recorded_folder() {
  const char* const data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) return fail(ErrorCode::data_missing, "FUSEBENCH_DATA is not set");
  const auto folder = std::filesystem::path(data) / "rgbd_dataset_freiburg1_rpy_first240";
  if (!std::filesystem::exists(folder))
    return fail(ErrorCode::data_missing, fmt::format("{} is not there", folder.string()));
  return folder;
}

const BenchScene& bench_scene(SceneKind kind, int width_px) {
  static std::map<std::pair<SceneKind, int>, BenchScene> scenes;
  const auto [place, added] = scenes.try_emplace({kind, width_px});
  BenchScene& scene = place->second;
  if (added && kind == SceneKind::room) make_room(width_px, scene);
  if (added && kind == SceneKind::recording) make_recording(scene);
  check(scene.camera.width_px == width_px, "recordings have the size that they have");
  return scene;
}

}  // namespace fusebench::testing
