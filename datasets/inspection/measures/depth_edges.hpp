// Edges of depth and strength of colour's edges, by which a depth camera is placed (registration_fit.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::inspection::measures {

/// Where something ends before what is farther: the border of the nearer surface.
struct DepthEdge {
  float x_px;
  float y_px;
  float depth_m;  ///< of the nearer side
  bool upright;   ///< the jump is along a row; else along a column
  /// The nearer surface is on the left (upright) or above; else on the other side.
  bool ends_nearer = true;
};

/// The borders between neighbours in a row or column whose depths differ by more than a tenth; up to eight
/// pixels without a measurement may lie between them, as on the shaded side of sensors with a projector.
[[nodiscard]] std::vector<DepthEdge> depth_edges(const DepthImage& depth_m);

/// A value with its derivatives by x and y.
struct StrengthSample {
  double value = 0;
  Vector2d by_pixel = Vector2d::Zero();
};

/// Strength of edges of colour across rows and along them, 0 to 1, less the mean of the surroundings.
struct EdgeStrength {
  int width = 0;
  int height = 0;
  std::vector<float> upright;
  std::vector<float> level;

  /// Bilinear; x in [0, width - 1), y in [0, height - 1).
  [[nodiscard]] StrengthSample at(const std::vector<float>& values, double x, double y) const;
};

inline constexpr std::size_t kStrengthLevels = 3;  // each half the size of the one before

struct FrameEdges {
  std::vector<DepthEdge> edges;  ///< at most 750, spread over the image
  std::array<EdgeStrength, kStrengthLevels> strength;
  Vector2d motion_px = Vector2d::Zero();  ///< of the image, to the next frame
};

/// Of `most_frames` frames, spread evenly over the recording (at most all). A frame that cannot be read has
/// no edges.
[[nodiscard]] std::vector<FrameEdges> load_edges(const recording::Recording& recording,
                                                 std::size_t most_frames, const Workers& workers);

}  // namespace fusebench::inspection::measures
