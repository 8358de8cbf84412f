// Intensity residual of each tracked pixel: output of the estimator, input of the intensity metrics.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fusebench {
inline namespace base {

/// |I_k - I_{k-1}| of one pixel of a tracked patch at level 0, before robust weighting and brightness
/// correction.
struct IntensityResidual {
  std::uint32_t reference_pixel =
      0;                      ///< v * width + u in frame k-1: the same pixel has the same key in all variants
  float difference_grey = 0;  ///< absolute, grey levels
  bool accepted = false;      ///< its patch also passed the chi-square gate
};

/// Where that pixel was warped to in frame k, and what it is compared with.
struct WarpedPixel {
  std::uint32_t patch = 0;  ///< number of its patch in the frame
  Eigen::Vector2f warped_px = Eigen::Vector2f::Zero();
  float reference_grey = 0;
  float observed_grey = 0;
};

/// One of the size x size pixels of a tracked patch, whether it is used or not: what other definitions of the
/// intensity error are computed from.
struct SquarePixel {
  std::uint32_t patch = 0;
  bool accepted = false;       ///< its patch passed the chi-square gate
  bool visible = false;        ///< it has a surface and is not occluded; otherwise it moves as the visible
                               ///< ones of its patch do in the mean
  float difference_grey = 0;   ///< absolute, the image interpolated where the pixel lands
  float whole_pixel_grey = 0;  ///< absolute, the image at the nearest whole pixel
};

/// The same pixels in the first two lists.
struct TrackedPixels {
  std::vector<IntensityResidual> intensity;
  std::vector<WarpedPixel> warped;
  std::vector<SquarePixel> squares;  ///< by patch; empty unless evaluation.intensity_readings
};

}  // namespace base
}  // namespace fusebench
