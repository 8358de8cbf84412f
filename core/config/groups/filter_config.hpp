// Options: the update by the iterated extended Kalman filter.
#pragma once

#include "core/config/groups/option_choices.hpp"

namespace fusebench::config {

/// What the update takes for its measurement.
enum class MeasurementForm { residuals, scalar_energy };
constexpr auto option_choices(MeasurementForm) {
  return choices<MeasurementForm>(
      {{"residuals", MeasurementForm::residuals}, {"scalar_energy", MeasurementForm::scalar_energy}});
}

/// The iterated extended Kalman filter (Eqs. 15-23).
struct IekfConfig {
  int max_iterations = 10;
  /// Iterations on each coarser pyramid level, at most, before the finer levels join.
  static constexpr int coarse_iterations = 2;
  bool prior_in_every_iteration = true;
  MeasurementForm measurement = MeasurementForm::residuals;
  double converged_rotation_rad = 1e-4;
  double converged_translation_m = 1e-4;
  double max_chi2_per_measurement = 9.0;
  double scatter_prior_freedom = 1.0;
  double scale_share = 0.2;
  int min_patches = 5;
  int max_lost_frames = 3000;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("max_iterations", self.max_iterations, 1, 200, "iterations of one update; 1 is the plain EKF");
    v.flag("prior_in_every_iteration", self.prior_in_every_iteration,
           "every iteration includes the distance to the prediction (MAP estimate, Bell & Cathey 1993); "
           "false: only the first iteration does, as Eq. 22 is printed");
    v.choice("measurement", self.measurement,
             "the measurement: all residuals, or their energy as one number that should be zero (Eq. 17 as "
             "printed, noise variance 1); the gradient of the energy vanishes at its minimum, so the update "
             "has no information there");
    v.number("converged_rotation_rad", self.converged_rotation_rad, 0.0, 1.0,
             "the iterations end when the last step rotates less than this");
    v.number("converged_translation_m", self.converged_translation_m, 0.0, 1.0,
             "and translates less than this");
    v.number("max_chi2_per_measurement", self.max_chi2_per_measurement, 0.1, 1e6,
             "a patch whose mean squared whitened residual exceeds this is rejected");
    v.number("scatter_prior_freedom", self.scatter_prior_freedom, 0.0, 1e9,
             "the variance of the residuals is estimated from the scatter between patches; degrees of "
             "freedom of its prior (pixels_per_measurement and the noise); 1e9 uses the prior alone");
    v.number("scale_share", self.scale_share, 0.0, 1.0,
             "the noise of residuals moves towards the estimate of each tracked frame by this share (Huber's "
             "Proposal 2); 0 keeps photometric.noise_grey and the depth noise constant");
    v.number("min_patches", self.min_patches, 1, 1000,
             "with fewer accepted patches the prediction is kept and the frame counts as lost");
    v.number("max_lost_frames", self.max_lost_frames, 0, 100000,
             "more consecutive lost frames end the run with status lost; an IMU bridges about a second, "
             "later only relocalisation recovers the pose");
  }
};

/// Errors that all patches of a colour image share, measured by what depth keeps correcting (not in the
/// paper).
struct ColorDriftConfig {
  double factor = 1.0;
  /// Distance in frames of the corrections that are compared: white noise has no correlation over it, drift
  /// has.
  static constexpr int lag_frames = 10;
  /// Frames over which their covariance is averaged.
  static constexpr int memory_frames = 100;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("factor", self.factor, 0.0, 100.0,
             "colour is weighted down by this factor on the drift that the corrections by depth show "
             "(standard deviations); 0: only the scatter of the patches sets its weight");
  }
};

}  // namespace fusebench::config
