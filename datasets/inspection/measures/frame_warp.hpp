// Warps the points of one frame into another by ground truth, and measures what does not agree.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::inspection::measures {

/// A way to read a recording: how poses, times, depths, colours and intrinsics are to be taken. The default
/// is as they are.
struct Reading {
  std::function<SE3(const SE3&)> pose;  ///< what to do to each pose of the ground truth; empty: nothing
  double depth_scale = 1;               ///< factor of all depths
  bool depth_along_ray = false;         ///< depth is the distance to the camera's centre, not its z component
  double focal_scale = 1;               ///< factor of fx and fy
  double image_scale = 1;               ///< factor of fx, fy, cx and cy: of the image that they belong to
  std::int64_t truth_shift_ns = 0;      ///< the ground truth is looked up this much later
  std::int64_t depth_shift_ns = 0;      ///< depth images were taken this much later
  bool color_mirrored_x = false;        ///< column x of colour is column width - 1 - x of the scene
  bool color_mirrored_y = false;        ///< the same of rows; both: colour is upside down
};

/// A measured point of a frame.
struct MeasuredPoint {
  double x_px = 0;
  double y_px = 0;
  double depth_m = 0;
};

/// Two loaded frames.
struct WarpPair {
  std::size_t from = 0;
  std::size_t to = 0;
  std::int64_t from_color_ns = 0, from_depth_ns = 0, to_color_ns = 0, to_depth_ns = 0;
  std::vector<MeasuredPoint> points;  ///< of the first frame, where depth is smooth
  GreyImage from_grey;
  GreyImage to_grey;
  DepthImage to_depth_m;
};

struct WarpResidual {
  std::size_t points = 0;     ///< that fall on a measurement
  double overlap = 0;         ///< the same as a share
  double depth_m = 0;         ///< median |observed - predicted|
  double depth_share = 0;     ///< median |observed - predicted| / predicted
  double intensity_grey = 0;  ///< median |difference|, after the median difference is taken away
};

/// Whether there is a measurement, and the depths two pixels aside differ from it by at most 3 %. The pixel
/// is two or more from the border.
[[nodiscard]] bool is_smooth(const DepthImage& depth_m, int x, int y);

/// Points on a grid, where depth differs from its neighbours' by less than 3 %.
[[nodiscard]] WarpPair make_warp_pair(std::size_t from, std::size_t to, const RgbdFrame& from_frame,
                                      RgbdFrame&& to_frame);

/// Residuals under a reading. Depth is compared at the instants of the depth images, and intensity at those
/// of the colour images. Nothing if the ground truth does not cover the pair.
[[nodiscard]] std::optional<WarpResidual> warp(const WarpPair& pair, const PinholeCamera& camera,
                                               const Trajectory& truth, std::int64_t truth_gap_ns,
                                               const Reading& reading);

}  // namespace fusebench::inspection::measures
