#include "datasets/recording/reading/image_source.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "datasets/images/file_content.hpp"

namespace fusebench::reading {

namespace {

template <class Number>
void divide(const std::vector<std::uint16_t>& values, Number divisor, std::vector<float>& quotients) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    quotients[i] = static_cast<float>(static_cast<Number>(values[i]) / divisor);
  }
}

/// Some cameras write the largest value where they measured nothing, and no format has it as a depth.
constexpr std::uint16_t kSaturated = 65535;

template <class Decoded>
Result<Decoded> decode_unchanged(const Result<StoredImage>& stored, const images::ImageSize& expected,
                                 const io::ContentHash& opened,
                                 const std::function<Result<Decoded>(const StoredImage&)>& decode) {
  if (!stored) return tl::unexpected(stored.error());
  if (const auto same = images::check_unchanged(stored->name, stored->bytes, opened); !same)
    return tl::unexpected(same.error());
  auto image = decode(*stored);
  if (!image || images::ImageSize{image->width, image->height} == expected) return image;
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}: expected {}x{} pixels, got {}x{}", stored->name, expected.width_px,
                          expected.height_px, image->width, image->height));
}

Result<io::ContentHash> add_image(const std::filesystem::path& file, io::Fingerprint& fingerprint) {
  if (const auto sized = images::check_image_bytes(file); !sized) return tl::unexpected(sized.error());
  return fingerprint.add_file(file);
}

}  // namespace

/// The quotients in double precision, rounded. Where single precision holds the divisor, a division in it
/// gives the same in a third of the time: double precision has more than twice its digits, so that the first
/// of two roundings never decides the second.
DepthImage depth_in_metres(const Image<std::uint16_t>& values, double units_per_metre) {
  DepthImage depth_m(values.width, values.height);
  const auto single = static_cast<float>(units_per_metre);
  if (static_cast<double>(single) == units_per_metre) {
    divide(values.data, single, depth_m.data);
  } else {
    divide(values.data, units_per_metre, depth_m.data);
  }
  for (std::size_t i = 0; i < values.data.size(); ++i)
    depth_m.data[i] = values.data[i] == kSaturated ? 0.0F : depth_m.data[i];
  return depth_m;
}

DepthReader png_depth(double units_per_metre) {
  return [units_per_metre](const std::filesystem::path& file, const images::ImageSize& expected,
                           const std::optional<io::ContentHash>& opened) -> Result<DepthImage> {
    const auto values = images::read_depth16(file, expected, opened);
    if (!values) return tl::unexpected(values.error());
    return depth_in_metres(*values, units_per_metre);
  };
}

ImageSource image_files(std::vector<recording::FrameEntry> frames, DepthReader read_depth) {
  const auto listed = std::make_shared<const std::vector<recording::FrameEntry>>(std::move(frames));
  ImageSource source;
  source.color_size = [listed] { return images::read_image_size(listed->front().color_file); };
  source.depth_size = [listed] {
    return images::png_size(images::content_of(listed->front().depth_file).text());
  };
  source.add_to = [listed](std::size_t frame, io::Fingerprint& fingerprint) -> Result<ImageHashes> {
    const auto color = add_image((*listed)[frame].color_file, fingerprint);
    if (!color) return tl::unexpected(color.error());
    const auto depth = add_image((*listed)[frame].depth_file, fingerprint);
    if (!depth) return tl::unexpected(depth.error());
    return ImageHashes{*color, *depth};
  };
  source.read_color = [listed](std::size_t frame, const images::ImageSize& expected,
                               const io::ContentHash& opened) {
    return images::read_color((*listed)[frame].color_file, expected, opened);
  };
  source.read_depth = [listed, read = std::move(read_depth)](std::size_t frame,
                                                             const images::ImageSize& expected,
                                                             const io::ContentHash& opened) {
    return read((*listed)[frame].depth_file, expected, opened);
  };
  return source;
}

ImageSource stored_images(StoredImages images) {
  const auto stored = std::make_shared<const StoredImages>(std::move(images));
  ImageSource source;
  source.color_size = [stored] {
    return stored->color(0).and_then(stored->decode_color).map([](const ColorImage& image) {
      return images::ImageSize{image.width, image.height};
    });
  };
  source.depth_size = [stored]() -> std::optional<images::ImageSize> {
    const auto depth = stored->depth(0);
    return depth ? images::png_size(depth->bytes) : std::nullopt;
  };
  source.add_to = [stored](std::size_t frame, io::Fingerprint& fingerprint) -> Result<ImageHashes> {
    const auto color = stored->color(frame);
    if (!color) return tl::unexpected(color.error());
    const auto depth = stored->depth(frame);
    if (!depth) return tl::unexpected(depth.error());
    fingerprint.add(color->bytes);
    fingerprint.add(depth->bytes);
    return ImageHashes{io::content_hash(color->bytes), io::content_hash(depth->bytes)};
  };
  source.read_color = [stored](std::size_t frame, const images::ImageSize& expected,
                               const io::ContentHash& opened) {
    return decode_unchanged(stored->color(frame), expected, opened, stored->decode_color);
  };
  source.read_depth = [stored](std::size_t frame, const images::ImageSize& expected,
                               const io::ContentHash& opened) {
    return decode_unchanged(stored->depth(frame), expected, opened, stored->decode_depth);
  };
  return source;
}

}  // namespace fusebench::reading
