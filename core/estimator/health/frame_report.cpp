#include "core/estimator/health/frame_report.hpp"

#include <utility>

#include "core/base/upper_median.hpp"
#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/health_config.hpp"
#include "core/estimator/filter/pose_clones.hpp"

namespace fusebench::health {

namespace {

/// 0 if there are no values.
double median(std::vector<double> values) { return values.empty() ? 0 : upper_median(std::move(values)); }

}  // namespace

FrameReport report_of(const RgbdFrame& frame) {
  FrameReport report;
  report.timestamp_ns = frame.timestamp_ns;
  report.capture_ns = frame.capture_ns();
  return report;
}

void describe_state(const filter::GaussianState& estimate, const SE3& T_imu_camera, FrameReport& report) {
  report.T_world_camera = estimate.mean.T_world_imu * T_imu_camera;
  report.estimate = filter::in_first_camera_world(estimate);
  report.velocity_world_mps = estimate.mean.velocity_world_mps;
  report.angular_velocity_radps = estimate.mean.angular_velocity_imu_radps;
}

PoseCertainty certainty_of(const filter::GaussianState& state) {
  return {largest_sigma(state.covariance.block<3, 3>(filter::kRotation, filter::kRotation)),
          largest_sigma(state.covariance.block<3, 3>(filter::kPosition, filter::kPosition))};
}

void describe_update(const measurement::PatchMeasurement& measurement, const filter::IekfResult& result,
                     std::span<const patches::Patch> patches, const config::HealthConfig& health,
                     const config::IekfConfig& iekf, FrameReport& report) {
  double chi2_photometric = 0;
  double chi2_geometric = 0;
  std::vector<double> motion_px, correlations;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const patches::Patch& patch = patches[p];
    const measurement::PatchOutcome& outcome = measurement.outcomes()[p];
    report.patches += outcome.in_view ? 1 : 0;
    report.patches_tracked += outcome.tracked ? 1 : 0;
    report.patches_contradicting += outcome.contradicts_color ? 1 : 0;
    report.patches_shrunk += outcome.tracked && outcome.shrunk ? 1 : 0;
    report.patches_extended += outcome.tracked && outcome.extended ? 1 : 0;
    if (outcome.tracked && outcome.contrast_grey >= health.min_contrast_grey)
      correlations.push_back(outcome.correlation);
    if (outcome.tracked) motion_px.push_back((outcome.centre_px - patch.centre_px.cast<double>()).norm());
    if (!outcome.accepted) continue;
    ++report.patches_accepted;
    report.pixels_photometric += outcome.photometric_residuals;
    report.pixels_geometric += outcome.geometric_residuals;
    chi2_photometric += outcome.chi2_photometric;
    chi2_geometric += outcome.chi2_geometric;
  }
  if (report.pixels_photometric > 0) report.chi2_photometric = chi2_photometric / report.pixels_photometric;
  if (report.pixels_geometric > 0) report.chi2_geometric = chi2_geometric / report.pixels_geometric;
  report.patch_motion_px = median(std::move(motion_px));
  if (measurement.color_is_new() && correlations.size() >= static_cast<std::size_t>(iekf.min_patches))
    report.correlation = median(std::move(correlations));
  report.variance_photometric = measurement.photometric_variance();
  report.variance_geometric = measurement.geometric_variance();
  report.certainty = certainty_of(result.posterior);
  report.iterations = result.iterations;
  report.converged = result.converged;
  report.pixels = measurement.tracked_pixels();
}

}  // namespace fusebench::health
