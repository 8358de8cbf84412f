#include "eval/suites/suite_bars.hpp"

#include <gtest/gtest.h>

namespace fusebench {

using namespace config;
using namespace suites;

namespace {

Result<std::vector<Bar>> read(const std::string& text, std::string_view reference = "full") {
  const auto document = parse_toml(text, "suite.toml");
  if (!document) return tl::unexpected(document.error());
  return read_bars(entry_tables(*document, "bars"), reference);
}

constexpr const char* kHead = "[[bars]]\ntitle = \"t\"\nvariant = \"full\"\n";

TEST(SuiteBarsTest, ReadsEveryKey) {
  const auto bars = read(
      "[[bars]]\ntitle = \"t\"\ngroups = [\"a\", \"b\"]\nhalf = \"tuning\"\nvariant = \"dm\"\n"
      "metric = \"aie_common_grey\"\nstatistic = \"mean\"\nagainst = \"full\"\ncompare = \"difference\"\n"
      "of_means = true\nframes_above_px = 30\nat_least = 1.75\nat_most = 9\n");
  ASSERT_TRUE(bars.has_value()) << bars.error().message;
  ASSERT_EQ(bars->size(), 1U);
  const Bar& bar = bars->front();
  EXPECT_EQ(bar.groups, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(bar.half, "tuning");
  EXPECT_EQ(bar.variant, "dm");
  EXPECT_EQ(bar.against, "full");
  EXPECT_EQ(bar.compare, BarComparison::difference);
  EXPECT_TRUE(bar.of_means);
  EXPECT_DOUBLE_EQ(*bar.frames_above_px, 30);
  EXPECT_DOUBLE_EQ(*bar.at_least, 1.75);
  EXPECT_DOUBLE_EQ(*bar.at_most, 9);
  EXPECT_EQ(bar.place, "suite.toml:1");
}

TEST(SuiteBarsTest, CommonPixelsAreThoseOfTheVariantThatTheSuiteNamesFirst) {
  const std::string bar =
      "[[bars]]\ntitle = \"t\"\nvariant = \"planar\"\nagainst = \"literal\"\nmetric = \"aie_common_grey\"\n"
      "statistic = \"mean\"\nat_most = 1\n";
  EXPECT_TRUE(read(bar, "literal").has_value());
  const auto refused = read(bar, "full");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("compares a variant with full"), std::string::npos)
      << refused.error().message;
}

TEST(SuiteBarsTest, ListsMakeABarEach) {
  const auto bars = read(std::string(kHead) +
                         "metric = [\"ate_rmse_m\", \"aie_grey\"]\nagainst = [\"dm\", \"planar\"]\n"
                         "statistic = \"worst\"\nbelow = 1\n");
  ASSERT_TRUE(bars.has_value()) << bars.error().message;
  ASSERT_EQ(bars->size(), 4U);
  EXPECT_EQ((*bars)[1].title, "t: ate_rmse_m (planar)");
  EXPECT_EQ((*bars)[2].metric, "aie_grey");
  EXPECT_EQ((*bars)[2].half, "held-out");
}

TEST(SuiteBarsTest, WhatMakesNoSenseIsRefusedWithItsLine) {
  const auto refused = [](const std::string& rest, const std::string& place, const std::string& part) {
    const auto bars = read(kHead + rest);
    ASSERT_FALSE(bars.has_value()) << rest;
    EXPECT_EQ(bars.error().code, ErrorCode::configuration);
    EXPECT_TRUE(bars.error().message.starts_with("suite.toml" + place + ":")) << bars.error().message;
    EXPECT_NE(bars.error().message.find(part), std::string::npos) << bars.error().message;
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
  refused(ate + worst + "at_most = 1\nhalf = \"left\"\n", ":7", "tuning");
}

}  // namespace
}  // namespace fusebench
