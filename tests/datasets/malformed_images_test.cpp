// PNG files that are broken, or are not what a recording needs: nothing may crash or take memory that
// the file cannot justify.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>

#include "datasets/images/image_files.hpp"
#include "tests/datasets/images/child_process.hpp"
#include "tests/datasets/malformed_text.hpp"

namespace fusebench {

using namespace images;

namespace {

using namespace testing;

constexpr std::size_t kHeader = 8;       // the chunk IHDR begins behind the signature
constexpr std::size_t kHeaderData = 16;  // width, height, bits, colour type, ...
constexpr std::size_t kBits = kHeaderData + 8;
constexpr std::size_t kColorType = kHeaderData + 9;

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

/// The checksum of PNG chunks (ISO 3309).
std::uint32_t checksum(std::string_view bytes) {
  std::uint32_t sum = 0xFFFFFFFF;
  for (const char c : bytes) {
    sum ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1) != 0 ? 0xEDB88320 : 0);
  }
  return ~sum;
}

std::string chunk(std::string_view type, std::string_view data) {
  const std::string covered = std::string(type) + std::string(data);
  return big_endian(static_cast<std::uint32_t>(data.size())) + covered + big_endian(checksum(covered));
}

/// The header changed at a place, with the right checksum.
std::string with_header(std::string png, std::size_t at, std::string_view bytes) {
  png.replace(at, bytes.size(), bytes);
  return png.substr(0, kHeader) + chunk("IHDR", png.substr(kHeaderData, 13)) +
         png.substr(kHeaderData + 13 + 4);
}

/// Another content for the pixels, with the right checksum.
std::string with_pixels(const std::string& png, std::string_view data) {
  return png.substr(0, png.find("IDAT") - 4) + chunk("IDAT", data) + chunk("IEND", "");
}

std::string pixels_of(const std::string& png) {
  const std::size_t begin = png.find("IDAT") + 4;
  return png.substr(begin, png.find("IEND") - 8 - begin);
}

std::string with_size(const std::string& png, std::uint32_t width, std::uint32_t height) {
  return with_header(png, kHeaderData, big_endian(width) + big_endian(height));
}

class MalformedImage : public InTemporaryFolder {
 protected:
  void SetUp() override {
    Image<std::uint16_t> depth(8, 6);
    for (std::size_t i = 0; i < depth.data.size(); ++i) depth.data[i] = static_cast<std::uint16_t>(1000 * i);
    ASSERT_TRUE(write_png(folder_ / "color.png", ColorImage(8, 6, Rgb{1, 2, 3})));
    ASSERT_TRUE(write_png(folder_ / "grey.png", GreyImage(8, 6, 9)));
    ASSERT_TRUE(write_png(folder_ / "depth.png", depth));
    color_ = read_bytes(folder_ / "color.png");
    depth_ = read_bytes(folder_ / "depth.png");
  }

  void expect_refused(const char* name, const std::string& bytes, std::string_view part) const {
    SCOPED_TRACE(name);
    const auto file = write("broken.png", bytes);
    const auto color = read_color(file);
    ASSERT_FALSE(color);
    expect_refusal(color.error(), file, 0, part);
    const auto depth = read_depth16(file);
    ASSERT_FALSE(depth);
    EXPECT_EQ(depth.error().code, ErrorCode::data_corrupt);
  }

  std::string color_;
  std::string depth_;
};

