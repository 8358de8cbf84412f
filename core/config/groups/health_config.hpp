// Options: diagnosis of a frame and acceptance of its update.
#pragma once

namespace fusebench::config {

/// Limits for the diagnosis of a frame, the acceptance of its update and its fusion.
struct HealthConfig {
  double dark_grey = 6.0;
  double covered_share = 0.25;
  double min_depth_share = 0.1;
  /// A pixel of the coarsest pyramid level has texture if its gradient exceeds this (grey levels between
  /// neighbours), which the noise of that level does not.
  static constexpr int texture_gradient_grey = 4;
  /// A frame with texture on a smaller share of its pixels is short of texture: at 640x480 and 3 levels 1 %
  /// is 192 pixels, less than two patches.
  static constexpr double min_texture_share = 0.01;
  /// An update is tried again from the coarsest level if the mean correlation (ZNCC) of the patches in view
  /// with their reference is below this; 95 % of the frames of real recordings are above 0.85, blurred ones
  /// between 0.5 and 0.8.
  static constexpr double sure_correlation = 0.7;
  double min_correlation = 0.3;
  /// Patches with a smaller standard deviation of their intensities do not count in the median correlation
  /// (grey levels): camera noise of 1 to 4 grey levels lowers the correlation of a patch with 8 by up to a
  /// fifth.
  static constexpr double min_contrast_grey = 8.0;
  double max_rotation_sigma_deg = 1.0;
  double max_position_sigma_m = 0.02;
  int max_occluded_frames = 30;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("dark_grey", self.dark_grey, 0.0, 255.0,
             "a frame is dark if its mean is below this (grey levels); noise and black level of a covered "
             "camera are lower");
    v.number("covered_share", self.covered_share, 0.0, 1.0,
             "a frame is occluded if a new object covers more than this share of the patches in view; less "
             "than half, because near surfaces have the strongest corners: patches cut from a hand in front "
             "of 40 % of the image dominate the update");
    v.number("min_depth_share", self.min_depth_share, 0.0, 1.0,
             "a frame is short of depth if a smaller share of its pixels has usable depth; low, because "
             "patches require more themselves (patches.min_valid_fraction)");
    v.number(
        "min_correlation", self.min_correlation, -1.0, 1.0,
        "an update is rejected if the median correlation of the tracked patches is below this; wrong poses "
        "reach 0 to 0.25, correct ones at least 0.34 under the worst blur of simulated motion at 10 rad/s");
    v.number("max_rotation_sigma_deg", self.max_rotation_sigma_deg, 0.01, 180.0,
             "an update is rejected if the standard deviation of the orientation relative to the model is "
             "larger about any axis (degrees), because the frame would be fused with an offset; three "
             "standard deviations are an undetected failure (evaluation.silent_rotation_deg)");
    v.number("max_position_sigma_m", self.max_position_sigma_m, 1e-4, 100.0,
             "an update is rejected if the standard deviation of the position relative to the model is "
             "larger along any axis (metres); 2.5 standard deviations are an undetected failure "
             "(evaluation.silent_translation_m)");
    v.number("max_occluded_frames", self.max_occluded_frames, 0, 100000,
             "an object that occludes the scene for more consecutive frames than this is fused into the "
             "model; 30 are one second at 30 Hz");
  }
};

}  // namespace fusebench::config
