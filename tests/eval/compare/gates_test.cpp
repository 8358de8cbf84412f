#include "eval/compare/gates.hpp"
#include "tests/support/repository.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace fusebench {

using namespace compare;

namespace {

std::size_t metric(std::string_view key) {
  const auto metrics = gated_metrics();
  const auto found = std::ranges::find(metrics, key, &registry::RunMetric::key);
  EXPECT_NE(found, metrics.end()) << key;
  return static_cast<std::size_t>(found - metrics.begin());
}

std::string refusal(std::string_view text) {
  const auto gates = parse_gates(text, "gates.toml");
  if (gates) return "accepted";
  EXPECT_EQ(gates.error().code, ErrorCode::configuration) << gates.error().message;
  return gates.error().message;
}

TEST(GatesTest, TheShippedFileHasTheDefaults) {
  const auto file = testing::repository_root() / "configs/gates.toml";
  const auto shipped = read_gates(file);
  ASSERT_TRUE(shipped.has_value()) << shipped.error().message;
  const Gates defaults;
  EXPECT_EQ(shipped->improvements_fail, defaults.improvements_fail);
  EXPECT_EQ(shipped->changed_defaults_fail, defaults.changed_defaults_fail);
  EXPECT_EQ(shipped->changed_simulation_fails, defaults.changed_simulation_fails);
  EXPECT_EQ(shipped->divergence_fails, defaults.divergence_fails);
  EXPECT_EQ(shipped->repetitions_fail, defaults.repetitions_fail);
  EXPECT_EQ(shipped->alpha, defaults.alpha);
  EXPECT_EQ(shipped->min_repetitions, defaults.min_repetitions);
  EXPECT_EQ(shipped->factors, defaults.factors);
  EXPECT_TRUE(shipped->overrides.empty());
  for (std::size_t i = 0; i < gated_metrics().size(); ++i) {
    EXPECT_EQ(shipped->tolerances[i].relative, defaults.tolerances[i].relative) << gated_metrics()[i]->key;
    EXPECT_EQ(shipped->tolerances[i].absolute, defaults.tolerances[i].absolute) << gated_metrics()[i]->key;
    EXPECT_EQ(shipped->tolerances[i].better, defaults.tolerances[i].better) << gated_metrics()[i]->key;
  }
}

TEST(GatesTest, TablesAndOverridesAreRead) {
  const auto gates = parse_gates(R"(
improvements = "report"
[metrics.ate_rmse_m]
absolute = 0.001
better = "equal"
[tolerance]
relative = 0.01
[timing]
alpha = 0.05
min_repetitions = 4
[timing.factors]
wall_s = 2
[[overrides]]
recordings = ["fr1_*", "office"]
variants = "full"
relative = 0.5
[[overrides]]
metrics = ["frames_tracked", "wall_s"]
absolute = 2
factor = 3
)",
                                 "gates.toml");
  ASSERT_TRUE(gates.has_value()) << gates.error().message;
  EXPECT_FALSE(gates->improvements_fail);
  const MetricTolerance ate = gates->tolerance(metric("ate_rmse_m"), "office", "dm");
  EXPECT_EQ(ate.relative, 0.01);
  EXPECT_EQ(ate.absolute, 0.001);
  EXPECT_EQ(ate.better, registry::Better::neither);
  EXPECT_EQ(gates->tolerance(metric("aie_grey"), "fr1_rpy", "full").relative, 0.5);
  EXPECT_EQ(gates->tolerance(metric("aie_grey"), "fr2_rpy", "full").relative, 0.01);
  EXPECT_EQ(gates->tolerance(metric("aie_grey"), "office_2", "full").relative, 0.01);
  // Counts change only where they are named.
  EXPECT_EQ(gates->tolerance(metric("frames_total"), "fr1_rpy", "full").relative, 0);
  EXPECT_EQ(gates->tolerance(metric("frames_tracked"), "any", "dm").absolute, 2);
  EXPECT_EQ(gates->factor(0, "any", "dm"), 1.10);
  EXPECT_EQ(gates->factor(1, "any", "dm"), 3);
}

TEST(GatesTest, RefusalsNameThePlaceAndTheNearestName) {
  EXPECT_EQ(refusal("improvement = \"fail\""),
            "gates.toml:1: unknown key 'improvement' (nearest: improvements)");
  EXPECT_EQ(refusal("\n[metrics.ate_rms_m]\nrelative = 1"),
            "gates.toml:3: unknown metric 'ate_rms_m' (nearest: ate_rmse_m)");
  EXPECT_EQ(refusal("[metrics.ate_rmse_m]\nrelativ = 1"),
            "gates.toml:2: unknown key 'relativ' (nearest: relative)");
  EXPECT_NE(refusal("[tolerance]\nabs = 1").find("gates.toml:2: unknown key"), std::string::npos);
  EXPECT_NE(refusal("[tolerances]\nabsolute = 1").find("(nearest: tolerance)"), std::string::npos);
  EXPECT_NE(refusal("[[override]]\nfactor = 2").find("(nearest: overrides)"), std::string::npos);
  EXPECT_EQ(refusal("[[overrides]]\nmetrics = [\"wall\"]\nfactor = 2"),
            "gates.toml:2: unknown metric 'wall' (nearest: wall_s)");
  EXPECT_NE(refusal("[[overrides]]\nfactors = 2").find("(nearest: factor)"), std::string::npos);
  EXPECT_EQ(refusal("[[overrides]]\nvariants = [\"full\"]"),
            "gates.toml:1: an override that changes nothing");
}

TEST(GatesTest, RefusalsNameTheRange) {
  EXPECT_EQ(refusal("[tolerance]\nrelative = -1"),
            "gates.toml:2: tolerance.relative must be a number in 0 .. 10");
  EXPECT_EQ(refusal("[tolerance]\nrelative = nan"), "gates.toml:2: tolerance.relative must be a number");
  EXPECT_EQ(refusal("[timing.factors]\nwall_s = 0.9"),
            "gates.toml:2: timing.factors.wall_s must be a number in 1 .. 100");
  EXPECT_NE(refusal("improvements = true").find("must be \"fail\" or \"report\""), std::string::npos);
  EXPECT_NE(refusal("[metrics.aie_grey]\nbetter = \"less\"").find("\"smaller\", \"larger\" or \"equal\""),
            std::string::npos);
  EXPECT_NE(refusal("[timing]\nalpha = 0.001").find("cannot be reached with timing.min_repetitions = 5"),
            std::string::npos);
  EXPECT_NE(refusal("metrics = 1").find("gates.toml:1"), std::string::npos);
  EXPECT_NE(refusal("timing = 1").find("gates.toml:1"), std::string::npos);
  EXPECT_NE(refusal("overrides = 1").find("gates.toml:1"), std::string::npos);
  EXPECT_NE(refusal("metrics.ate_rmse_m = 1").find("gates.toml:1"), std::string::npos);
  EXPECT_EQ(read_gates("/absent/gates.toml").error().code, ErrorCode::data_missing);
}

}  // namespace
}  // namespace fusebench
