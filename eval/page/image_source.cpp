#include "eval/page/image_source.hpp"

#include "datasets/images/image_files.hpp"
#include "eval/text/markup_text.hpp"

namespace fusebench::page {

std::string jpeg_source(const ColorImage& image, int quality) {
  const auto jpeg = images::encode_jpeg(image, quality);
  return jpeg ? "data:image/jpeg;base64," + text::base64(*jpeg) : std::string();
}

std::string png_source(const ColorImage& image) {
  const auto png = images::encode_png(image);
  return png ? "data:image/png;base64," + text::base64(*png) : std::string();
}

}  // namespace fusebench::page
