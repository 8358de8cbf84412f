#include "eval/suites/acceptance_criteria.hpp"

#include <gtest/gtest.h>

namespace fusebench {

using namespace config;
using namespace suites;

namespace {

Result<std::vector<Criterion>> read(const std::string& text, std::string_view reference = "full") {
  const auto document = parse_toml(text, "suite.toml");
  if (!document) return tl::unexpected(document.error());
  return read_criteria(entry_tables(*document, "criteria"), reference);
}

constexpr const char* kHead = "[[criteria]]\ntitle = \"t\"\nvariant = \"full\"\n";

TEST(SuiteCriteriaTest, ReadsEveryKey) {
  const auto criteria = read(
      "[[criteria]]\ntitle = \"t\"\ngroups = [\"a\", \"b\"]\nsplit = \"tuning\"\nvariant = \"dm\"\n"
      "metric = \"aie_common_grey\"\nstatistic = \"mean\"\nagainst = \"full\"\ncompare = \"difference\"\n"
      "of_means = true\nframes_above_px = 30\nat_least = 1.75\nat_most = 9\n");
  ASSERT_TRUE(criteria.has_value()) << criteria.error().message;
  ASSERT_EQ(criteria->size(), 1U);
  const Criterion& criterion = criteria->front();
  EXPECT_EQ(criterion.groups, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(criterion.split, "tuning");
  EXPECT_EQ(criterion.variant, "dm");
  EXPECT_EQ(criterion.against, "full");
  EXPECT_EQ(criterion.compare, CriterionComparison::difference);
  EXPECT_TRUE(criterion.of_means);
  EXPECT_DOUBLE_EQ(*criterion.frames_above_px, 30);
  EXPECT_DOUBLE_EQ(*criterion.at_least, 1.75);
  EXPECT_DOUBLE_EQ(*criterion.at_most, 9);
  EXPECT_EQ(criterion.place, "suite.toml:1");
}

TEST(SuiteCriteriaTest, CommonPixelsAreThoseOfTheVariantThatTheSuiteNamesFirst) {
  const std::string criterion =
      "[[criteria]]\ntitle = \"t\"\nvariant = \"planar\"\nagainst = \"literal\"\nmetric = "
      "\"aie_common_grey\"\n"
      "statistic = \"mean\"\nat_most = 1\n";
  EXPECT_TRUE(read(criterion, "literal").has_value());
  const auto refused = read(criterion, "full");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("compares a variant with full"), std::string::npos)
      << refused.error().message;
}

TEST(SuiteCriteriaTest, ListsMakeACriterionEach) {
  const auto criteria = read(std::string(kHead) +
                             "metric = [\"ate_rmse_m\", \"aie_grey\"]\nagainst = [\"dm\", \"planar\"]\n"
                             "statistic = \"worst\"\nbelow = 1\n");
  ASSERT_TRUE(criteria.has_value()) << criteria.error().message;
  ASSERT_EQ(criteria->size(), 4U);
  EXPECT_EQ((*criteria)[1].title, "t: ate_rmse_m (planar)");
  EXPECT_EQ((*criteria)[2].metric, "aie_grey");
  EXPECT_EQ((*criteria)[2].split, "held-out");

  const auto variants = read(
      "[[criteria]]\ntitle = \"t\"\nvariant = [\"full\", \"no-imu\"]\nmetric = \"silent_failures\"\n"
      "statistic = \"worst\"\nat_most = 0\n");
  ASSERT_TRUE(variants.has_value()) << variants.error().message;
  ASSERT_EQ(variants->size(), 2U);
  EXPECT_EQ((*variants)[1].variant, "no-imu");
  EXPECT_EQ((*variants)[1].title, "t (no-imu)");
}

TEST(SuiteCriteriaTest, WhatMakesNoSenseIsRefusedWithItsLine) {
  const auto refused = [](const std::string& rest, const std::string& place, const std::string& part) {
    const auto criteria = read(kHead + rest);
    ASSERT_FALSE(criteria.has_value()) << rest;
    EXPECT_EQ(criteria.error().code, ErrorCode::configuration);
    EXPECT_TRUE(criteria.error().message.starts_with("suite.toml" + place + ":")) << criteria.error().message;
    EXPECT_NE(criteria.error().message.find(part), std::string::npos) << criteria.error().message;
  };
  const std::string ate = "metric = \"ate_rmse_m\"\n";
  const std::string worst = "statistic = \"worst\"\n";
  refused("metric = \"ate_rmse\"\n", ":4", "nearest: ate_rmse_m");
  refused(ate + "statistic = \"best\"\n", ":5", "worst, mean, median, share");
  refused(ate + worst, ":1", "at_most");
  refused(ate + "at_most = 1\n", ":1", "'statistic' is missing");
  refused(ate + worst + "at_most = \"1\"\n", ":6", "number");
  refused(ate + worst + "at_most = 1\nbelow = 2\n", ":1", "one limit on a side");
  refused(ate + worst + "at_most = 1\nat_least = 0\n", ":1", "one side");
  refused(ate + worst + "atmost = 1\n", ":6", "nearest: at_most");
  refused(ate + worst + "at_most = 1\nagainst = \"dmm\"\n", ":7", "dm");
  refused(ate + worst + "at_most = 1\neach_at_least = 5\n", ":1", "share");
  refused(ate + "statistic = \"share\"\nat_least = 0.5\n", ":1", "each_at_least");
  refused(ate + worst + "at_most = 1\nlost_counts = true\n", ":1", "lost_counts");
  refused(ate + "statistic = \"mean\"\nwithin_bounds = true\n", ":1", "nees_");
  refused(ate + "statistic = \"mean\"\nat_most = 1\nof_means = true\n", ":1", "against");
  refused(ate + "statistic = \"mean\"\nat_most = 1\nagainst = \"dm\"\nframes_above_px = 30\n", ":1",
          "aie_common_grey");
  refused("metric = \"aie_common_grey\"\n" + worst + "at_most = 1\n", ":1", "compares a variant with full");
  refused(ate + worst + "at_most = 1\nsplit = \"left\"\n", ":7", "tuning");
  const auto unknown =
      read("[[criteria]]\ntitle = \"t\"\nvariant = [\"full\", \"no-imo\"]\n" + ate + worst + "at_most = 1\n");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_NE(unknown.error().message.find("suite.toml:3"), std::string::npos) << unknown.error().message;
}

}  // namespace
}  // namespace fusebench
