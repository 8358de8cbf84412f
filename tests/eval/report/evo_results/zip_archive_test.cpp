#include "eval/report/evo_results/zip_archive.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace evo_results;

namespace {

class ZipArchive : public testing::InTemporaryFolder {
 protected:
  void expect_refused(const std::string& bytes, std::string_view part) {
    const auto file = write("broken.zip", bytes);
    const auto entries = read_zip(file);
    ASSERT_FALSE(entries.has_value()) << part;
    EXPECT_EQ(entries.error().code, ErrorCode::data_corrupt);
    EXPECT_TRUE(entries.error().message.starts_with(file.string() + ": ")) << entries.error().message;
    EXPECT_NE(entries.error().message.find(part), std::string::npos) << entries.error().message;
  }
};

std::string three_files() {
  return zip_bytes({{"info.json", "{}"}, {"folder/a.npy", std::string("\0\x01\xFF", 3)}, {"empty", ""}})
      .value();
}

/// By Python's zipfile: one file "zeros" of 3000 times '0', deflated.
constexpr std::string_view kDeflated(
    "\x50\x4b\x03\x04\x14\x00\x00\x00\x08\x00\x00\x00\x21\x00\xdc\x77\xf3\x9c\x15\x00"
    "\x00\x00\xb8\x0b\x00\x00\x05\x00\x00\x00\x7a\x65\x72\x6f\x73\xed\xc1\x31\x01\x00"
    "\x00\x00\xc2\xa0\x4a\xeb\x9f\xce\x1a\x1e\x40\x01\x00\x00\xef\x06\x50\x4b\x01\x02"
    "\x14\x03\x14\x00\x00\x00\x08\x00\x00\x00\x21\x00\xdc\x77\xf3\x9c\x15\x00\x00\x00"
    "\xb8\x0b\x00\x00\x05\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x80\x01\x00\x00"
    "\x00\x00\x7a\x65\x72\x6f\x73\x50\x4b\x05\x06\x00\x00\x00\x00\x01\x00\x01\x00\x33"
    "\x00\x00\x00\x38\x00\x00\x00\x00\x00",
    129);

TEST_F(ZipArchive, DeflatedFilesAreRead) {
  const auto entries = read_zip(write("deflated.zip", kDeflated));
  ASSERT_TRUE(entries.has_value()) << entries.error().message;
  ASSERT_EQ(entries->size(), 1U);
  EXPECT_EQ((*entries)[0].name, "zeros");
  EXPECT_EQ((*entries)[0].bytes, std::string(3000, '0'));
}

TEST_F(ZipArchive, WhatIsWrittenIsReadBack) {
  const auto entries = read_zip(write("three.zip", three_files()));
  ASSERT_TRUE(entries.has_value()) << entries.error().message;
  ASSERT_EQ(entries->size(), 3U);
  EXPECT_EQ((*entries)[0].name, "info.json");
  EXPECT_EQ((*entries)[0].bytes, "{}");
  EXPECT_EQ((*entries)[1].name, "folder/a.npy");
  EXPECT_EQ((*entries)[1].bytes, std::string("\0\x01\xFF", 3));
  EXPECT_EQ((*entries)[2].bytes, "");
  EXPECT_TRUE(read_zip(write("none.zip", zip_bytes({}).value()))->empty());
  EXPECT_EQ(three_files(), three_files());
}

TEST_F(ZipArchive, ACommentMayFollow) {
  std::string bytes = three_files();
  bytes[bytes.size() - 2] = 5;
  EXPECT_EQ(read_zip(write("comment.zip", bytes + "hello"))->size(), 3U);
}

TEST_F(ZipArchive, DamageIsToldByEveryByte) {
  const std::string whole = three_files();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read_zip(write("cut.zip", whole.substr(0, size))).has_value()) << size;
  std::string flipped = whole;
  flipped[flipped.find("\x01\xFF")] = 2;
  expect_refused(flipped, "CRC-32");
  std::string encrypted = whole;
  encrypted[encrypted.find("PK\x01\x02") + 8] |= 1;
  expect_refused(encrypted, "encrypted");
  std::string method = whole;
  method[method.find("PK\x01\x02") + 10] = 12;
  expect_refused(method, "method 12");
  expect_refused("no archive at all, but longer than a directory's end", "no ZIP archive");
}

TEST_F(ZipArchive, SizesAreBelievedOnlyAsFarAsBytesGo) {
  std::string bytes = three_files();
  const std::size_t directory = bytes.find("PK\x01\x02");
  bytes[directory + 10] = 8;       // deflated
  bytes[directory + 27] = '\x30';  // 768 MiB
  expect_refused(bytes, "does not unpack");
  bytes[directory + 27] = '\x7F';  // 2 GiB
  expect_refused(bytes, "more than 1 GiB");
  bytes.replace(directory + 24, 4, "\xFF\xFF\xFF\xFF");
  expect_refused(bytes, "64-bit extension");
}

TEST_F(ZipArchive, AFileThatIsNotThere) {
  EXPECT_EQ(read_zip("/absent/result.zip").error().code, ErrorCode::data_missing);
}

}  // namespace
}  // namespace fusebench
