// Every layout of samples that a PNG of a camera, a simulator or a screenshot has is read as colour.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <initializer_list>
#include <string>

#include "datasets/images/image_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;

namespace {

/// Colour types of the PNG specification, 11.2.2.
constexpr char kGreyPng = 0;
constexpr char kRgbPng = 2;
constexpr char kGreyAlphaPng = 4;
constexpr char kRgbaPng = 6;

std::string png_number(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string covered = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(covered.data()), static_cast<uInt>(covered.size()));
  return png_number(static_cast<std::uint32_t>(data.size())) + covered +
         png_number(static_cast<std::uint32_t>(sum));
}

/// Two pixels in a row, given by their bytes.
std::string png_of(char bits, char color_type, std::initializer_list<int> bytes) {
  std::string row(1, '\0');  // no filter
  for (const int byte : bytes) row += static_cast<char>(byte);
  uLongf size = compressBound(static_cast<uLong>(row.size()));
  std::string pixels(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(pixels.data()), &size,
                     reinterpret_cast<const Bytef*>(row.data()), static_cast<uLong>(row.size())),
            Z_OK);
  pixels.resize(size);
  return std::string("\x89PNG\r\n\x1a\n", 8) +
         png_chunk("IHDR", png_number(2) + png_number(1) + bits + color_type + std::string(3, '\0')) +
         png_chunk("IDAT", pixels) + png_chunk("IEND", "");
}

class ColorLayouts : public testing::InTemporaryFolder {
 protected:
  /// From a file, and from memory.
  void expect_pixels(const std::string& png, const Rgb& first, const Rgb& second) const {
    const auto file = write("image.png", png);
    for (const auto& read : {read_color(file, ImageSize{2, 1}), decode_color("image", png)}) {
      ASSERT_TRUE(read) << read.error().message;
      EXPECT_EQ((*read)(0, 0), first);
      EXPECT_EQ((*read)(1, 0), second);
    }
    EXPECT_EQ(read_image_size(file).value(), (ImageSize{2, 1}));
    EXPECT_FALSE(read_color(file, ImageSize{1, 2}));
  }
};

TEST_F(ColorLayouts, Red8Green8Blue8) {
  expect_pixels(png_of(8, kRgbPng, {1, 2, 3, 250, 251, 252}), {1, 2, 3}, {250, 251, 252});
}

TEST_F(ColorLayouts, AlphaIsLeftOutAndDoesNotDarken) {
  expect_pixels(png_of(8, kRgbaPng, {10, 20, 30, 255, 200, 100, 50, 0}), {10, 20, 30}, {200, 100, 50});
  expect_pixels(png_of(8, kRgbaPng, {10, 20, 30, 128, 200, 100, 50, 1}), {10, 20, 30}, {200, 100, 50});
  expect_pixels(png_of(8, kGreyAlphaPng, {10, 128, 200, 0}), {10, 10, 10}, {200, 200, 200});
}

TEST_F(ColorLayouts, GreyHasThreeEqualChannels) {
  expect_pixels(png_of(8, kGreyPng, {0, 77}), {0, 0, 0}, {77, 77, 77});
}

TEST_F(ColorLayouts, SixteenBitsBecomeEight) {
  expect_pixels(png_of(16, kGreyPng, {0xFF, 0xFF, 0x80, 0x80}), {255, 255, 255}, {128, 128, 128});
  expect_pixels(png_of(16, kRgbPng, {0, 0, 1, 1, 2, 2, 0xFF, 0xFF, 0, 0x80, 0, 0x81}), {0, 1, 2},
                {255, 0, 1});
  expect_pixels(png_of(16, kRgbaPng, {1, 1, 2, 2, 3, 3, 0, 0, 4, 4, 5, 5, 6, 6, 0xFF, 0xFF}), {1, 2, 3},
                {4, 5, 6});
}

TEST_F(ColorLayouts, DepthStaysGreyOf16Bits) {
  const auto file = write("depth.png", png_of(16, kGreyAlphaPng, {1, 0, 255, 255, 2, 0, 255, 255}));
  const auto depth = read_depth16(file);
  ASSERT_FALSE(depth);
  EXPECT_NE(depth.error().message.find("expected a grey image with 16 bits, got 2 channel(s) of uint16"),
            std::string::npos)
      << depth.error().message;
}

}  // namespace
}  // namespace fusebench
