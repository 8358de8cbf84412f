// Designs of sweeps: how many points, which, and the same everywhere.
#include "eval/suites/sweep_design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/config/toml_document.hpp"

namespace fusebench {

using namespace config;
using namespace suites;

namespace {

Result<std::vector<SweepBlock>> read_sweep(const std::string& text) {
  const auto document = parse_toml(text, "s.toml");
  EXPECT_TRUE(document.has_value());
  return read_sweeps(entry_tables(*document, "sweep"));
}

std::vector<std::string> points_of(const std::string& text) {
  const auto blocks = read_sweep(text);
  EXPECT_TRUE(blocks.has_value()) << blocks.error().message;
  const auto points = sweep_points(*blocks);
  EXPECT_TRUE(points.has_value()) << points.error().message;
  std::vector<std::string> texts;
  for (const SweepPoint& point : *points) texts.push_back(to_string(point));
  return texts;
}

void expect_refused(const std::string& text, const std::string& part) {
  const auto blocks = read_sweep(text);
  ASSERT_FALSE(blocks.has_value()) << text;
  EXPECT_EQ(blocks.error().code, ErrorCode::configuration);
  EXPECT_NE(blocks.error().message.find(part), std::string::npos) << blocks.error().message;
}

TEST(SweepDesign, AGridIsEveryValueWithEveryOther) {
  EXPECT_EQ(points_of("[[sweep]]\niekf.max_iterations = [1, 2]\ntsdf.voxel_m = [0.01, 0.02]\n"),
            (std::vector<std::string>{
                "iekf.max_iterations=1 tsdf.voxel_m=0.01", "iekf.max_iterations=1 tsdf.voxel_m=0.02",
                "iekf.max_iterations=2 tsdf.voxel_m=0.01", "iekf.max_iterations=2 tsdf.voxel_m=0.02"}));
}

TEST(SweepDesign, AZipGoesSideBySide) {
  EXPECT_EQ(
      points_of(
          "[[sweep]]\ndesign = \"zip\"\ntsdf.voxel_m = [0.01, 0.02]\ntsdf.truncation_m = [0.04, 0.08]\n"),
      (std::vector<std::string>{"tsdf.voxel_m=0.01 tsdf.truncation_m=0.04",
                                "tsdf.voxel_m=0.02 tsdf.truncation_m=0.08"}));
}

TEST(SweepDesign, BlocksMultiply) {
  EXPECT_EQ(
      points_of("[[sweep]]\ndesign = \"zip\"\ntsdf.voxel_m = [0.01, 0.02]\ntsdf.truncation_m = [0.04, 0.08]\n"
                "[[sweep]]\niekf.max_iterations = [1, 2, 3]\n")
          .size(),
      6U);
}

TEST(SweepDesign, RangesHaveBothEnds) {
  EXPECT_EQ(points_of("[[sweep]]\ntsdf.voxel_m = { from = 0.01, to = 0.03, steps = 3 }\n"),
            (std::vector<std::string>{"tsdf.voxel_m=0.01", "tsdf.voxel_m=0.02", "tsdf.voxel_m=0.03"}));
  EXPECT_EQ(points_of("[[sweep]]\ntsdf.voxel_m = { from = 0.005, to = 0.02, steps = 3, scale = \"log\" }\n"),
            (std::vector<std::string>{"tsdf.voxel_m=0.005", "tsdf.voxel_m=0.01", "tsdf.voxel_m=0.02"}));
  // Of integers, values that round to the same are one point.
  EXPECT_EQ(points_of("[[sweep]]\niekf.max_iterations = { from = 1, to = 3, steps = 9 }\n").size(), 3U);
}

TEST(SweepDesign, ALatinHypercubeHasOneSampleInEachPart) {
  const auto blocks = read_sweep(
      "[[sweep]]\ndesign = \"latin-hypercube\"\nsamples = 20\nseed = 3\n"
      "tsdf.voxel_m = { from = 0.01, to = 0.03 }\ntsdf.truncation_m = { from = 0.1, to = 1.0, scale = "
      "\"log\" }\n");
  ASSERT_TRUE(blocks.has_value()) << blocks.error().message;
  const auto points = sweep_points(*blocks);
  ASSERT_EQ(points->size(), 20U);
  std::set<int> linear;
  std::set<int> logarithmic;
  for (const SweepPoint& point : *points) {
    linear.insert(static_cast<int>((std::get<double>(point[0].second) - 0.01) / 0.02 * 20));
    logarithmic.insert(static_cast<int>(std::log10(std::get<double>(point[1].second) / 0.1) * 20));
  }
  EXPECT_EQ(linear.size(), 20U);
  EXPECT_EQ(logarithmic.size(), 20U);
}

TEST(SweepDesign, SamplesDependOnTheSeedAlone) {
  const std::string text =
      "[[sweep]]\ndesign = \"random\"\nsamples = 50\nseed = SEED\ntsdf.voxel_m = { from = 0.01, to = 0.03 }\n"
      "iekf.max_iterations = [1, 2, 4]\n";
  const auto with_seed = [&](const std::string& seed) {
    std::string changed = text;
    return points_of(changed.replace(changed.find("SEED"), 4, seed));
  };
  EXPECT_EQ(with_seed("5"), with_seed("5"));
  EXPECT_NE(with_seed("5"), with_seed("6"));
  // The same on every machine and with every standard library.
  EXPECT_EQ(with_seed("5").front(), with_seed("5").front());
  EXPECT_EQ(with_seed("5").size(), 50U);
}

TEST(SweepDesign, SetsWithSeveralValuesAreAGrid) {
  std::vector<std::string> sets = {"iekf.max_iterations=1,2,4", "tsdf.voxel_m=0.01"};
  const auto block = take_swept_sets(sets);
  ASSERT_TRUE(block.has_value() && block->has_value());
  EXPECT_EQ(sets, (std::vector<std::string>{"tsdf.voxel_m=0.01"}));
  EXPECT_EQ(sweep_points({**block})->size(), 3U);
  sets = {"iekf.max_iterations=1,,4"};
  EXPECT_FALSE(take_swept_sets(sets).has_value());
}

TEST(SweepDesign, WhatMakesNoSenseIsRefusedWithItsLine) {
  expect_refused("[[sweep]]\niekf.max_iteration = [1]\n",
                 "s.toml:2: unknown option 'iekf.max_iteration' in a sweep (nearest: iekf.max_iterations)");
  expect_refused("[[sweep]]\niekf.max_iterations = 4\n", "a list of values, or a range");
  expect_refused("[[sweep]]\nsamples = 4\n", "names no option");
  expect_refused("[[sweep]]\ndesign = \"random\"\niekf.max_iterations = [1]\n", "samples is missing");
  expect_refused("[[sweep]]\nsamples = 3\niekf.max_iterations = [1]\n", "samples is for");
  expect_refused("[[sweep]]\ntsdf.voxel_m = { from = 0.02, to = 0.01, steps = 3 }\n", "from must be less");
  expect_refused("[[sweep]]\ntsdf.voxel_m = { from = 0.0, to = 0.01, steps = 3, scale = \"log\" }\n",
                 "must be positive");
  expect_refused("[[sweep]]\ntsdf.voxel_m = { from = 0.01, to = 0.02 }\n", "lacks steps");
  expect_refused("[[sweep]]\ndesign = \"zip\"\ntsdf.voxel_m = [0.01]\ntsdf.truncation_m = [0.04, 0.05]\n",
                 "lists of one length");
  expect_refused("[[sweep]]\ntsdf.voxel_m = [0.01]\n[[sweep]]\ntsdf.voxel_m = [0.02]\n", "swept twice");
  expect_refused("[[sweep]]\ntsdf.voxel_m = { from = 0.01, steps = 3 }\n",
                 "s.toml:2: the range of tsdf.voxel_m lacks to");
  expect_refused(
      "[[sweep]]\ndesign = \"random\"\nsamples = 3\ntsdf.voxel_m = { from = 0.01, to = 0.02, steps = 3 }\n",
      "has steps");
  expect_refused("[[sweep]]\ntsdf.voxel_m = [0.01, 99.0]\n", "s.toml:2");
  const auto blocks = read_sweep("[[sweep]]\ndesign = \"random\"\nsamples = 100001\ntsdf.voxel_m = [0.01]\n");
  ASSERT_TRUE(blocks.has_value());
  EXPECT_EQ(sweep_points(*blocks).error().code, ErrorCode::configuration);
  EXPECT_EQ(sweep_points(*blocks).error().message, "the sweep has 100001 points (allowed: up to 100000)");
}

}  // namespace
}  // namespace fusebench
