// The short way to decode PNGs: the pixels that the format defines, and no answer to anything out of the
// ordinary.
#include "datasets/images/plain_png.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/datasets/recording/formats/tum/tum_folder.hpp"

namespace fusebench {

using namespace images;

namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string covered = type + data;
  const auto sum = crc32_z(0, reinterpret_cast<const unsigned char*>(covered.data()), covered.size());
  return big_endian(static_cast<std::uint32_t>(data.size())) + covered +
         big_endian(static_cast<std::uint32_t>(sum));
}

std::string compressed(const std::string& data) {
  std::vector<unsigned char> target(compressBound(data.size()));
  uLongf size = target.size();
  EXPECT_EQ(compress(target.data(), &size, reinterpret_cast<const unsigned char*>(data.data()), data.size()),
            Z_OK);
  return {target.begin(), target.begin() + static_cast<std::ptrdiff_t>(size)};
}

constexpr int kWidth = 7;
constexpr int kHeight = 20;

/// Random bytes behind filters 0 to 4 in turn.
std::string random_rows(std::size_t pixel_bytes, int width = kWidth) {
  std::mt19937 random(3);
  std::string rows;
  for (int y = 0; y < kHeight; ++y) {
    rows += static_cast<char>((y + 1) % 5);
    for (std::size_t i = 0; i < static_cast<std::size_t>(width) * pixel_bytes; ++i)
      rows += static_cast<char>(random());
  }
  return rows;
}

std::string header(const std::string& layout, int width = kWidth) {
  return chunk("IHDR", big_endian(static_cast<std::uint32_t>(width)) + big_endian(kHeight) + layout);
}

const std::string kSignature("\x89PNG\r\n\x1a\n", 8);
const std::string kColor("\x08\x02\x00\x00\x00", 5);
const std::string kGrey16("\x10\x00\x00\x00\x00", 5);

class PlainPng : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& content) {
    std::ofstream(file_, std::ios::binary) << content;
    return file_;
  }
  bool is_plain(const std::string& chunks) {
    return read_plain_png_color(write(kSignature + chunks)).has_value();
  }
  void TearDown() override { std::filesystem::remove(file_); }

  std::filesystem::path file_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("plain_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".png");
};

/// Samples by the definition of the filters (PNG specification, section 9), one at a time.
std::vector<int> unfiltered(const std::string& rows, int pixel_bytes, int width = kWidth) {
  const int stride = width * pixel_bytes;
  const int height = static_cast<int>(rows.size()) / (stride + 1);
  std::vector<int> samples;
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 ? 0 : samples[static_cast<std::size_t>(y * stride + x)];
  };
  for (int y = 0; y < height; ++y) {
    const auto begin = static_cast<std::size_t>(y * (stride + 1));
    for (int x = 0; x < stride; ++x) {
      const int a = at(x - pixel_bytes, y);
      const int b = at(x, y - 1);
      const int c = at(x - pixel_bytes, y - 1);
      const int p = a + b - c;
      const bool left = std::abs(p - a) <= std::abs(p - b) && std::abs(p - a) <= std::abs(p - c);
      const int paeth = left ? a : std::abs(p - b) <= std::abs(p - c) ? b : c;
      const std::array<int, 5> predictions = {0, a, b, (a + b) / 2, paeth};
      const int raw = static_cast<unsigned char>(rows[begin + 1 + static_cast<std::size_t>(x)]);
      samples.push_back((raw + predictions[static_cast<std::size_t>(rows[begin])]) & 255);
    }
  }
  return samples;
}

void expect_samples(const ColorImage& image, const std::vector<int>& expected) {
  ASSERT_EQ(3 * image.data.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(image.data[i / 3][i % 3], expected[i]) << i;
}

void expect_samples(const Image<std::uint16_t>& image, const std::vector<int>& expected) {
  ASSERT_EQ(2 * image.data.size(), expected.size());
  for (std::size_t i = 0; i < image.data.size(); ++i)
    ASSERT_EQ(image.data[i], 256 * expected[2 * i] + expected[2 * i + 1]) << i;
}

std::string in_three_chunks(const std::string& data) {
  return chunk("IDAT", data.substr(0, 30)) + chunk("IDAT", "") + chunk("IDAT", data.substr(30));
}

/// Widths from less than a vector instruction takes to a few of them.
constexpr std::array<int, 9> kWidths = {1, 2, 3, 5, kWidth, 8, 16, 17, 33};

TEST_F(PlainPng, UndoesAllFiltersOfColor) {
  for (const int width : kWidths) {
    const std::string rows = random_rows(3, width);
    const auto image = read_plain_png_color(
        write(kSignature + header(kColor, width) + in_three_chunks(compressed(rows)) + chunk("IEND", "")));
    ASSERT_TRUE(image.has_value());
    ASSERT_EQ(image->width, width);
    ASSERT_EQ(image->height, kHeight);
    expect_samples(*image, unfiltered(rows, 3, width));
    EXPECT_FALSE(read_plain_png_grey16(file_).has_value());
  }
}

TEST_F(PlainPng, UndoesAllFiltersOfDepth) {
  for (const int width : kWidths) {
    const std::string rows = random_rows(2, width);
    const auto image = read_plain_png_grey16(
        write(kSignature + header(kGrey16, width) + in_three_chunks(compressed(rows)) + chunk("IEND", "")));
    ASSERT_TRUE(image.has_value());
    ASSERT_EQ(image->width, width);
    expect_samples(*image, unfiltered(rows, 2, width));
    EXPECT_FALSE(read_plain_png_color(file_).has_value());
  }
}

/// The rows of a PNG as another library inflates them.
std::string rows_of(const std::filesystem::path& file, std::size_t size) {
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  std::string pixels;
  for (std::size_t at = kSignature.size(); at < content.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(content[at + i]);
    if (content.substr(at + 4, 4) == "IDAT") pixels += content.substr(at + 8, length);
    at += length + 12;
  }
  std::string rows(size, '\0');
  uLongf inflated = size;
  EXPECT_EQ(uncompress(reinterpret_cast<unsigned char*>(rows.data()), &inflated,
                       reinterpret_cast<const unsigned char*>(pixels.data()), pixels.size()),
            Z_OK);
  EXPECT_EQ(inflated, size);
  return rows;
}

TEST_F(PlainPng, ReadsWhatACameraRecorded) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(testing::golden_tum_folder() / "rgb")) {
    const auto image = read_plain_png_color(entry.path());
    ASSERT_TRUE(image.has_value());
    expect_samples(*image, unfiltered(rows_of(entry.path(), 480 * (1 + 3 * 640)), 3, 640));
    ++files;
  }
  for (const auto& entry : std::filesystem::directory_iterator(testing::golden_tum_folder() / "depth")) {
    const auto image = read_plain_png_grey16(entry.path());
    ASSERT_TRUE(image.has_value());
    expect_samples(*image, unfiltered(rows_of(entry.path(), 480 * (1 + 2 * 640)), 2, 640));
    ++files;
  }
  EXPECT_EQ(files, 10);
}

