#include "datasets/images/image_files.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;

namespace {

using testing::read_bytes;
using testing::TemporaryFolder;

ColorImage some_color(int width, int height) {
  ColorImage image(width, height);
  std::uint32_t state = 1;
  for (Rgb& pixel : image.data) {
    for (std::uint8_t& channel : pixel)
      channel = static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 24);
  }
  return image;
}

/// The message of an expected failure, with its code checked. Nothing may be printed on the way.
template <class T>
std::string refusal(const Result<T>& result, ErrorCode code) {
  if (result) return "was not refused";
  EXPECT_EQ(result.error().code, code);
  return result.error().message;
}

TEST(ImageFiles, RoundTrip) {
  const TemporaryFolder folder;
  const ColorImage color = some_color(33, 17);
  ASSERT_TRUE(write_png(folder.path() / "c.png", color));
  EXPECT_EQ(read_color(folder.path() / "c.png").value().data, color.data);
  EXPECT_EQ(read_image_size(folder.path() / "c.png").value(), (ImageSize{33, 17}));

  Image<std::uint16_t> depth(5, 4);
  for (std::size_t i = 0; i < depth.data.size(); ++i) depth.data[i] = static_cast<std::uint16_t>(i * 3449);
  ASSERT_TRUE(write_png(folder.path() / "d.png", depth));
  EXPECT_EQ(read_depth16(folder.path() / "d.png", ImageSize{5, 4}).value().data, depth.data);
  EXPECT_EQ(read_image_size(folder.path() / "d.png").value(), (ImageSize{5, 4}));

  GreyImage grey(3, 2);
  for (std::size_t i = 0; i < grey.data.size(); ++i) grey.data[i] = static_cast<std::uint8_t>(i * 51);
  ASSERT_TRUE(write_png(folder.path() / "g.png", grey));
  EXPECT_EQ(read_grey(folder.path() / "g.png").value().data, grey.data);
}

TEST(ImageFiles, JpegInMemoryIsReadAgain) {
  const TemporaryFolder folder;
  const auto jpeg = encode_jpeg(ColorImage(24, 16, Rgb{200, 100, 50}), 95);
  ASSERT_TRUE(jpeg) << jpeg.error().message;
  const auto file = folder.write("c.jpg", {reinterpret_cast<const char*>(jpeg->data()), jpeg->size()});
  EXPECT_EQ(read_image_size(file).value(), (ImageSize{24, 16}));
  const ColorImage read = read_color(file, ImageSize{24, 16}).value();
  for (std::size_t channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(read(12, 8)[channel], (Rgb{200, 100, 50})[channel], 3);
}

TEST(ImageFiles, WritingIsReproducible) {
  const TemporaryFolder folder;
  const ColorImage color = some_color(8, 8);
  ASSERT_TRUE(write_png(folder.path() / "a.png", color));
  ASSERT_TRUE(write_png(folder.path() / "b.png", color));
  EXPECT_EQ(read_bytes(folder.path() / "a.png"), read_bytes(folder.path() / "b.png"));
}

TEST(ImageFiles, MissingFile) {
  EXPECT_EQ(refusal(read_color("/nonexistent/a.png"), ErrorCode::data_missing),
            "/nonexistent/a.png: no such image");
  EXPECT_EQ(refusal(read_depth16("/nonexistent/a.png"), ErrorCode::data_missing),
            "/nonexistent/a.png: no such image");
}

TEST(ImageFiles, WrongKind) {
  const TemporaryFolder folder;
  const auto color = folder.path() / "c.png";
  const auto grey = folder.path() / "g.png";
  ASSERT_TRUE(write_png(color, some_color(4, 4)));
  ASSERT_TRUE(write_png(grey, GreyImage(4, 4, 9)));
  EXPECT_NE(refusal(read_depth16(color), ErrorCode::data_corrupt)
                .find("expected a grey image with 16 bits, got 3 channel"),
            std::string::npos);
  EXPECT_NE(refusal(read_depth16(grey), ErrorCode::data_corrupt).find("got 1 channel(s) of uint8"),
            std::string::npos);
}

TEST(ImageFiles, WrongSize) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder.path() / "c.png", some_color(4, 3)));
  const std::string message =
      refusal(read_color(folder.path() / "c.png", ImageSize{640, 480}), ErrorCode::data_corrupt);
  EXPECT_NE(message.find("c.png: expected 640x480 pixels, got 4x3"), std::string::npos) << message;
}

TEST(ImageFiles, EveryTruncationIsNoticedInSilence) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder.path() / "whole.png", some_color(12, 12)));
  const std::string bytes = read_bytes(folder.path() / "whole.png");
  ::testing::internal::CaptureStderr();
  for (std::size_t size = 0; size < bytes.size(); size += 5) {
    const auto file = folder.write("part.png", bytes.substr(0, size));
    const std::string message = refusal(read_color(file), ErrorCode::data_corrupt);
    EXPECT_NE(message.find("part.png: "), std::string::npos) << size << ": " << message;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ImageFiles, DamagedPixelsAreNoticedInSilence) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder.path() / "whole.png", some_color(40, 40)));
  const std::string bytes = read_bytes(folder.path() / "whole.png");
  const std::size_t begin = bytes.find("IDAT") + 4;
  ::testing::internal::CaptureStderr();
  for (std::size_t at = begin; at < bytes.size() - 16; at += 97) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x5A);
    const std::string message =
        refusal(read_color(folder.write("damaged.png", damaged)), ErrorCode::data_corrupt);
    EXPECT_NE(message.find("damaged.png: "), std::string::npos) << at << ": " << message;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ImageFiles, NotAnImage) {
  const TemporaryFolder folder;
  ::testing::internal::CaptureStderr();
  EXPECT_NE(refusal(read_color(folder.write("text.png", "this is text")), ErrorCode::data_corrupt),
            "was not refused");
  EXPECT_NE(refusal(read_color(folder.write("empty.png", "")), ErrorCode::data_corrupt), "was not refused");
  EXPECT_NE(refusal(read_color(folder.write("noise.jpg", "\xFF\xD8\xFFgarbage")), ErrorCode::data_corrupt),
            "was not refused");
  EXPECT_NE(refusal(read_color(folder.path()), ErrorCode::data_missing), "was not refused") << "a folder";
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ImageFiles, WritingFailsWithAnError) {
  const std::string message = refusal(write_png("/nonexistent/folder/a.png", GreyImage(2, 2)), ErrorCode::io);
  EXPECT_NE(message.find("/nonexistent/folder/a.png: cannot be written"), std::string::npos) << message;
}

}  // namespace
}  // namespace fusebench
