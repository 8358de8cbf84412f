#include "eval/text/text_layout.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace fusebench::text {

namespace {

const std::vector<std::vector<std::string>> kLines = {
    {"option", "meaning", "range"},
    {"tsdf.voxel_m", "edge of a voxel of the model, which memory and time depend on", "0.001 .. 0.1"},
    {"a.b", "short", "x"}};

TEST(FittedColumns, NeedNoBreaksWhereThereIsRoom) {
  EXPECT_EQ(fitted_columns(kLines, 200), aligned_columns(kLines));
}

TEST(FittedColumns, FitTheWidthAndKeepEveryWord) {
  std::istringstream lines(fitted_columns(kLines, 60));
  std::string line, words;
  std::size_t count = 0;
  while (std::getline(lines, line)) {
    EXPECT_LE(line.size(), 60U) << line;
    EXPECT_TRUE(line.empty() || line.back() != ' ');
    ++count;
    words += line + " ";
  }
  EXPECT_GT(count, kLines.size());
  for (const char* word : {"tsdf.voxel_m", "memory", "depend", "0.001 .. 0.1"})
    EXPECT_NE(words.find(word), std::string::npos) << word;
}

TEST(FittedColumns, BreakNamesOnlyWhereBlanksAreNotEnough) {
  const std::vector<std::vector<std::string>> lines = {
      {"self_calibration.timing_walk", "of the prior's sigma"}};
  EXPECT_NE(fitted_columns(lines, 43).find("self_calibration.timing_walk  "), std::string::npos);
  EXPECT_EQ(fitted_columns(lines, 37),
            "self_calibration.  of the prior's\n"
            "timing_walk        sigma\n");
}

}  // namespace

}  // namespace fusebench::text
