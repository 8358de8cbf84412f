// Against numbers that the scripts of the TUM RGB-D benchmark computed.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/trajectory/association.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "tests/support/trajectory_vectors.hpp"

namespace fusebench {

using namespace trajectory;
using namespace metrics;
using namespace trajectory_error;

namespace {

using nlohmann::json;
using testing::expect_close;
using testing::kAbsolute;

void expect_statistics(const Statistics& stats, const json& expected, const std::string& what,
                       double absolute = kAbsolute) {
  expect_close(stats.rmse, expected.at("rmse"), what + " rmse", absolute);
  expect_close(stats.mean, expected.at("mean"), what + " mean", absolute);
  expect_close(stats.median, expected.at("median"), what + " median", absolute);
  expect_close(stats.std, expected.at("std"), what + " std", absolute);
  expect_close(stats.min, expected.at("min"), what + " min", absolute);
  expect_close(stats.max, expected.at("max"), what + " max", absolute);
}

/// The scripts hold stamps as doubles (steps of 238 ns today), which decides between two stamps at the same
/// distance.
std::int64_t rounded_as_double(std::int64_t timestamp_ns) {
  const double seconds = std::stod(stamp_text(timestamp_ns));
  return std::llround(static_cast<long double>(seconds) * 1e9L);
}

class TumVectors : public testing::TrajectoryVectors {
 protected:
  [[nodiscard]] Trajectory load(const json& test, const char* side) const;
};
OVER_BOTH_VECTOR_SETS(TumVectors);

Trajectory TumVectors::load(const json& test, const char* side) const {
  std::vector<std::string> warnings;  // some of the inputs are disordered on purpose
  auto trajectory = read_tum_trajectory(input(test.at(side).get<std::string>()), warnings, Duplicates::last);
  EXPECT_TRUE(trajectory.has_value()) << trajectory.error().message;
  const double scale = side == std::string("est") ? test.at("options").value("scale", 1.0) : 1.0;
  for (StampedPose& pose : *trajectory) {
    pose.timestamp_ns = rounded_as_double(pose.timestamp_ns);
    pose.T_world_camera.translation *= scale;
  }
  return *trajectory;
}

TEST_P(TumVectors, AbsoluteTrajectoryError) {
  int compared = 0;
  for (const json& test : cases("tum_expected.json")) {
    if (test.at("tool") != "evaluate_ate.py") continue;
    const std::string what = test.at("est").get<std::string>() + " " + test.at("options").dump();
    AteOptions options;
    options.max_difference_s = test.at("options").value("max_difference", 0.02);
    options.offset_s = test.at("options").value("offset", 0.0);
    const auto ate = absolute_trajectory_error(load(test, "gt"), load(test, "est"), options);
    ASSERT_TRUE(ate.has_value()) << what << ": " << ate.error().message;
    EXPECT_EQ(ate->pairs, test.at("compared_pose_pairs").get<std::size_t>()) << what;
    expect_statistics(ate->stats, test.at("absolute_translational_error"), what);
    const Matrix3d rotation = ate->alignment.T_reference_estimate.rotation_matrix();
    for (int k = 0; k < 9; ++k) {
      EXPECT_NEAR(rotation(k / 3, k % 3), test.at("rot_row_major")[static_cast<std::size_t>(k)].get<double>(),
                  1e-9)
          << what;
    }
    ++compared;
  }
  EXPECT_EQ(compared, count(4, 28));
}

TEST_P(TumVectors, RelativePoseError) {
  int compared = 0;
  for (const json& test : cases("tum_expected.json")) {
    const json& given = test.at("options");
    if (test.at("tool") != "evaluate_rpe.py") continue;
    const std::string what = test.at("est").get<std::string>() + " " + given.dump();
    RpeOptions options;
    options.all_pairs = !given.value("fixed_delta", false);
    options.delta = given.value("delta", 1.0);
    options.unit = parse_delta_unit(given.value("delta_unit", "s")).value();
    options.offset_s = given.value("offset", 0.0);
    options.max_difference_s = std::numeric_limits<double>::infinity();
    options.skip_gaps = false;
    const auto rpe = relative_pose_error(load(test, "gt"), load(test, "est"), options);
    ASSERT_TRUE(rpe.has_value()) << what << ": " << rpe.error().message;
    EXPECT_EQ(rpe->pairs, test.at("compared_pose_pairs").get<std::size_t>()) << what;
    expect_statistics(rpe->translation, test.at("translational_error"), what);
    // The script takes the angle from the cosine, which leaves it about 2e-8 rad near zero.
    expect_statistics(rpe->rotation, test.at("rotational_error_rad"), what + " rotation", 3e-8);
    ++compared;
  }
  EXPECT_EQ(compared, count(7, 45));
}

TEST_P(TumVectors, Association) {
  const auto stamps = [](const json& list) {
    std::vector<std::int64_t> result;
    for (const json& stamp : list) result.push_back(std::llround(stamp.get<double>() * 1e9));
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  };
  int compared = 0;
  for (const json& test : cases("association_cases.json")) {
    const auto reference = stamps(test.at("ref"));
    const auto estimate = stamps(test.at("est"));
    const auto pairs = associate(reference, estimate, std::llround(test.at("max_diff").get<double>() * 1e9),
                                 std::llround(test.at("offset").get<double>() * 1e9));
    const json& expected = test.at("tum_stamp_pairs");
    ASSERT_EQ(pairs.size(), expected.size()) << test.at("id");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(reference[pairs[i].first]),
                  1e9 * std::stod(expected[i][0].get<std::string>()), 500)
          << test.at("id");
      EXPECT_NEAR(static_cast<double>(estimate[pairs[i].second]),
                  1e9 * std::stod(expected[i][1].get<std::string>()), 500)
          << test.at("id");
    }
    ++compared;
  }
  EXPECT_EQ(compared, 19);
}

TEST_P(TumVectors, DegenerateTrajectoriesAreRefused) {
  std::vector<std::string> warnings;
  for (const std::string name : {"synL_collinear", "synL_collinear_oblique", "syn2_two_poses"}) {
    const auto truth = read_tum_trajectory(input(name + "_gt.txt"), warnings);
    const auto estimate = read_tum_trajectory(input(name + "_est.txt"), warnings);
    ASSERT_TRUE(truth && estimate) << name;
    const auto ate = absolute_trajectory_error(*truth, *estimate);
    ASSERT_FALSE(ate.has_value()) << name;
    EXPECT_EQ(ate.error().code, ErrorCode::data_corrupt) << name;
  }
  EXPECT_TRUE(warnings.empty());
  if (GetParam() == testing::VectorSet::golden) return;
  const auto planar_truth = read_tum_trajectory(input("synP_planar_gt.txt"), warnings);
  const auto planar = read_tum_trajectory(input("synP_planar_est.txt"), warnings);
  ASSERT_TRUE(planar_truth && planar);
  EXPECT_TRUE(absolute_trajectory_error(*planar_truth, *planar).has_value());
}

}  // namespace
}  // namespace fusebench