TEST_F(PlainPng, RejectsAllOtherFiles) {
  const std::string head = header(kColor);
  const std::string rows = random_rows(3);
  const std::string pixels = chunk("IDAT", compressed(rows));
  const std::string end = chunk("IEND", "");
  ASSERT_TRUE(is_plain(head + pixels + end));
  EXPECT_TRUE(is_plain(head + chunk("tEXt", "note") + pixels + chunk("tIME", "1234567") + end));

  EXPECT_FALSE(is_plain(head + pixels)) << "no end";
  EXPECT_FALSE(is_plain(pixels + end)) << "no header";
  EXPECT_FALSE(is_plain(head + end)) << "no pixels";
  EXPECT_FALSE(is_plain(head + head + pixels + end)) << "two headers";
  EXPECT_FALSE(is_plain(head + chunk("tRNS", "123456") + pixels + end)) << "transparency";
  EXPECT_FALSE(is_plain(head + chunk("QQQQ", "") + pixels + end)) << "unknown, and needed to understand it";
  const std::string split = compressed(rows);
  EXPECT_FALSE(is_plain(head + chunk("IDAT", split.substr(0, 9)) + chunk("tEXt", "note") +
                        chunk("IDAT", split.substr(9)) + end))
      << "pixels interrupted";
  EXPECT_FALSE(is_plain(header(std::string("\x08\x02\x00\x00\x01", 5)) + pixels + end)) << "interlaced";
  EXPECT_FALSE(is_plain(head + chunk("IDAT", compressed(rows.substr(1))) + end)) << "too few bytes";
  EXPECT_FALSE(is_plain(head + chunk("IDAT", compressed(rows + "1")) + end)) << "too many bytes";
  std::string wrong_filter = rows;
  wrong_filter[0] = 5;
  EXPECT_FALSE(is_plain(head + chunk("IDAT", compressed(wrong_filter)) + end)) << "no such filter";
  std::string wrong_sum = pixels;
  wrong_sum.back() = static_cast<char>(wrong_sum.back() ^ 1);
  EXPECT_FALSE(is_plain(head + wrong_sum + end)) << "checksum";
  std::string huge = chunk("IHDR", big_endian(1U << 31) + big_endian(1U << 31) + kColor);
  EXPECT_FALSE(is_plain(huge + pixels + end)) << "size";
  EXPECT_FALSE(read_plain_png_color("/nowhere/at/all.png").has_value());
  EXPECT_FALSE(read_plain_png_color(::testing::TempDir()).has_value()) << "a folder";
}

// The chunks of these files are valid: only the checksum within the compressed pixels shows the damage.
TEST_F(PlainPng, NoticesDamagedPixels) {
  std::string rows = random_rows(3);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = i % (1 + 3 * kWidth) == 0 ? rows[i] : rows[i] & 3;
  const std::string stream = compressed(rows);
  const auto with_stream = [&](const std::string& data) {
    return header(kColor) + chunk("IDAT", data) + chunk("IEND", "");
  };
  ASSERT_TRUE(is_plain(with_stream(stream)));
  const ColorImage sound = read_plain_png_color(file_).value();
  for (std::size_t size = 0; size < stream.size(); ++size)
    EXPECT_FALSE(is_plain(with_stream(stream.substr(0, size)))) << size;
  int harmless = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    std::string damaged = stream;
    damaged[i] = static_cast<char>(damaged[i] ^ 1 << i % 8);
    if (!is_plain(with_stream(damaged))) continue;
    EXPECT_EQ(read_plain_png_color(file_).value().data, sound.data) << i;
    ++harmless;
  }
  EXPECT_LE(harmless, 2) << "hardly a bit says nothing of the pixels";
}

}  // namespace
}  // namespace fusebench
