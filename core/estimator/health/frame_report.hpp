// Report of the filter on each frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/intensity_residual.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/health/frame_diagnosis.hpp"
#include "core/estimator/health/frame_outcome.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"
#include "core/estimator/patches/patches.hpp"

namespace fusebench::health {

/// Information of the images alone on the pose of a frame, given the reference frame of the patches and the
/// model: quadratic cost in d for T_world_imu * d. Used by batch estimators.
struct PoseEvidence {
  std::int64_t reference_ns = 0;  ///< capture instant of the reference frame of the patches
  SE3 T_world_imu_reference;      ///< reference pose of the patches
  SE3 T_world_imu;                ///< point of linearisation: the posterior
  filter::PoseQuadratic quadratic;
  filter::PoseTimingQuadratic timing;  ///< at the same point
};

/// Standard deviations of the pose against the model, along the least certain axis.
struct PoseCertainty {
  double rotation_sigma_rad = 0;
  double position_sigma_m = 0;
};
[[nodiscard]] PoseCertainty certainty_of(const filter::GaussianState& state);

/// Outcome of a frame with the quantities of a patch-tracking filter.
struct FrameReport : FrameOutcome {
  FrameHealth health = FrameHealth::good;
  filter::GaussianState estimate;        ///< the whole state and its covariance, after the frame
  std::optional<PoseEvidence> evidence;  ///< of tracked frames except the first
  Vector3d velocity_world_mps = Vector3d::Zero();
  Vector3d angular_velocity_radps = Vector3d::Zero();  ///< body frame
  int patches = 0;                                     ///< projected into this frame
  int patches_tracked = 0;                             ///< with enough usable pixels at the final pose
  int patches_accepted = 0;                            ///< passed the chi-square gate and used in the update
  int patches_contradicting = 0;                       ///< tracked ones whose intensities do not fit
  int patches_shrunk = 0;                              ///< lost pixels to occlusion (shrink effect)
  int patches_extended = 0;    ///< bounding box larger than the square (extend effect)
  int pixels_photometric = 0;  ///< residuals of all levels in the update
  int pixels_geometric = 0;
  int iterations = 0;
  bool converged = false;
  double chi2_photometric = 0;  ///< mean squared whitened residual of accepted patches
  double chi2_geometric = 0;
  double variance_photometric = 1;  ///< factor on the assumed variance (patch_scatter.hpp)
  double variance_geometric = 1;
  PoseCertainty certainty;     ///< after the update
  double patch_motion_px = 0;  ///< median motion of the tracked patches since their reference
  /// Median ZNCC of the tracked patches that have contrast. Not given if there are too few of them, or if the
  /// colour image is a repeated one.
  std::optional<double> correlation;
  /// Relocalised by depth alone, without trackable patches in the image: the frame is not fused.
  bool placed_by_depth = false;
  bool fused = false;    ///< into the model
  double blur_px = 0;    ///< predicted length of motion blur at the image centre
  TrackedPixels pixels;  ///< of all tracked patches, by patch, then pixel
};

/// The initial report of a frame.
[[nodiscard]] FrameReport report_of(const RgbdFrame& frame);

/// Writes the state after the frame; T_imu_camera is the mounting of the camera.
void describe_state(const filter::GaussianState& estimate, const SE3& T_imu_camera, FrameReport& report);

/// Writes the results of an update for its patches: counts, chi-squares, variances, iterations, intensity.
void describe_update(const measurement::PatchMeasurement& measurement, const filter::IekfResult& result,
                     std::span<const patches::Patch> patches, const config::HealthConfig& health,
                     const config::IekfConfig& iekf, FrameReport& report);

}  // namespace fusebench::health
