#include "eval/metrics/reference_clock/correlated_variance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace fusebench {

using namespace reference_clock;

namespace {

/// Terms at 10 Hz, all of the same information.
std::vector<StampedTerm> terms_of(const std::vector<double>& values) {
  std::vector<StampedTerm> terms;
  for (std::size_t i = 0; i < values.size(); ++i)
    terms.push_back({static_cast<std::int64_t>(i) * 100'000'000, values[i], 1.0});
  return terms;
}

/// What is corrected for `n` independent terms.
double correction(double n) { return n / (n - 2) / (1 - 1 / n + 1 / (3 * n * n)); }

TEST(CorrelatedVariance, IndependentTermsAreSecondsWithInformation) {
  EXPECT_NEAR(independent_terms(terms_of(std::vector<double>(100, 0.0))), 10, 1e-12);
  std::vector<StampedTerm> terms = terms_of(std::vector<double>(100, 0.0));
  for (std::size_t i = 0; i < terms.size(); ++i) terms[i].information = i < 20 ? 3.0 : 0.0;
  EXPECT_NEAR(independent_terms(terms), 2, 1e-12);
  for (StampedTerm& each : terms) each.information = 0;
  EXPECT_EQ(independent_terms(terms), 0);
  EXPECT_EQ(independent_terms({}), 0);
}

TEST(CorrelatedVariance, IsTheSumByTheKernel) {
  std::vector<double> values(100, 0.0);
  values[30] = 2;
  EXPECT_NEAR(correlated_variance(terms_of(values)), 4 * correction(10), 1e-9);
  values[33] = 5;  // 0.3 s later: 0.7 of their product, twice
  EXPECT_NEAR(correlated_variance(terms_of(values)), (4 + 25 + 2 * 0.7 * 10) * correction(10), 1e-9);
  values[33] = 0;
  values[40] = 5;  // a second later
  EXPECT_NEAR(correlated_variance(terms_of(values)), (4 + 25) * correction(10), 1e-9);
}

TEST(CorrelatedVariance, OfTwoSecondsAndLessIsUnknown) {
  EXPECT_TRUE(std::isinf(correlated_variance(terms_of(std::vector<double>(20, 1.0)))));
  EXPECT_TRUE(std::isfinite(correlated_variance(terms_of(std::vector<double>(31, 1.0)))));
  EXPECT_TRUE(std::isinf(correlated_variance({})));
}

TEST(CorrelatedVariance, GrowsWithTheTimeThatErrorsAreAlike) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  std::vector<double> alone(3000);
  for (double& value : alone) value = normal(generator);
  std::vector<double> alike(alone.size());
  for (std::size_t i = 0; i < alike.size(); ++i) alike[i] = alone[i - i % 3];  // of 0.3 s each
  EXPECT_NEAR(correlated_variance(terms_of(alone)), 3000, 600);
  EXPECT_NEAR(correlated_variance(terms_of(alike)), 9000, 2500);
}

}  // namespace
}  // namespace fusebench
