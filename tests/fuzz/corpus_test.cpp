// Replays the committed inputs of the fuzz targets, among them every input that once broke one.
#include <gtest/gtest.h>

#include <algorithm>
#include <exception>

#include "tests/fuzz/targets.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::fuzz {
namespace {

std::vector<std::filesystem::path> inputs_of(const Target& target) {
  const auto folder = std::filesystem::path(__FILE__).parent_path() / "corpus" / target.name;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

class FuzzCorpus : public ::testing::TestWithParam<Target> {};

TEST_P(FuzzCorpus, EveryPropertyHolds) {
  const auto files = inputs_of(GetParam());
  ASSERT_FALSE(files.empty());
  for (const auto& file : files) {
    const std::string bytes = testing::read_bytes(file);
    EXPECT_NO_THROW(GetParam().run(bytes)) << file;
    // A recording that was cut off or is still being written.
    EXPECT_NO_THROW(GetParam().run(std::string_view(bytes).substr(0, bytes.size() / 2))) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzCorpus, ::testing::ValuesIn(kTargets),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace fusebench::fuzz
