#include "core/estimator/measurement/residual_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"
#include "tests/support/scalar_residuals.hpp"

namespace fusebench {

using namespace config;
using namespace measurement;

namespace {

/// The groups of options that these tests need.
struct ScaleOptions {
  IekfConfig iekf;
  PhotometricConfig photometric;
  GeometricConfig geometric;
};

/// Patches with residuals of `sigma` times the scale and a share of gross outliers.
std::vector<PatchOutcome> outcomes(double sigma, const ResidualScale& scale, const ScaleOptions& config,
                                   double outliers, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  std::uniform_real_distribution<double> uniform;
  std::vector<PatchOutcome> result(20);
  for (PatchOutcome& outcome : result) {
    outcome.accepted = true;
    for (int i = 0; i < 200; ++i) {
      const double r = uniform(random) < outliers ? 20.0 * sigma : normal(random);
      const double photometric = r / scale.photometric;
      const double geometric = r / scale.geometric;
      outcome.robust_photometric +=
          testing::huber(photometric, config.photometric.huber_sigmas).weight * photometric * photometric;
      outcome.robust_geometric +=
          testing::huber(geometric, config.geometric.huber_sigmas).weight * geometric * geometric;
      ++outcome.photometric_residuals;
      ++outcome.geometric_residuals;
    }
  }
  return result;
}

ResidualScale after_frames(double sigma, double outliers) {
  const ScaleOptions config;
  ResidualScale scale;
  for (unsigned frame = 0; frame < 60; ++frame)
    scale = followed_scale(scale, outcomes(sigma, scale, config, outliers, frame), config.iekf,
                           config.photometric, config.geometric);
  return scale;
}

TEST(ResidualScale, FindsTheStandardDeviationOfTheResiduals) {
  for (const double sigma : {0.4, 1.0, 2.5}) {
    EXPECT_NEAR(after_frames(sigma, 0.0).photometric / sigma, 1.0, 0.03);
    EXPECT_NEAR(after_frames(sigma, 0.0).geometric / sigma, 1.0, 0.03);
  }
}

TEST(ResidualScale, OutliersCountLittle) {
  // Five of a hundred are twenty sigmas off: the plain standard deviation would be 4.6.
  EXPECT_LT(after_frames(1.0, 0.05).photometric, 2.3);
  EXPECT_LT(after_frames(1.0, 0.05).geometric, 2.3);
}

TEST(ResidualScale, IgnoresRejectedPatchesAndBoundsTheScale) {
  const ScaleOptions config;
  std::vector<PatchOutcome> rejected = outcomes(100.0, {}, config, 0.0, 1);
  for (PatchOutcome& outcome : rejected) outcome.accepted = false;
  EXPECT_EQ(
      followed_scale({0.7, 1.3}, rejected, config.iekf, config.photometric, config.geometric).photometric,
      0.7);
  EXPECT_EQ(followed_scale({0.7, 1.3}, rejected, config.iekf, config.photometric, config.geometric).geometric,
            1.3);
  EXPECT_EQ(after_frames(100.0, 0.0).photometric, kMaxScale);
  EXPECT_EQ(after_frames(0.001, 0.0).geometric, 1.0 / kMaxScale);
}

}  // namespace
}  // namespace fusebench
