#include "eval/run/batch_estimation/measured_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "core/config/config.hpp"
#include "core/config/variants.hpp"
#include "core/recording_estimator.hpp"
#include "eval/run/frame_source.hpp"

namespace fusebench::batch_estimation {

namespace {

/// The poses that the images said, by instant; motions are between them.
class MotionCollector {
 public:
  MotionCollector(MeasuredMotion& measured, const SE3& T_imu_camera)
      : measured_(measured), T_imu_camera_(T_imu_camera) {}

  void take(const health::FrameReport& report) {
    const std::size_t frame = measured_.stamps_ns.size();
    measured_.stamps_ns.push_back(report.timestamp_ns);
    measured_.input.instants_ns.push_back(report.capture_ns);
    measured_.input.initial.push_back(report.estimate.mean);
    measured_.tracked += health::is_in_map(report.status) ? 1U : 0U;
    // The first frame, or one that was taken anew: the world is where it was put.
    Seen seen{frame, {report.T_world_camera, Matrix6d::Zero()}};
    if (report.evidence) {
      seen.pose = smoother::visual_pose(*report.evidence, T_imu_camera_);
      const auto reference = seen_.find(report.evidence->reference_ns);
      if (reference != seen_.end()) {
        smoother::RelativeCameraMotion motion = smoother::motion_between(reference->second.pose, seen.pose);
        motion.reference = reference->second.frame;
        motion.frame = frame;
        measured_.input.visual.push_back(motion);
      }
      measured_.input.timing.push_back(smoother::visual_timing(*report.evidence));
      measured_.input.timing.back().frame = frame;
    }
    if (health::is_in_map(report.status)) seen_[report.capture_ns] = seen;
  }

 private:
  struct Seen {
    std::size_t frame = 0;
    smoother::VisualPose pose;
  };

  MeasuredMotion& measured_;
  const SE3 T_imu_camera_;
  std::map<std::int64_t, Seen> seen_;
};

}  // namespace

Result<MeasuredMotion> measure_motion(const recording::Recording& recording, const config::Config& config,
                                      const Workers& workers, const run::RunControl& control) {
  check(config::needs_imu(config), "the prior is the IMU");
  MeasuredMotion measured;
  measured.input.imu = recording.imu;
  measured.input.imu_noise = recording.rig.imu_noise;
  measured.input.T_imu_camera = recording.rig.T_imu_camera;
  MotionCollector collector(measured, recording.rig.T_imu_camera);
  // With an IMU of so little weight nothing would contradict a place that only looks like another.
  config::Config measuring = config;
  measuring.terms.relocalisation = false;
  core::RecordingEstimator pipeline(measuring, recording.rig, recording.imu, workers);
  run::FrameSource source(recording, workers.threads() > 1);
  int lost_in_a_row = 0;
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    if (control.is_stopped()) return fail(ErrorCode::run_failed, "stopped by the user");
    const auto loaded = source.next();
    if (!loaded) return tl::unexpected(loaded.error());
    const auto report = pipeline.process(loaded->frame);
    if (!report) {
      return fail(report.error().code, fmt::format("frame {}: {}", frame, report.error().message),
                  report.error().hint);
    }
    lost_in_a_row = report->reason.empty() ? 0 : lost_in_a_row + 1;  // also a start that failed before
    if (lost_in_a_row > config.iekf.max_lost_frames) {
      return fail(ErrorCode::run_failed,
                  fmt::format("lost at frame {}: {} (iekf.max_lost_frames = {})",
                              frame + 1 - static_cast<std::size_t>(lost_in_a_row), report->reason,
                              config.iekf.max_lost_frames),
                  "choose frames that are tracked with --frames A:B");
    }
    collector.take(*report);
    if (control.progress) control.progress(frame + 1, recording.frames.size());
  }
  return measured;
}

}  // namespace fusebench::batch_estimation