TEST_F(MalformedImage, BrokenFiles) {
  std::string bad_sum = color_;
  bad_sum[kBits + 6] ^= 1;
  std::string swapped = color_;
  std::swap(swapped[kHeaderData + 3], swapped[kHeaderData + 7]);
  ::testing::internal::CaptureStderr();
  expect_refused("no bytes", "", "unreadable image");
  expect_refused("text", "1.0 2.0\n", "unreadable image");
  expect_refused("zeros", std::string(1000, '\0'), "unreadable image");
  expect_refused("only the signature", color_.substr(0, 8), "truncated PNG");
  expect_refused("half of the file", color_.substr(0, color_.size() / 2), "truncated PNG");
  expect_refused("no end", color_.substr(0, color_.size() - 12), "truncated PNG");
  expect_refused("a byte short", color_.substr(0, color_.size() - 1), "truncated PNG");
  expect_refused("a wrong checksum", bad_sum, "damaged PNG (checksum of the chunk at byte 8)");
  expect_refused("a header that was changed", swapped, "damaged PNG (checksum of the chunk at byte 8)");
  expect_refused("copied as text", replaced(color_, "\r\n", "\n"), "unreadable image");
  expect_refused("a length beyond the file", color_.substr(0, 8) + big_endian(0xFFFFFFFF) + color_.substr(12),
                 "truncated PNG");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// Found by the decoder itself, which says so on standard error as well.
TEST_F(MalformedImage, SoundChunksWithBrokenContent) {
  std::string damaged = pixels_of(color_);
  damaged[damaged.size() / 2] ^= 0x55;
  const std::string half = pixels_of(color_).substr(0, pixels_of(color_).size() / 2);
  const std::string bare = color_.substr(0, kHeaderData + 13 + 4);
  expect_refused("damaged pixels", with_pixels(color_, damaged), "image");
  expect_refused("half of the pixels", with_pixels(color_, half), "image");
  expect_refused("no pixels", with_pixels(color_, ""), "image");
  expect_refused("no chunk of pixels", bare + chunk("IEND", ""), "image");
  expect_refused("no header", color_.substr(0, 8) + chunk("IEND", ""), "image");
  expect_refused("no columns", with_size(color_, 0, 6), "image");
  expect_refused("more rows than pixels", with_size(color_, 8, 7), "image");
}

TEST_F(MalformedImage, OtherLayouts) {
  expect_refused("too few pixels for 16 bits", with_header(color_, kBits, "\x10"), "damaged image");
  expect_refused("too few pixels for alpha", with_header(color_, kColorType, "\x06"), "damaged image");
  EXPECT_NE(read_depth16(folder_ / "color.png").error().message.find("got 3 channel(s) of uint8"),
            std::string::npos);
  EXPECT_NE(read_depth16(folder_ / "grey.png").error().message.find("got 1 channel(s) of uint8"),
            std::string::npos);
  const auto bits_3 = read_depth16(write("a.png", with_header(depth_, kBits, "\x03")));
  ASSERT_FALSE(bits_3) << "PNG has no such depth";
  EXPECT_TRUE(read_color(write("a.png", color_ + "what a disk leaves behind")))
      << "nothing is behind the end";
}

// /dev/zero never ends, whatever reader of the library takes it.
TEST_F(MalformedImage, ADeviceIsNoImage) {
  const std::filesystem::path device = folder_ / "device.png";
  std::filesystem::create_symlink("/dev/zero", device);
  const ChildResult result = run_in_child(std::size_t{512} << 20, [&] {
    alarm(60);
    return read_color(device).error().message + read_depth16(device).error().message +
           read_image_size(device).error().message;
  });
  EXPECT_TRUE(result.ended_well);
  EXPECT_NE(result.text.find("device.png: no such image"), std::string::npos) << result.text;
}

// 10^5 x 10^5 pixels would be 30 GB of colour.
TEST_F(MalformedImage, AHeaderAloneTakesNoMemory) {
  struct Claim {
    std::uint32_t width;
    std::uint32_t height;
  };
  for (const Claim claim :
       {Claim{100'000, 100'000}, Claim{1'000'000, 1'000'000}, Claim{0x7FFFFFFF, 0x7FFFFFFF},
        Claim{0x7FFFFFFF, 1}, Claim{0xFFFFFFFF, 6}, Claim{20'000, 20'000}}) {
    SCOPED_TRACE(fmt::format("{} x {}", claim.width, claim.height));
    const auto color = write("huge_color.png", with_size(color_, claim.width, claim.height));
    const auto depth = write("huge_depth.png", with_size(depth_, claim.width, claim.height));
    const ChildResult result = run_in_child(std::size_t{512} << 20, [&] {
      const auto c = read_color(color);
      const auto d = read_depth16(depth);
      const auto s = read_image_size(color);
      return c || d || s ? "accepted"
                         : c.error().message + "\n" + d.error().message + "\n" + s.error().message;
    });
    EXPECT_TRUE(result.ended_well);
    EXPECT_EQ(std::ranges::count(result.text, '\n'), 2) << result.text;
    EXPECT_EQ(result.text.find("threw"), std::string::npos) << result.text;
    if (!kMemoryIsMeasured) continue;
    EXPECT_LT(result.peak_bytes, std::size_t{256} << 20);
  }
}

// All of one colour, so that the file justifies what its header claims: 384 MB from 370 kB.
TEST_F(MalformedImage, TheSizeIsJudgedBeforePixelsAreDecoded) {
  const auto file = folder_ / "wide.png";
  ASSERT_TRUE(write_png(file, ColorImage(4000, 3000, Rgb{})));
  const ChildResult expected = run_in_child(std::size_t{512} << 20, [&] {
    const auto image = read_color(file, ImageSize{640, 480});
    return image ? "accepted" : image.error().message;
  });
  EXPECT_NE(expected.text.find("wide.png: expected 640x480 pixels, got 4000x3000"), std::string::npos)
      << expected.text;
  // What the library of images itself takes.
  const auto small = folder_ / "small.png";
  ASSERT_TRUE(write_png(small, ColorImage(8, 8, Rgb{})));
  const ChildResult before = run_in_child(std::size_t{512} << 20, [&] {
    return read_color(small, ImageSize{640, 480}) ? "accepted" : "refused";
  });
  if (kMemoryIsMeasured) {
    EXPECT_LT(expected.peak_bytes, before.peak_bytes + (std::size_t{24} << 20));
  }

  std::string row(1 + 3 * 16'384, '\0');
  std::string rows;
  for (int y = 0; y < 5000; ++y) rows += row;
  uLongf size = compressBound(rows.size());
  std::string packed(size, '\0');
  ASSERT_EQ(compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                      reinterpret_cast<const Bytef*>(rows.data()), rows.size(), 1),
            Z_OK);
  packed.resize(size);
  const std::string huge = with_pixels(with_size(color_, 16'384, 5000), packed);
  const std::string part = "its header claims 16384x5000 pixels (allowed: up to 67108864 of them)";
  EXPECT_NE(read_color(write("huge.png", huge)).error().message.find(part), std::string::npos);
  EXPECT_NE(read_image_size(write("huge.png", huge)).error().message.find(part), std::string::npos);
  EXPECT_NE(decode_color("huge", huge).error().message.find(part), std::string::npos);
}

TEST_F(MalformedImage, AFileLongerThanAnyImageIsNotRead) {
  const auto file = write("holes.png", color_);
  std::filesystem::resize_file(file, std::uintmax_t{60'000'000'000});  // takes no room on the disk
  const std::string part =
      "holes.png: 60000000000 bytes are too many for an image (allowed: up to 536870912)";
  EXPECT_NE(read_color(file).error().message.find(part), std::string::npos);
  EXPECT_NE(read_depth16(file).error().message.find(part), std::string::npos);
  EXPECT_NE(read_image_size(file).error().message.find(part), std::string::npos);
}

TEST_F(MalformedImage, AGifIsNotOpened) {
  // 65535 x 65535 pixels, a table of two colours, and one image of one pixel.
  const std::string gif("GIF89a\xFF\xFF\xFF\xFF\x80\0\0\0\0\0\xFF\xFF\xFF,\0\0\0\0\1\0\1\0\0\2\2D\1\0;", 35);
  const auto image = read_color(write("moving.png", gif));
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(image.error().message.find("moving.png: a GIF"), std::string::npos) << image.error().message;
}

}  // namespace
}  // namespace fusebench
