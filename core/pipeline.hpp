// The system of the paper, frame by frame: predict, deform and track patches, fuse, refresh patches.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/intensity_residual.hpp"
#include "core/parallel.hpp"
#include "core/tsdf_volume.hpp"
#include "core/types.hpp"

namespace fusebench {

enum class FrameStatus {
  initialised,  ///< the first frame
  tracked,      ///< the update was accepted and the frame fused
  lost,         ///< too few honest patches: the prediction was kept, the frame not fused
};
[[nodiscard]] std::string_view to_string(FrameStatus status);

/// Stages whose time is reported.
enum class Stage { preprocess, predict, update, fuse, refresh };
inline constexpr std::array<std::string_view, 5> kStageNames = {"preprocess", "predict", "update", "fuse",
                                                                "refresh"};

/// What happened in one frame.
struct FrameReport {
  std::int64_t timestamp_ns = 0;
  FrameStatus status = FrameStatus::lost;
  std::string reason;  ///< why it is lost; empty otherwise
  SE3 T_world_camera;
  Vector3d velocity_world_mps = Vector3d::Zero();
  Vector3d angular_velocity_radps = Vector3d::Zero();  ///< body frame
  int patches = 0;                                     ///< projected into this frame
  int patches_tracked = 0;                             ///< with enough usable pixels at the final pose
  int patches_accepted = 0;    ///< that also passed the chi-square gate: those the update used
  int patches_shrunk = 0;      ///< lost pixels to occlusion (shrink effect)
  int patches_extended = 0;    ///< bounding box larger than the square (extend effect)
  int pixels_photometric = 0;  ///< residuals of all levels in the update
  int pixels_geometric = 0;
  int iterations = 0;
  bool converged = false;
  double chi2_photometric = 0;  ///< mean squared whitened residual of accepted patches
  double chi2_geometric = 0;
  std::size_t model_blocks = 0;
  std::vector<IntensityResidual> intensity;           ///< of all tracked patches, by patch, then pixel
  std::array<double, kStageNames.size()> stage_ms{};  ///< wall time; the only part that is not reproducible
};

/// One run of the estimator over one recording.
class Pipeline {
 public:
  /// imu: all samples of the recording, sorted by time (empty if terms.prior does not need them); must
  /// outlive the pipeline, as must workers.
  Pipeline(const Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
           const Workers& workers);
  ~Pipeline();

  /// Processes the next frame (time must increase). A lost frame is a report, not an error; errors are IMU
  /// samples that do not cover the frame (data_corrupt) and a full model (run_failed).
  [[nodiscard]] Result<FrameReport> process(const RgbdFrame& frame);

  [[nodiscard]] const TsdfVolume& model() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench
