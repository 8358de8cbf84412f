#include "core/estimator/measurement/patch_scatter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/base/solvers.hpp"

namespace fusebench {

using namespace filter;
using namespace measurement;

namespace {

Matrix6d some_information(int i) {
  Matrix6d root;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) root(r, c) = std::sin(1.7 * i + 2.3 * r + 0.9 * c * c) + (r == c ? 1.0 : 0.0);
  }
  // Metres and radians differ by orders of magnitude in their information.
  Vector6d scale;
  scale << 300, 300, 300, 100, 100, 100;
  return scale.asDiagonal() * root * root.transpose() * scale.asDiagonal();
}

/// Clusters whose gradients have `factor` times the variance that their information claims, around an
/// optimum that is off by a common step.
std::vector<PoseQuadratic> clusters(int count, double factor, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Vector6d step;
  step << 1e-3, -2e-3, 1e-3, 4e-3, 2e-3, -3e-3;
  std::vector<PoseQuadratic> result;
  for (int i = 0; i < count; ++i) {
    PoseQuadratic cluster;
    cluster.information = some_information(i);
    Vector6d white;
    for (int k = 0; k < 6; ++k) white[k] = normal(random);
    const Vector6d error = Eigen::LLT<Matrix6d>(cluster.information).matrixL() * white;
    cluster.gradient = std::sqrt(factor) * error - cluster.information * step;
    result.push_back(cluster);
  }
  return result;
}

TEST(PatchScatter, FindsTheFactorOfTheVarianceWhereverTheOptimumIs) {
  for (const double factor : {0.01, 1.0, 30.0}) {
    double mean = 0;
    constexpr int kSeeds = 20;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      mean += patch_scatter(clusters(40, factor, seed)).factor / kSeeds;
    }
    EXPECT_NEAR(mean / factor, 1.0, 0.1) << factor;
  }
}

TEST(PatchScatter, UnitsOfThePoseDoNotMatter) {
  std::vector<PoseQuadratic> in_metres = clusters(30, 4.0, 1);
  const double before = patch_scatter(in_metres).factor;
  Vector6d scale;
  scale << 1, 1, 1, 1e-3, 1e-3, 1e-3;
  for (PoseQuadratic& cluster : in_metres) {
    cluster.information = scale.asDiagonal() * cluster.information * scale.asDiagonal();
    cluster.gradient = scale.asDiagonal() * cluster.gradient;
  }
  EXPECT_NEAR(patch_scatter(in_metres).factor / before, 1.0, 1e-6);
}

TEST(PatchScatter, ClustersOfOnePlaneHaveNoInformationAlongIt) {
  // Point-to-plane on one plane: rank three. The factor is estimated from the observable directions.
  std::vector<PoseQuadratic> flat = clusters(60, 9.0, 3);
  Matrix6d seen = Matrix6d::Zero();
  seen.topLeftCorner<2, 2>().setIdentity();
  seen(5, 5) = 1;
  for (PoseQuadratic& cluster : flat) {
    // Independent of the hidden directions, so that the seen ones keep their statistics.
    cluster.information = seen * cluster.information * seen;
    cluster.gradient = seen * cluster.gradient;
  }
  const Scatter scatter = patch_scatter(flat);
  EXPECT_TRUE(std::isfinite(scatter.factor));
  EXPECT_GT(scatter.factor, 4.0);
  EXPECT_LT(scatter.factor, 16.0);
}

TEST(PatchScatter, FewPatchesKeepTheClaim) {
  EXPECT_EQ(patch_scatter({}).freedom, 0.0);
  EXPECT_EQ(variance_factor(patch_scatter({}), 10.0), 1.0);
  EXPECT_EQ(variance_factor(patch_scatter({}), 0.0), 1.0);
  const std::vector<PoseQuadratic> one = clusters(1, 100.0, 5);
  EXPECT_EQ(variance_factor(patch_scatter(one), 10.0), 1.0);  // one patch cannot disagree
  EXPECT_NEAR(variance_factor({.factor = 3.0, .freedom = 10.0}, 10.0), 2.0, 1e-12);
}

TEST(PatchScatter, WhatMeasurementsHaveInCommonDoesNotAverageOut) {
  // Means of n measurements with an error in common, against what one measurement's noise and n claim.
  constexpr double kShare = 0.3;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const int n : {1, 10, 100}) {
    double squares = 0;
    constexpr int kTrials = 4000;
    for (int trial = 0; trial < kTrials; ++trial) {
      const double common = kShare * normal(random);
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += common + normal(random);
      squares += (sum / n) * (sum / n);
    }
    const double claimed = 1.0 / n;
    EXPECT_NEAR(squares / kTrials / claimed / (1.0 + common_error_factor(n, kShare)), 1.0, 0.08) << n;
  }
}

}  // namespace
}  // namespace fusebench
