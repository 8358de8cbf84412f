#include "datasets/images/exr_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "datasets/images/image_files.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/repository.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;

namespace {

std::filesystem::path golden_exr(const char* name) {
  return testing::repository_root() / "tests" / "golden" / "record3d" / name;
}

/// Replaces the number after a text that occurs once.
std::string with_number(std::string exr, const std::string& behind, std::size_t skipped,
                        std::uint32_t number) {
  const std::size_t at = exr.find(behind);
  EXPECT_NE(at, std::string::npos) << behind;
  for (std::size_t i = 0; i < sizeof(number); ++i)
    exr.at(at + behind.size() + skipped + i) = static_cast<char>(number >> (8 * i));
  return exr;
}

class ExrFile : public testing::InTemporaryFolder {
 protected:
  std::string refusal_of(const std::string& bytes) const {
    const auto read = read_float(write("depth.exr", bytes));
    if (read) return "was not refused";
    EXPECT_EQ(read.error().code, ErrorCode::data_corrupt);
    return read.error().message;
  }
};

// The decoder would fill a gigabyte with zeros first.
TEST_F(ExrFile, AnAttributeIsNotLongerThanTheFile) {
  const std::string whole = testing::read_bytes(golden_exr("half.exr"));
  const std::string type = std::string("capDate\0string\0", 15);
  testing::expect_contains(refusal_of(with_number(whole, type, 0, 0x3F800000)),
                           "damaged OpenEXR (its header claims 1065353216 bytes for 'capDate'");
  testing::expect_contains(refusal_of(with_number(whole, type, 0, 0xFFFFFFFF)), "claims 4294967295 bytes");
}

TEST_F(ExrFile, AHeaderEnds) {
  const std::string whole = testing::read_bytes(golden_exr("half.exr"));
  const std::size_t end = whole.find("screenWindowWidth");
  for (std::size_t size = 8; size < end; size += 7)
    testing::expect_contains(refusal_of(whole.substr(0, size)), "depth.exr: damaged OpenEXR (its header ");
  testing::expect_contains(refusal_of(whole.substr(0, 8) + std::string(1000, 'a')),
                           "has no end in 1008 bytes");
}

TEST_F(ExrFile, ASmallFileDoesNotHaveMillionsOfPixels) {
  std::string claims = testing::read_bytes(golden_exr("float.exr"));
  const std::string window = std::string("dataWindow\0box2i\0", 17);
  claims = with_number(claims, window, 4 + 8, 8191);
  claims = with_number(claims, window, 4 + 12, 8190);
  testing::expect_contains(refusal_of(claims + std::string(10'000, '\0')), "bytes are too few for so many");
}

TEST_F(ExrFile, WhatIsPackedTightlyIsRead) {
  for (const char* name : {"flat_zip.exr", "flat_pxr24.exr", "flat_dwab.exr"}) {
    EXPECT_EQ(exr_damage(golden_exr(name)), "");
    const auto read = read_float(golden_exr(name));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->height, 2048);
    EXPECT_EQ(std::ranges::count(read->data, 0.0F), std::ssize(read->data)) << name;
  }
}

TEST_F(ExrFile, WhatIsNoOpenExrIsLeftToOthers) {
  for (const char* content : {"", "v/1", "no image at all"})
    EXPECT_EQ(exr_damage(write("a.exr", content)), "");
  EXPECT_EQ(exr_damage(folder_ / "absent.exr"), "");
}

TEST_F(ExrFile, TheFirstOfSeveralChannelsIsRead) {
  const auto read = read_float(golden_exr("three_channels.exr"), ImageSize{4, 3});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(std::ranges::count(read->data, 1.5F), 12);
}

}  // namespace
}  // namespace fusebench
