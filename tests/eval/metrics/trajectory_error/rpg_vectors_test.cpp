// Against numbers that rpg_trajectory_evaluation (8c8ceec) computed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/geometry.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/trajectory_error/segment_errors.hpp"
#include "eval/metrics/trajectory_error/trajectory_error.hpp"
#include "tests/support/trajectory_vectors.hpp"

namespace fusebench {

using namespace trajectory;
using namespace metrics;
using namespace trajectory_files;
using namespace trajectory_error;

namespace {

using nlohmann::json;

using RpgVectors = testing::TrajectoryVectors;
OVER_BOTH_VECTOR_SETS(RpgVectors);

Trajectory load(const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  auto trajectory = read_tum_trajectory(file, warnings, Duplicates::last);
  EXPECT_TRUE(trajectory.has_value()) << trajectory.error().message;
  return *trajectory;
}

void expect_statistics(const std::vector<double>& values, const json& expected, const std::string& what,
                       double factor = 1) {
  const Statistics stats = statistics(values);
  // Angles near zero: those of matrices are some 1e-8 rad off there, in degrees 1e-6.
  constexpr double kZeroDegrees = 1e-5;
  // The script's small angles come from a cosine.
  const double rounding = factor == 1 ? 1e-12 : 1e-10;
  for (const auto& [name, value] : {std::pair{"rmse", stats.rmse},
                                    {"mean", stats.mean},
                                    {"median", stats.median},
                                    {"std", stats.std},
                                    {"max", stats.max},
                                    {"min", stats.min}}) {
    const double wanted = expected.at(name);
    const bool zero = factor != 1 && std::abs(wanted) < kZeroDegrees;
    EXPECT_NEAR(factor * value, wanted, zero ? kZeroDegrees : std::max(rounding, 1e-9 * std::abs(wanted)))
        << what << ' ' << name;
  }
}

AlignmentRequest requested(const json& options) {
  AlignmentRequest request;
  const std::string align = options.at("align");
  request.mode = align == "sim3"   ? AlignmentMode::sim3
                 : align == "se3"  ? AlignmentMode::se3
                 : align == "none" ? AlignmentMode::none
                                   : AlignmentMode::yaw;
  request.first = options.value("n", std::size_t{0});
  request.single_pose = true;
  return request;
}

TEST_P(RpgVectors, AbsoluteAndRelativeErrors) {
  int compared = 0;
  const json tests = cases("rpg_expected.json");
  for (const json& test : tests) {
    SCOPED_TRACE(test.at("est").get<std::string>() + " " + test.at("options").dump());
    const Trajectory reference = load(input(test.at("gt").get<std::string>()));
    const auto pair = pair_up(reference, load(input(test.at("est").get<std::string>())),
                              {.rule = AssociationRule::greedy, .max_difference_s = 0.02});
    ASSERT_TRUE(pair.has_value());
    EXPECT_EQ(pair->size(), test.at("n_pairs").get<std::size_t>());
    AbsoluteOptions options{.alignment = requested(test.at("options"))};
    const auto position = absolute_error(*pair, options);
    options.relation = PoseRelation::angle_deg;
    const auto angle = absolute_error(*pair, options);
    ASSERT_TRUE(position && angle);
    EXPECT_NEAR(position->alignment.scale, test.at("scale").get<double>(), 1e-9);
    expect_statistics(position->errors, test.at("abs_e_trans"), "position");
    expect_statistics(angle->errors, test.at("abs_e_rot_deg"), "rotation");
    for (const json& expected : test.at("relative")) {
      const double length_m = expected.at("length");
      const SegmentErrors errors = segment_errors(*pair, rpg_motions(pair->reference, length_m, true),
                                                  length_m, position->alignment.scale);
      ASSERT_EQ(errors.translation_m.size(), expected.at("n").get<std::size_t>()) << length_m;
      if (errors.translation_m.empty()) continue;
      expect_statistics(errors.translation_m, expected.at("rel_trans"), "translation");
      expect_statistics(errors.rotation_rad, expected.at("rel_rot_deg"), "rotation", kDegreesPerRadian);
      expect_statistics(errors.yaw_rad, expected.at("rel_yaw_deg"), "yaw", kDegreesPerRadian);
      expect_statistics(errors.gravity_rad, expected.at("rel_gravity_deg"), "gravity", kDegreesPerRadian);
    }
    if (!test.at("options").contains("dists")) {
      const std::vector<double> lengths = rpg_lengths(reference);
      for (std::size_t k = 0; k < lengths.size(); ++k)
        EXPECT_NEAR(lengths[k], test.at("relative")[k].at("length").get<double>(), 1e-12);
    }
    ++compared;
  }
  EXPECT_EQ(compared, count(10, 40));
}

}  // namespace
}  // namespace fusebench
