// Which camera took the depth images, by where their edges lie on those of colour.
//
// An edge of depth at (x, y), whose nearer surface is at depth z, lies in colour at
//
//   centre + scale ((x, y) - centre) + shift + focal length * baseline / z + delay * motion + growth * side.
//
// - scale (focal length of colour over that of depth): a displacement in proportion to the radius;
// - shift (centre, or a small turn): the same displacement everywhere;
// - baseline (place of the depth camera): a displacement in proportion to 1/z, observable if edges have
//   different depths;
// - delay: depth is taken later than colour by this share of the interval of frames, in which the image moves
//   by `motion`. Observable if the camera turns; it averages out where it turns to and fro;
// - growth: sensors draw what is near too large or too small; side is -1 where it ends, +1 where it begins.
//
// The first five are the result, the others are estimated with them so that they do not bias them. The
// estimate maximises the strength of colour's edges under the edges of depth, a robust alignment: an edge
// that has no counterpart within a few pixels has no influence. Newton's method from the best of a coarse
// search. Covariance: sandwich estimator A^-1 J A^-1, A the derivative of the score, J its scatter between 16
// periods of the recording and between 16 cells of the image: a camera that hardly moves sees the same edges
// in all frames. Wide priors (20 % of the focal length, 30 px, 30 mm) hold what the edges do not determine.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/inspection/measures/registration_model.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::inspection::measures {

/// Standard deviations of a fitted depth camera, with RegistrationFit::kCommonSigma_px.
struct DepthCameraSigma {
  double focal_length_px = 0;
  Vector2d centre_px{0, 0};
  Vector2d place_m{0, 0};
};

struct RegistrationFit {
  static constexpr double kMinGainSigmas = 5;  ///< the best of some thousand moves gains up to 4 by chance
  static constexpr double kSignificant = 3;    ///< standard deviations
  /// What the scatter of frames does not show: edges of the depth of two Kinects, registered by their makers'
  /// and by a published calibration, lie 2 px beside those of colour, in all parts of the recordings alike.
  static constexpr double kCommonSigma_px = 1;

  RegistrationModel model;
  std::size_t frames = 0;  ///< with edges
  std::size_t edges = 0;
  /// Mean strength of edges of colour under those of depth (0: as strong as around them, 1: much stronger),
  /// where they are and moved by the model.
  double strength_as_read = 0;
  double strength_moved = 0;
  double gain_sigmas = 0;            ///< the difference of the two over its standard deviation
  double moved_px = 0;               ///< by the model, rms over the edges
  double sigma_px = 0;               ///< of that movement, rms over the edges
  double delay_frames = 0;           ///< of depth, in intervals of frames
  calibration::DepthCamera as_read;  ///< the calibration's; the colour camera, if depth counts as registered
  calibration::DepthCamera fitted;   ///< that the model asks for in its place
  DepthCameraSigma fitted_sigma;

  /// The movement is larger than its uncertainty explains.
  [[nodiscard]] bool is_significant() const {
    return moved_px > kSignificant * std::hypot(sigma_px, kCommonSigma_px);
  }
  /// The movement is significant, and is not a chance alignment or the gain of few frames or of a part of the
  /// image.
  [[nodiscard]] bool is_determined() const { return is_significant() && gain_sigmas >= kMinGainSigmas; }
};

/// Fits the model to frames all over the recording. Nothing if they have too few edges.
[[nodiscard]] std::optional<RegistrationFit> fit_registration(const recording::Recording& recording,
                                                              const Workers& workers);

/// The depth camera by which depth was read: the calibration's; the colour camera, if depth counts as
/// registered.
[[nodiscard]] calibration::DepthCamera depth_camera_as_read(const recording::Recording& recording);

}  // namespace fusebench::inspection::measures
