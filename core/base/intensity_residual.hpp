// Intensity residuals of tracked pixels: output of the estimator, input of the intensity metrics.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fusebench {
inline namespace base {

/// |I_k - I_a| of one pixel of a tracked patch at level 0, before robust weighting and brightness correction;
/// a: the frame that the patch was cut from.
struct IntensityResidual {
  /// v * width + u of the pixel of frame k nearest to where it lands; identifies the pixel in all variants,
  /// whose patches can be of different frames.
  std::uint32_t pixel = 0;
  float difference_grey = 0;  ///< absolute, grey levels
  bool accepted = false;      ///< its patch passed the chi-square gate
};

/// Position in frame k to which a pixel is warped, and the reference intensity.
struct WarpedPixel {
  std::uint32_t patch = 0;            ///< number of its patch in the frame
  std::uint32_t reference_pixel = 0;  ///< v * width + u in frame a
  Eigen::Vector2f warped_px = Eigen::Vector2f::Zero();
  float reference_grey = 0;
  float observed_grey = 0;
};

/// One of the size x size pixels of a tracked patch, used or not. Input of the other definitions of the
/// intensity error.
struct SquarePixel {
  std::uint32_t patch = 0;
  bool accepted = false;  ///< its patch passed the chi-square gate
  /// has a surface and is not occluded; other pixels move with the mean of the visible ones
  bool visible = false;
  float difference_grey = 0;   ///< absolute, image interpolated at the warped position
  float whole_pixel_grey = 0;  ///< absolute, image at the nearest whole pixel
};

/// Residuals of one frame. The first two lists have the same pixels in the same order.
struct TrackedPixels {
  std::vector<IntensityResidual> intensity;
  std::vector<WarpedPixel> warped;
  std::vector<SquarePixel> squares;  ///< by patch; empty unless evaluation.intensity_readings
};

}  // namespace base
}  // namespace fusebench
