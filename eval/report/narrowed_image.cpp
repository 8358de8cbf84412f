#include "eval/report/narrowed_image.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace fusebench::report {

ColorImage narrowed(const ColorImage& image, int width_px) {
  const int width = std::min(width_px, image.width);
  ColorImage small(width, std::max(1, width * image.height / std::max(1, image.width)));
  const cv::Mat from(image.height, image.width, CV_8UC3, const_cast<Rgb*>(image.data.data()));  // only read
  cv::Mat to(small.height, small.width, CV_8UC3, small.data.data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace fusebench::report
