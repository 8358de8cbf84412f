// What the filter says of each frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/intensity_residual.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/filter/iekf.hpp"
#include "core/health/frame_diagnosis.hpp"
#include "core/health/frame_outcome.hpp"
#include "core/measurement/patch_measurement.hpp"
#include "core/patches/patches.hpp"

namespace fusebench::health {

/// What the images alone say about the pose of a frame, given the frame that its patches were cut from and
/// the model: cost(T_world_imu * d) = information and gradient around the pose. Batch estimators use it.
struct PoseEvidence {
  std::int64_t reference_ns = 0;  ///< capture instant of the frame that the patches were cut from
  SE3 T_world_imu_reference;      ///< the pose that they were cut at
  SE3 T_world_imu;                ///< where the quadratic was taken: the posterior
  filter::PoseQuadratic quadratic;
  filter::PoseTimingQuadratic timing;  ///< there
};

/// Standard deviations of the pose against the model, along the axis that it is least certain of.
struct PoseCertainty {
  double rotation_sigma_rad = 0;
  double position_sigma_m = 0;
};
[[nodiscard]] PoseCertainty certainty_of(const filter::GaussianState& state);

/// What happened in one frame, as only a filter that tracks patches can tell.
struct FrameReport : FrameOutcome {
  FrameHealth health = FrameHealth::good;
  filter::GaussianState estimate;        ///< the whole state and its covariance, after the frame
  std::optional<PoseEvidence> evidence;  ///< of tracked frames but the first
  Vector3d velocity_world_mps = Vector3d::Zero();
  Vector3d angular_velocity_radps = Vector3d::Zero();  ///< body frame
  int patches = 0;                                     ///< projected into this frame
  int patches_tracked = 0;                             ///< with enough usable pixels at the final pose
  int patches_accepted = 0;       ///< that also passed the chi-square gate: those the update used
  int patches_contradicting = 0;  ///< tracked ones whose intensities do not fit
  int patches_shrunk = 0;         ///< lost pixels to occlusion (shrink effect)
  int patches_extended = 0;       ///< bounding box larger than the square (extend effect)
  int pixels_photometric = 0;     ///< residuals of all levels in the update
  int pixels_geometric = 0;
  int iterations = 0;
  bool converged = false;
  double chi2_photometric = 0;  ///< mean squared whitened residual of accepted patches
  double chi2_geometric = 0;
  double variance_photometric = 1;  ///< factor on the claimed variance (patch_scatter.hpp)
  double variance_geometric = 1;
  PoseCertainty certainty;     ///< after the update
  double patch_motion_px = 0;  ///< median distance that the tracked patches moved since their reference
  /// Median ZNCC of the tracked patches with their reference, of those with contrast; nothing if there are
  /// too few of these, or the colour is a repeated one.
  std::optional<double> correlation;
  /// Relocalised by depth alone, with images in which no patch can be tracked: the frame is not fused.
  bool placed_by_depth = false;
  bool fused = false;    ///< into the model
  double blur_px = 0;    ///< predicted length of motion blur at the image centre
  TrackedPixels pixels;  ///< of all tracked patches, by patch, then pixel
};

/// The report of a frame of which nothing is known yet.
[[nodiscard]] FrameReport report_of(const RgbdFrame& frame);

/// Fills in the state after the frame: of the IMU that the camera is mounted to.
void describe_state(const filter::GaussianState& estimate, const SE3& T_imu_camera, FrameReport& report);

/// Fills in what an update says of its patches: counts, chi-squares, variances, iterations, intensity.
void describe_update(const measurement::PatchMeasurement& measurement, const filter::IekfResult& result,
                     std::span<const patches::Patch> patches, const config::HealthConfig& health,
                     const config::IekfConfig& iekf, FrameReport& report);

}  // namespace fusebench::health
