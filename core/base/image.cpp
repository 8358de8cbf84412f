#include "core/base/image.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/base/error.hpp"

namespace fusebench {
inline namespace base {

template <class Pixel>
IntensitySample sample_bilinear(const Image<Pixel>& image, double x, double y) {
  // Interpolation cell [x0, x0 + 1] x [y0, y0 + 1], clamped to the last cell at the right and bottom border.
  const int x0 = std::clamp(static_cast<int>(x), 0, image.width - 2);
  const int y0 = std::clamp(static_cast<int>(y), 0, image.height - 2);
  const double ax = x - x0;
  const double ay = y - y0;
  const Pixel* top = &image.data[image.index(x0, y0)];
  const Pixel* bottom = top + image.width;
  const double i00 = top[0];
  const double i10 = top[1];
  const double i01 = bottom[0];
  const double i11 = bottom[1];
  const double upper = i00 + ax * (i10 - i00);
  const double lower = i01 + ax * (i11 - i01);
  return {upper + ay * (lower - upper), (1.0 - ay) * (i10 - i00) + ay * (i11 - i01), lower - upper};
}

template IntensitySample sample_bilinear(const GreyImage& image, double x, double y);
template IntensitySample sample_bilinear(const Image<float>& image, double x, double y);

void build_pyramid(const GreyImage& image, int levels, std::vector<GreyImage>& pyramid) {
  check(levels >= 1 && !image.empty(), "a pyramid needs an image and at least one level");
  pyramid.resize(static_cast<std::size_t>(levels));
  pyramid[0] = image;
  for (std::size_t level = 1; level < pyramid.size(); ++level) {
    GreyImage& finer = pyramid[level - 1];
    GreyImage& coarser = pyramid[level];
    coarser.resize((finer.width + 1) / 2, (finer.height + 1) / 2);
    const cv::Mat source(finer.height, finer.width, CV_8UC1, finer.data.data());
    cv::Mat target(coarser.height, coarser.width, CV_8UC1, coarser.data.data());
    cv::pyrDown(source, target, target.size());
  }
}

std::vector<GreyImage> build_pyramid(const GreyImage& image, int levels) {
  std::vector<GreyImage> pyramid;
  build_pyramid(image, levels, pyramid);
  return pyramid;
}

GreyImage to_grey(const ColorImage& color) {
  GreyImage grey(color.width, color.height);
  // 14-bit fixed point, rounded to nearest; the weights add up to 2^14. Local pointers let the compiler
  // assume that the written bytes do not alias the image headers.
  const Rgb* const colors = color.data.data();
  std::uint8_t* const levels = grey.data.data();
  const std::size_t count = color.data.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const Rgb& c = colors[i];
    levels[i] = static_cast<std::uint8_t>((c[0] * 4899 + c[1] * 9617 + c[2] * 1868 + 8192) >> 14);
  }
  return grey;
}

}  // namespace base
}  // namespace fusebench
