// Files of a size that nobody expects: read or refused, within bounded memory.
#include <gtest/gtest.h>

#include <fstream>

#include "core/config/toml_document.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "tests/datasets/images/child_process.hpp"
#include "tests/datasets/malformed_text.hpp"

namespace fusebench {

using namespace config;
using namespace recording;
using namespace reading;

namespace {

namespace fs = std::filesystem;
using namespace testing;

constexpr std::size_t kRows = 10'000'000;
constexpr std::size_t kMegabyte = 1 << 20;

/// imu.csv with ten million samples at 1 kHz.
void write_rows(const fs::path& file) {
  std::ofstream stream(file, std::ios::binary);
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < kRows; ++i) {
    fmt::format_to(std::back_inserter(text), "{},0,0,{},0,0,9\n", 1'000'000 * (i + 1), i % 10);
    if (text.size() < kMegabyte && i + 1 < kRows) continue;
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
  }
}

std::string read_samples(const fs::path& folder) {
  Recording recording;
  if (const auto read = read_imu_beside(folder, recording); !read) return read.error().message;
  const ImuSample& last = recording.imu.back();
  return fmt::format("{} samples, the last at {} with {}", recording.imu.size(), last.timestamp_ns,
                     last.angular_velocity_radps.z());
}

/// Samples lie in a vector, which holds up to twice of them and copies itself when it grows.
void expect_bounded(const ChildResult& result) {
  EXPECT_TRUE(result.ended_well);
  if (!kMemoryIsMeasured) return;
  EXPECT_LT(result.peak_bytes, 2 * kRows * sizeof(ImuSample) + 256 * kMegabyte);
}

TEST(MalformedSize, TenMillionRows) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "imu.csv";
  write_rows(file);
  const auto read = [&] { return read_samples(folder.path()); };
  const ChildResult whole = run_in_child(4096 * kMegabyte, read);
  EXPECT_EQ(whole.text, "10000000 samples, the last at 10000000000000 with 9");
  expect_bounded(whole);
  RecordProperty("peak_mb", static_cast<int>(whole.peak_bytes / kMegabyte));

  std::ofstream(file, std::ios::app) << "10000001000000,0,0,x,0,0,9\n";
  const ChildResult broken = run_in_child(4096 * kMegabyte, read);
  EXPECT_EQ(broken.text, file.string() + ":10000001: wz: expected a finite number, got 'x'");
  expect_bounded(broken);
}

TEST(MalformedSize, OneLineOfManyMegabytes) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("rgb.txt", std::string(64 * kMegabyte, '1'));
  const ChildResult result = run_in_child(64 * kMegabyte, [&] {
    std::vector<std::string> warnings;
    return read_image_list(file, warnings).error().message;
  });
  EXPECT_NE(result.text.find("rgb.txt:1: line is longer than 65536 characters"), std::string::npos)
      << result.text;
}

TEST(MalformedSize, TomlOfManyMegabytes) {
  const TemporaryFolder folder;
  const fs::path file =
      folder.write("calibration.toml", "a = \"" + std::string(64 * kMegabyte, 'x') + "\"\n");
  const ChildResult result = run_in_child(64 * kMegabyte, [&] { return read_toml(file).error().message; });
  EXPECT_EQ(result.text, file.string() + ": more than 1048576 bytes are too many for a TOML file");
}

}  // namespace
}  // namespace fusebench
