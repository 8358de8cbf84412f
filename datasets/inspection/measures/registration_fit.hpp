// Which camera took the depth images, by where their edges lie on those of colour.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::inspection::measures {

/// Where something ends before what is farther: the border of the nearer surface.
struct DepthEdge {
  float x_px;
  float y_px;
  float depth_m;  ///< of the nearer side
  bool upright;   ///< the jump is along a row; else along a column
};

/// The borders between neighbours in a row or column whose depths differ by more than a tenth; up to eight
/// pixels without a measurement may lie between them, as on the shaded side of sensors with a projector.
[[nodiscard]] std::vector<DepthEdge> depth_edges(const DepthImage& depth_m);

/// How depth images as they are read have to move to lie on colour: what parallel cameras do to each other
/// that have other focal lengths and centres, and stand apart. Pixels (x, y) with depth z go to
/// centre + scale ((x, y) - centre) + shift + focal length * baseline / z.
struct RegistrationModel {
  double scale = 1;                  ///< focal length of colour over that of depth
  Eigen::Vector2d shift_px{0, 0};    ///< of the centre, or a small turn
  Eigen::Vector2d baseline_m{0, 0};  ///< the depth camera's place in the colour camera, x and y

  [[nodiscard]] Eigen::Vector2d move(const DepthEdge& edge, const PinholeCamera& camera) const;
};

struct RegistrationFit {
  static constexpr double kMaxSpread = 0.5;  ///< of the movement: beyond it, no one camera fits
  static constexpr double kMinBetterShare = 0.9;

  RegistrationModel model;
  std::size_t frames = 0;  ///< with edges
  std::size_t edges = 0;
  /// Mean strength of edges of colour under those of depth (0: as strong as around them, 1: much stronger),
  /// where they are and moved by the model.
  double strength_as_read = 0;
  double strength_moved = 0;
  double better_share = 0;           ///< of the frames: their own edges lie better when moved
  double moved_px = 0;               ///< by the model, rms over the edges
  double spread_px = 0;              ///< between the models of every other frame, rms over the edges
  calibration::DepthCamera as_read;  ///< the calibration's; the colour camera, if depth counts as registered
  calibration::DepthCamera fitted;   ///< that the model asks for in its place

  /// The fits to every other frame say nearly the same.
  [[nodiscard]] bool is_one_camera() const { return spread_px <= kMaxSpread * moved_px; }
  /// The movement is not the gain of a few frames.
  [[nodiscard]] bool is_better_all_over() const { return better_share >= kMinBetterShare; }
};

/// Fits the model to frames all over the recording. Nothing if they have too few edges.
[[nodiscard]] std::optional<RegistrationFit> fit_registration(const recording::Recording& recording,
                                                              const Workers& workers);

/// The depth camera that the model asks for in place of the one with which depth was read. Exact for parallel
/// cameras; small turns become a shift of the centre.
[[nodiscard]] calibration::DepthCamera fitted_depth_camera(const RegistrationModel& model,
                                                           const PinholeCamera& color,
                                                           const calibration::DepthCamera& as_read);

}  // namespace fusebench::inspection::measures
